#include "tools/dbbuild/place_command.h"

#include <fmt/format.h>
#include <iostream>

#include "formats/file_system.h"
#include "tools/common/json_output.h"
#include "tools/common/parse.h"
#include "tools/dbbuild/command.h"
#include "tools/dbbuild/placement_list.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kMostListBytes = 1u << 30;

class PlaceCommand final : public Command {
 public:
  explicit PlaceCommand(CLI::App& parent)
      : app_(*parent.add_subcommand("place", "Put a model of a database somewhere")) {
    addPathOption(app_, "AREA", area_, "The database, AREA.dz")->required()->type_name("AREA.dz");
    app_.add_option("MODEL", model_, "Name of the model")->required()->type_name("MODEL");
    texts_.addTo(app_);
    app_.add_option("--remove", remove_, "Take away the placement of this number")->type_name("INSTANCE");
    addCommonOptions(app_, common_, false);
  }

  CLI::App& app() override { return app_; }

  Result<int> run() override { return remove_.empty() ? runPlace(area_, model_, texts_, common_) : remove(); }

 private:
  Result<int> remove() const {
    if (!texts_.at.empty() || !texts_.from.empty())
      return usageError("--remove", "it cannot be combined with --at or --from");
    DELTAZ_TRY_ASSIGN(const std::int64_t instance, parseInteger(remove_, "--remove", 1, UINT32_MAX));
    DELTAZ_TRY(removePlacement(localFileSystem(), area_, model_, static_cast<std::uint32_t>(instance)));
    if (common_.json) {
      Json json = jsonHeader("dbbuild");
      json["area"] = area_;
      json["model"] = model_;
      json["removed_instance"] = instance;
      std::cout << jsonText(json);
    } else if (!common_.quiet) {
      std::cout << fmt::format("{}: instance {} of {} removed\n", area_, instance, model_);
    }
    return kExitDone;
  }

  CLI::App& app_;
  CommonOptions common_;
  std::string area_, model_, remove_;
  PlaceOptionTexts texts_;
};

}  // namespace

void PlaceOptionTexts::addTo(CLI::App& app) {
  app.add_option("--at", at,
                 "Where: degrees, and metres above the datum, or above ground as in 120agl (default: on the "
                 "ground); may be given again")
      ->type_name("LAT,LON[,ALT]")
      ->allow_extra_args(false);
  app.add_option("--heading", heading, "Where its y axis points, degrees clockwise from north (default: 0)")
      ->type_name("D");
  addPathOption(app, "--from", from, "File of places: lines LAT,LON[,ALT[,HEADING]], or GeoJSON points")
      ->type_name("FILE");
}

Result<std::vector<PlacementRequest>> PlaceOptionTexts::parse() const {
  if (at.empty() && from.empty())
    return usageError("--at", "no place is given", {}, "Give --at LAT,LON[,ALT] or --from FILE");
  double direction = 0;
  if (!heading.empty()) {
    DELTAZ_TRY_ASSIGN(direction, parseNumberBetween(heading, "--heading", -360, 360));
  }
  std::vector<PlacementRequest> requests;
  for (const std::string& place : at) {
    DELTAZ_TRY_ASSIGN(PlacementRequest request, parsePlace(place, "--at"));
    request.heading = direction;
    requests.push_back(std::move(request));
  }
  if (from.empty()) return requests;
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes,
                    readWholeFile(localFileSystem(), from, kMostListBytes));
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  DELTAZ_TRY_ASSIGN(const std::vector<PlacementRequest> listed, parsePlacementList(text, from, direction));
  requests.insert(requests.end(), listed.begin(), listed.end());
  return requests;
}

Result<int> runPlace(const std::string& area, const std::string& model, const PlaceOptionTexts& texts,
                     const CommonOptions& common) {
  DELTAZ_TRY_ASSIGN(const std::vector<PlacementRequest> requests, texts.parse());
  DELTAZ_TRY_ASSIGN(const std::vector<Placement> placed,
                    placeModels(localFileSystem(), area, model, requests));
  if (common.json) {
    Json json = jsonHeader("dbbuild");
    json["area"] = area;
    json["model"] = model;
    json["placements"] = Json::array();
    for (const Placement& placement : placed) {
      json["placements"].push_back({{"instance", placement.instance},
                                    {"latitude", placement.latitude},
                                    {"longitude", placement.longitude},
                                    {"height", placement.height},
                                    {"on_ground", placement.on_ground},
                                    {"above_ground", placement.above_ground},
                                    {"heading", placement.heading}});
    }
    std::cout << jsonText(json);
  } else if (!common.quiet) {
    // A long list is told by its ends.
    constexpr std::size_t kMostLines = 20;
    for (std::size_t k = 0; k < placed.size(); ++k) {
      if (placed.size() > kMostLines && !common.verbose) break;
      const Placement& placement = placed[k];
      std::cout << fmt::format("{}: instance {} of {} at {:.7f},{:.7f}, {:.3f} m, heading {:g}\n", area,
                               placement.instance, model, placement.latitude, placement.longitude,
                               placement.height, placement.heading);
    }
    if (placed.size() > kMostLines && !common.verbose) {
      std::cout << fmt::format("{}: instances {} to {} of {}\n", area, placed.front().instance,
                               placed.back().instance, model);
    }
  }
  return kExitDone;
}

std::unique_ptr<Command> makePlaceCommand(CLI::App& parent) {
  return std::make_unique<PlaceCommand>(parent);
}

}  // namespace deltaz
