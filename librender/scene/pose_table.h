// The poses of a frame, found by model, part and instance. A scene definition: the same for every engine.
//
// A pose of one instance goes before one of all instances; of two alike the later counts.
// Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/scene/pose.h"

namespace deltaz {

class PoseTable {
 public:
  PoseTable() = default;
  // kUsage for names that the database has not, and for motions that are no numbers or flatten their part;
  // the error lists names that are near.
  static Result<PoseTable> of(const Database& database, const std::vector<PartPose>& poses);
  // Pre: numbers of a model and of one of its parts; instance 0 for all of them.
  void add(std::uint32_t model, std::uint32_t part, std::uint32_t instance, const ModelTransform& motion);

  bool empty() const { return motions_.empty(); }
  // Null if the part stands as it does by default.
  const ModelTransform* motion(std::uint32_t model, std::uint32_t instance, std::uint32_t part) const;
  // What all instances of a model that stand alike share: the instance itself if it has poses of its own,
  // else 0.
  std::uint32_t variant(std::uint32_t model, std::uint32_t instance) const;
  // True if the instances of this variant may stand otherwise than by default.
  bool posed(std::uint32_t model, std::uint32_t variant) const;
  // (model, variant) of all that may.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> posedVariants() const;

 private:
  using Key = std::pair<std::uint32_t, std::uint32_t>;              // model, instance or 0
  std::map<Key, std::map<std::uint32_t, ModelTransform>> motions_;  // by part
};

}  // namespace deltaz
