#include "libdb/build/place_models.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "libdb/access/database.h"
#include "libdb/access/ground_query.h"
#include "libdb/build/placement_writer.h"
#include "libdb/build/publication.h"

namespace deltaz {

namespace {

// What stands in a database before an edit.
struct Standing {
  std::vector<ModelTree> trees;
  std::vector<Placement> placements;
  std::uint32_t next_instance = 1;
};

Result<Standing> readStanding(const Database& database) {
  Standing standing;
  for (const Model& model : database.models()) standing.trees.push_back(model.tree());
  if (const PlacementSet* set = database.placements()) {
    standing.next_instance = set->directory().next_instance;
    DELTAZ_TRY_ASSIGN(standing.placements, set->all());
  }
  return standing;
}

Result<std::uint32_t> modelNamed(const Database& database, const std::string& name) {
  const std::optional<std::uint32_t> number = database.findModel(name);
  if (number) return *number;
  std::string names;
  for (const AssetHeader& model : database.area().models) names += (names.empty() ? "" : ", ") + model.name;
  return usageError(name, "the database has no model of this name",
                    names.empty() ? "it has none at all" : "it has " + names,
                    "Bring it in with 'dbbuild model'");
}

double fullTurn(double heading) {
  double turned = std::fmod(heading, 360.0);
  if (turned < 0) turned += 360;
  // A tiny negative angle is rounded up to a whole turn.
  return turned < 360 ? turned : 0;
}

Result<Placement> place(const Database& database, const PlacementRequest& request) {
  const auto refused = [&](const std::string& what, const std::string& why = {},
                           const std::string& remedy = {}) {
    return usageError(request.where, what, why, remedy);
  };
  if (!(std::abs(request.latitude) <= 90)) return refused("the latitude is not within -90 .. 90");
  if (!(request.longitude >= -180 && request.longitude <= 360))
    return refused("the longitude is not within -180 .. 360");
  if (!std::isfinite(request.heading)) return refused("the heading is no number");
  Placement placement;
  placement.latitude = request.latitude;
  placement.longitude = request.longitude > 180 ? request.longitude - 360 : request.longitude;
  placement.heading = fullTurn(request.heading);
  placement.height = request.altitude.value_or(0);
  placement.on_ground = request.above_ground || !request.altitude;
  if (placement.on_ground) {
    placement.above_ground = placement.height;
    DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                      groundHeight(database, placement.latitude, placement.longitude));
    if (!ground) {
      return refused(fmt::format("there is no ground at {},{}", request.latitude, request.longitude),
                     "it lies outside the area or on posts without a height",
                     "Choose another place, or give an altitude above the datum");
    }
    placement.height += *ground;
  }
  if (!(std::abs(placement.height) <= kMaximumHeightMetres)) return refused("the altitude is out of range");
  return placement;
}

}  // namespace

Result<std::vector<Placement>> placeModels(const FileSystem& files, const std::string& target,
                                           const std::string& model,
                                           std::span<const PlacementRequest> requests) {
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(files, target));
  DELTAZ_TRY_ASSIGN(const std::uint32_t number, modelNamed(database, model));
  DELTAZ_TRY_ASSIGN(Standing standing, readStanding(database));
  if (requests.size() > std::numeric_limits<std::uint32_t>::max() - standing.next_instance)
    return usageError(model, "the database has run out of numbers for instances");
  std::vector<Placement> fresh;
  for (const PlacementRequest& request : requests) {
    DELTAZ_TRY_ASSIGN(Placement placement, place(database, request));
    placement.model = number;
    placement.instance = standing.next_instance++;
    fresh.push_back(placement);
  }
  standing.placements.insert(standing.placements.end(), fresh.begin(), fresh.end());
  AreaHeader area = publication.area();
  DELTAZ_TRY(writePlacements(files, publication, area, std::move(standing.placements), standing.next_instance,
                             standing.trees));
  DELTAZ_TRY(publication.publish(area));
  return fresh;
}

Status removePlacement(const FileSystem& files, const std::string& target, const std::string& model,
                       std::uint32_t instance) {
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  DELTAZ_TRY_ASSIGN(const Database database, Database::open(files, target));
  DELTAZ_TRY_ASSIGN(const std::uint32_t number, modelNamed(database, model));
  DELTAZ_TRY_ASSIGN(Standing standing, readStanding(database));
  const std::size_t removed = std::erase_if(standing.placements, [&](const Placement& placement) {
    return placement.instance == instance && placement.model == number;
  });
  if (removed == 0) return usageError("--remove", fmt::format("{} has no instance {}", model, instance));
  AreaHeader area = publication.area();
  DELTAZ_TRY(writePlacements(files, publication, area, std::move(standing.placements), standing.next_instance,
                             standing.trees));
  return publication.publish(area);
}

}  // namespace deltaz
