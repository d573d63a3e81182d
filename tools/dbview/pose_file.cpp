#include "tools/dbview/pose_file.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "formats/file_system.h"
#include "libdb/access/model.h"
#include "librender/scene/pose_table.h"
#include "tools/common/strict_json.h"

namespace deltaz {
namespace {

constexpr std::uint64_t kLargestFile = 64u << 20;

const StrictJson kReader("See MOVED PARTS in dbview(1)");

Error bad(const std::string& where, const std::string& what, const std::string& why = {}) {
  return kReader.bad(where, what, why);
}

Status checkMembers(const Json& json, const std::string& where, const std::vector<std::string>& known) {
  return kReader.checkMembers(json, where, known);
}

Result<double> numberOf(const Json& json, const std::string& where) {
  if (!json.is_number()) return bad(where, "this is no number", "it is " + std::string(json.type_name()));
  const auto value = json.get<double>();
  if (!(std::abs(value) <= kMaximumModelMetres)) return bad(where, "the number is out of range");
  return value;
}

template <std::size_t size>
Result<std::array<double, size>> numbersOf(const Json& json, const std::string& where) {
  if (!json.is_array() || json.size() != size)
    return bad(where, fmt::format("this is no array of {} numbers", size));
  std::array<double, size> values{};
  for (std::size_t k = 0; k < size; ++k) {
    DELTAZ_TRY_ASSIGN(values[k], numberOf(json[k], fmt::format("{}[{}]", where, k)));
  }
  return values;
}

// Counter-clockwise seen from the axis's tip.
Result<ModelTransform> rotationOf(const Json& json, const std::string& where) {
  DELTAZ_TRY(checkMembers(json, where, {"axis", "degrees"}));
  for (const char* member : {"axis", "degrees"}) {
    if (!json.contains(member)) return bad(where, fmt::format("the member \"{}\" is missing", member));
  }
  DELTAZ_TRY_ASSIGN(const auto axis, (numbersOf<3>(json["axis"], where + ".axis")));
  DELTAZ_TRY_ASSIGN(const double degrees, numberOf(json["degrees"], where + ".degrees"));
  const Vector3 along{axis[0], axis[1], axis[2]};
  if (!(length(along) > 0)) return bad(where + ".axis", "the axis has no direction");
  const Vector3 n = normalized(along);
  const double angle = std::remainder(degrees, 360.0) * (std::numbers::pi / 180);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  ModelTransform m{};
  const std::array<Vector3, 3> base = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t row = 0; row < 3; ++row) {
    const Vector3 turned =
        base[row] * cosine + cross(n, base[row]) * sine + n * (dot(n, base[row]) * (1 - cosine));
    m[3 * row] = turned.x;
    m[3 * row + 1] = turned.y;
    m[3 * row + 2] = turned.z;
  }
  return m;
}

Result<ModelTransform> motionOf(const Json& json, const std::string& where) {
  if (json.contains("matrix")) {
    for (const char* other : {"translate", "rotate", "scale"}) {
      if (json.contains(other))
        return bad(where, fmt::format("\"matrix\" and \"{}\" exclude each other", other));
    }
    return numbersOf<12>(json["matrix"], where + ".matrix");
  }
  ModelTransform motion = kIdentityTransform;
  if (json.contains("scale")) {
    DELTAZ_TRY_ASSIGN(const double scale, numberOf(json["scale"], where + ".scale"));
    if (scale == 0) return bad(where + ".scale", "a scale of 0 leaves nothing of the part");
    motion[0] = motion[4] = motion[8] = scale;
  }
  if (json.contains("rotate")) {
    DELTAZ_TRY_ASSIGN(const ModelTransform rotation, rotationOf(json["rotate"], where + ".rotate"));
    motion = concatenate(motion, rotation);
  }
  if (json.contains("translate")) {
    DELTAZ_TRY_ASSIGN(const auto metres, (numbersOf<3>(json["translate"], where + ".translate")));
    for (std::size_t axis = 0; axis < 3; ++axis) motion[9 + axis] += metres[axis];
  }
  return motion;
}

Result<PartPose> poseOf(const Json& json, const std::string& where) {
  DELTAZ_TRY(
      checkMembers(json, where, {"model", "part", "instance", "translate", "rotate", "scale", "matrix"}));
  PartPose pose;
  DELTAZ_TRY_ASSIGN(pose.model, kReader.textOf(json, where, "model"));
  DELTAZ_TRY_ASSIGN(pose.part, kReader.textOf(json, where, "part"));
  if (json.contains("instance")) {
    const Json& instance = json["instance"];
    if (!instance.is_number_unsigned() || instance.get<std::uint64_t>() < 1 ||
        instance.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
      return bad(where + ".instance", "this is no number of a placement", "they are counted from 1");
    pose.instance = instance.get<std::uint32_t>();
  }
  DELTAZ_TRY_ASSIGN(pose.motion, motionOf(json, where));
  return pose;
}

}  // namespace

Result<std::vector<PartPose>> parsePoses(std::string_view text, const std::string& where) {
  DELTAZ_TRY_ASSIGN(const Json json, kReader.parse(text, where));
  DELTAZ_TRY(checkMembers(json, where, {"poses"}));
  if (!json.contains("poses") || !json["poses"].is_array())
    return bad(where, "the member \"poses\" is missing or no array");
  std::vector<PartPose> poses;
  std::set<std::tuple<std::string, std::string, std::uint32_t>> seen;
  for (std::size_t k = 0; k < json["poses"].size(); ++k) {
    const std::string at = fmt::format("{}, poses[{}]", where, k);
    DELTAZ_TRY_ASSIGN(PartPose pose, poseOf(json["poses"][k], at));
    if (!seen.emplace(pose.model, pose.part, pose.instance.value_or(0)).second)
      return bad(at, "the same part is given a second pose");
    poses.push_back(std::move(pose));
  }
  return poses;
}

Result<std::vector<PartPose>> readPoseFile(const std::string& path) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(localFileSystem(), path, kLargestFile));
  std::string text;
  for (const std::byte byte : bytes) text.push_back(static_cast<char>(byte));
  return parsePoses(text, path);
}

Status checkPoses(const Database& database, const std::vector<PartPose>& poses, const std::string& where) {
  if (const Result<PoseTable> table = PoseTable::of(database, poses); !table.ok()) {
    Error error = table.error();
    error.where = where;
    return error;
  }
  std::map<std::uint32_t, std::uint32_t> models;  // of instances
  for (const PartPose& pose : poses) {
    if (!pose.instance) continue;
    if (models.empty() && database.placements() != nullptr) {
      DELTAZ_TRY_ASSIGN(const std::vector<Placement> placements, database.placements()->all());
      for (const Placement& placement : placements) models[placement.instance] = placement.model;
    }
    const auto found = models.find(*pose.instance);
    if (found == models.end())
      return usageError(where, fmt::format("nothing is placed as instance {}", *pose.instance));
    const std::string& name = database.area().models[found->second].name;
    if (name != pose.model) {
      return usageError(
          where, fmt::format("instance {} is a \"{}\", not a \"{}\"", *pose.instance, name, pose.model));
    }
  }
  return Success{};
}

}  // namespace deltaz
