#include "librender/raster/face_lanes.h"

#include <algorithm>
#include <cstddef>

#include "librender/raster/texture_planes.h"

namespace deltaz {

FaceLanes faceLanes(const FacePlanes& planes, std::uint16_t grid) {
  FaceLanes lanes{};
  const TexturePlanes texture = texturePlanes(planes);
  const auto set = [&](FaceLane lane, const ScreenPlane& plane) {
    lanes.value[lane] = plane.value;
    lanes.per_j[lane] = plane.per_j;
    lanes.per_i[lane] = plane.per_i;
  };
  set(kInverseU, planes.inverse_u);
  set(kSecondWeight, planes.weight1);
  set(kThirdWeight, planes.weight2);
  set(kColumn, texture.column);
  set(kRow, texture.row);
  for (std::size_t k = 0; k < 3; ++k) {
    std::copy_n(planes.color[k].begin(), 3, lanes.color[k]);
    lanes.color[k][3] = planes.intensity[k];
  }
  lanes.anchor_j = planes.anchor_j;
  lanes.anchor_i = planes.anchor_i;
  lanes.least = planes.least;
  lanes.greatest = planes.greatest;
  lanes.column = texture.origin.column;
  lanes.row = texture.origin.row;
  const auto& [second, third] = planes.texture_steps;
  lanes.least_column = static_cast<float>(std::min({0.0, second.column, third.column}));
  lanes.greatest_column = static_cast<float>(std::max({0.0, second.column, third.column}));
  lanes.least_row = static_cast<float>(std::min({0.0, second.row, third.row}));
  lanes.greatest_row = static_cast<float>(std::max({0.0, second.row, third.row}));
  lanes.identity = planes.identity;
  lanes.grid = grid;
  lanes.surface = planes.surface;
  return lanes;
}

void makeFaceLanes(const ViewTransform& view, std::span<const PretiledNode> nodes,
                   std::span<const SeenFace> faces, std::vector<FaceLanes>& lanes) {
  lanes.clear();
  for (const SeenFace& face : faces) {
    const PretiledNode& node = nodes[face.node];
    lanes.push_back(faceLanes(facePlanes(view, node, face.face), node.grid));
  }
}

}  // namespace deltaz
