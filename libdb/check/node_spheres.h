// The bounding spheres that node records state, in space. Internal to libdb/check. Thread-safety: const
// members from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libdb/access/earth.h"
#include "libdb/check/check_context.h"

namespace deltaz {

class NodeSpheres {
 public:
  // What the rounding of double positions may add to a distance, metres; the stored radius is rounded up.
  static constexpr double kTolerance = 1e-6;

  // Pre: the tree is sound.
  explicit NodeSpheres(const CheckContext& context) : context_(context) {
    // Breadth-first order puts every parent before its children.
    centroids_.push_back(context.area.centroid);
    for (std::uint32_t number = 1; number <= context.records.size(); ++number) {
      std::array<std::int64_t, 3> centroid = centroids_[context.parents[number - 1]];
      for (std::size_t axis = 0; axis < 3; ++axis)
        centroid[axis] += context.record(number).centroid_offset[axis];
      centroids_.push_back(centroid);
    }
  }

  // Earth-centred metres.
  Vector3 centre(std::uint32_t number) const {
    const auto& units = centroids_[number];
    return {static_cast<double>(units[0]) * kCentroidUnit, static_cast<double>(units[1]) * kCentroidUnit,
            static_cast<double>(units[2]) * kCentroidUnit};
  }
  double radius(std::uint32_t number) const { return context_.record(number).radius * kCentroidUnit; }

 private:
  const CheckContext& context_;
  std::vector<std::array<std::int64_t, 3>> centroids_;  // kCentroidUnit, by record number; the area's first
};

}  // namespace deltaz
