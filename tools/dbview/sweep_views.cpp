#include "tools/dbview/sweep_views.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <set>

#include "formats/file_system.h"
#include "libdb/access/ground_query.h"
#include "tools/common/strict_json.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kLargestFile = 1u << 20;
constexpr double kEyeHeight = 2;  // metres

Result<NamedCameraRequest> viewOf(const StrictJson& reader, const Json& json, const std::string& where,
                                  const CameraText& common) {
  DELTAZ_TRY(reader.checkMembers(json, where, {"name", "eye", "look", "fov", "size"}));
  NamedCameraRequest view;
  DELTAZ_TRY_ASSIGN(view.name, reader.textOf(json, where, "name"));
  CameraText text = common;
  text.eye.clear();
  text.look.clear();
  for (const auto& [member, target] :
       {std::pair{"eye", &text.eye}, {"look", &text.look}, {"size", &text.size}}) {
    if (!json.contains(member)) continue;
    DELTAZ_TRY_ASSIGN(*target, reader.textOf(json, where, member));
  }
  if (json.contains("fov")) {
    if (!json["fov"].is_number()) return reader.bad(where + ".fov", "this is no number");
    text.field_of_view = fmt::format("{}", json["fov"].get<double>());
  }
  Result<CameraRequest> camera = parseCamera(text, where);
  if (!camera.ok()) {
    // What is wrong stands in a file, not on the command line.
    Error error = camera.error();
    error.kind = ErrorKind::kInvalid;
    return error;
  }
  view.camera = std::move(camera).value();
  return view;
}

}  // namespace

Result<std::vector<NamedCameraRequest>> parseViews(std::string_view text, const std::string& where,
                                                   const CameraText& common) {
  const StrictJson reader("See VIEWS in dbview(1)");
  DELTAZ_TRY_ASSIGN(const Json json, reader.parse(text, where));
  DELTAZ_TRY(reader.checkMembers(json, where, {"views"}));
  if (!json.contains("views") || !json["views"].is_array() || json["views"].empty())
    return reader.bad(where, "the member \"views\" is missing or no array of views");
  std::vector<NamedCameraRequest> views;
  std::set<std::string> names;
  for (std::size_t k = 0; k < json["views"].size(); ++k) {
    const std::string at = fmt::format("{}, views[{}]", where, k);
    DELTAZ_TRY_ASSIGN(NamedCameraRequest view, viewOf(reader, json["views"][k], at, common));
    if (!names.insert(view.name).second)
      return reader.bad(at, fmt::format("there are two views called \"{}\"", view.name));
    views.push_back(std::move(view));
  }
  return views;
}

Result<std::vector<NamedCameraRequest>> readViewsFile(const std::string& path, const CameraText& common) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(localFileSystem(), path, kLargestFile));
  std::string text;
  for (const std::byte byte : bytes) text.push_back(static_cast<char>(byte));
  return parseViews(text, path, common);
}

Result<std::vector<SweepView>> placeViews(const Database& database,
                                          const std::vector<NamedCameraRequest>& requests) {
  std::vector<SweepView> views;
  for (const NamedCameraRequest& request : requests) {
    DELTAZ_TRY_ASSIGN(const Camera camera, placeCamera(database, request.camera, request.name));
    views.push_back({request.name, camera});
  }
  return views;
}

Result<std::vector<SweepView>> defaultViews(const Database& database, const Camera& like) {
  const AreaHeader& area = database.area();
  std::vector<SweepView> views;
  CameraRequest whole;
  whole.camera = like;
  whole.whole_area = true;
  DELTAZ_TRY_ASSIGN(const Camera all, placeCamera(database, whole));
  views.push_back({"whole area", all});

  Camera camera = like;
  camera.heading = camera.pitch = camera.roll = 0;
  const double middle_longitude = (area.west + area.east) / 2;
  const auto latitude_at = [&](double share) { return area.south + share * (area.north - area.south); };
  for (const double share : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7}) {
    DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                      groundHeight(database, latitude_at(share), middle_longitude));
    if (!ground) continue;
    camera.eye = {latitude_at(share), middle_longitude, *ground + kEyeHeight};
    views.push_back({"eye level", camera});
    break;
  }

  // Half the distance between the area's corners in the south-west and north-east, metres.
  const EllipsoidShape& ellipsoid = area.grids.front().ellipsoid;
  const double reach = length(toEarthCentred(ellipsoid, {area.north, area.east, 0}) -
                              toEarthCentred(ellipsoid, {area.south, area.west, 0})) /
                       2;
  camera.eye = {latitude_at(0.2), middle_longitude, area.highest_height + 0.1 * reach};
  camera.pitch = -20;
  views.push_back({"oblique", camera});
  camera.eye = {
      latitude_at(0.5), middle_longitude,
      area.highest_height + 0.35 * reach / std::tan(like.field_of_view / 2 * std::numbers::pi / 180)};
  camera.pitch = -90;
  views.push_back({"zenith", camera});
  return views;
}

}  // namespace deltaz
