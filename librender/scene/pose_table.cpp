#include "librender/scene/pose_table.h"

#include <cmath>
#include <fmt/format.h>
#include <string>

#include "formats/near_names.h"

namespace deltaz {
namespace {

Status checkMotion(const PartPose& pose) {
  const ModelTransform& m = pose.motion;
  bool in_range = true;
  for (const double value : m) in_range = in_range && std::abs(value) <= kMaximumModelMetres;
  const double determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                             m[2] * (m[3] * m[7] - m[4] * m[6]);
  if (in_range && std::abs(determinant) > 0) return Success{};
  return usageError(fmt::format("the pose of part \"{}\" of model \"{}\"", pose.part, pose.model),
                    in_range ? "its motion flattens the part" : "a number of its motion is out of range");
}

}  // namespace

Result<PoseTable> PoseTable::of(const Database& database, const std::vector<PartPose>& poses) {
  PoseTable table;
  for (const PartPose& pose : poses) {
    const std::optional<std::uint32_t> model = database.findModel(pose.model);
    if (!model) {
      std::vector<std::string> names;
      for (const AssetHeader& header : database.area().models) names.push_back(header.name);
      return usageError("the poses", fmt::format("there is no model \"{}\"", pose.model),
                        nearNamesText(pose.model, names));
    }
    const std::vector<ModelPart>& parts = database.models()[*model].tree().parts;
    std::uint32_t part = 0;
    while (part < parts.size() && parts[part].name != pose.part) ++part;
    if (part == parts.size()) {
      std::vector<std::string> names;
      for (const ModelPart& one : parts) names.push_back(one.name);
      return usageError("the poses", fmt::format("model \"{}\" has no part \"{}\"", pose.model, pose.part),
                        nearNamesText(pose.part, names));
    }
    if (pose.instance && *pose.instance == 0)
      return usageError("the poses", "there is no instance 0", "instances are counted from 1");
    DELTAZ_TRY(checkMotion(pose));
    table.add(*model, part, pose.instance.value_or(0), pose.motion);
  }
  return table;
}

void PoseTable::add(std::uint32_t model, std::uint32_t part, std::uint32_t instance,
                    const ModelTransform& motion) {
  motions_[{model, instance}][part] = motion;
}

const ModelTransform* PoseTable::motion(std::uint32_t model, std::uint32_t instance,
                                        std::uint32_t part) const {
  for (const std::uint32_t who : {instance, std::uint32_t{0}}) {
    const auto of_model = motions_.find({model, who});
    if (of_model == motions_.end()) continue;
    const auto found = of_model->second.find(part);
    if (found != of_model->second.end()) return &found->second;
  }
  return nullptr;
}

std::uint32_t PoseTable::variant(std::uint32_t model, std::uint32_t instance) const {
  return motions_.count({model, instance}) > 0 ? instance : 0;
}

bool PoseTable::posed(std::uint32_t model, std::uint32_t variant) const {
  return motions_.count({model, variant}) > 0 || motions_.count({model, 0}) > 0;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> PoseTable::posedVariants() const {
  std::vector<Key> keys;
  for (const auto& [key, motions] : motions_) keys.push_back(key);
  return keys;
}

}  // namespace deltaz
