#include "librender/raster/face_lanes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "librender/raster/texture_planes.h"
#include "librender/scene/view_volume.h"

namespace deltaz {

void moveInside(const FaceLanes& face, double& dj, double& di) {
  double nearest = std::numeric_limits<double>::infinity(), nearest_j = dj, nearest_i = di;
  const double *const j = face.corner_j, *const i = face.corner_i;
  for (std::size_t k = 0; k < face.corners; ++k) {
    const std::size_t next = k + 1 == face.corners ? 0 : k + 1;
    const double edge_j = j[next] - j[k], edge_i = i[next] - i[k];
    const double length = edge_j * edge_j + edge_i * edge_i;
    const double along = (dj - j[k]) * edge_j + (di - i[k]) * edge_i;
    const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
    const double on_j = j[k] + t * edge_j, on_i = i[k] + t * edge_i;
    const double distance = (dj - on_j) * (dj - on_j) + (di - on_i) * (di - on_i);
    if (distance >= nearest) continue;
    nearest = distance;
    nearest_j = on_j;
    nearest_i = on_i;
  }
  dj = nearest_j;
  di = nearest_i;
}

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
  std::copy(planes.corner_j.begin(), planes.corner_j.end(), lanes.corner_j);
  std::copy(planes.corner_i.begin(), planes.corner_i.end(), lanes.corner_i);
  lanes.corners = planes.corners;
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

namespace {

// What faceLanes(facePlanes(...)) gives of a face of a node's own grid that lies in front of the hither
// plane, without the general case's detours.
FaceLanes gridFaceLanes(const ViewTransform& view, const PretiledNode& node, std::uint32_t cell, bool top,
                        const std::array<std::uint32_t, 3>& vertex) {
  const TerrainVertices& vertices = node.vertices;
  std::array<ScreenVertex, 3> at;
  for (std::size_t k = 0; k < 3; ++k) at[k] = project(view, vertices.position[vertex[k]]);
  FaceLanes lanes{};
  lanes.anchor_j = at[0].j;
  lanes.anchor_i = at[0].i;
  lanes.least = std::min({at[0].inverse_u, at[1].inverse_u, at[2].inverse_u});
  lanes.greatest = std::max({at[0].inverse_u, at[1].inverse_u, at[2].inverse_u});
  const double bj = at[1].j - at[0].j, bi = at[1].i - at[0].i;
  const double cj = at[2].j - at[0].j, ci = at[2].i - at[0].i;
  lanes.corners = 3;
  lanes.corner_j[1] = bj;
  lanes.corner_i[1] = bi;
  lanes.corner_j[2] = cj;
  lanes.corner_i[2] = ci;
  const double determinant = bj * ci - cj * bi;
  const double inverse = determinant != 0 ? 1 / determinant : 0;
  const double db = at[1].inverse_u - at[0].inverse_u, dc = at[2].inverse_u - at[0].inverse_u;
  lanes.value[kInverseU] = at[0].inverse_u;
  lanes.per_j[kInverseU] = (db * ci - dc * bi) * inverse;
  lanes.per_i[kInverseU] = (bj * dc - cj * db) * inverse;
  // Weights are 0 at the anchor, and so are places.
  lanes.per_j[kSecondWeight] = at[1].inverse_u * ci * inverse;
  lanes.per_i[kSecondWeight] = -(cj * at[1].inverse_u) * inverse;
  lanes.per_j[kThirdWeight] = -(at[2].inverse_u * bi) * inverse;
  lanes.per_i[kThirdWeight] = bj * at[2].inverse_u * inverse;
  // From the south-west: to the south-east and the north-east, or to the north-east and the north-west.
  const double step = vertices.step;
  const auto set_places = [step, top](double(&plane)[kFaceLanes]) {
    const double second = step * plane[kSecondWeight], third = step * plane[kThirdWeight];
    plane[kColumn] = top ? second : second + third;
    plane[kRow] = top ? second + third : third;
  };
  set_places(lanes.per_j);
  set_places(lanes.per_i);
  lanes.greatest_column = lanes.greatest_row = static_cast<float>(step);
  const GridCoordinates first = vertices.texture(vertex[0]);
  lanes.column = first.column;
  lanes.row = first.row;
  for (std::size_t k = 0; k < 3; ++k) {
    const VertexLight& light = vertices.light[vertex[k]];
    lanes.color[k][0] = light.red;
    lanes.color[k][1] = light.green;
    lanes.color[k][2] = light.blue;
    lanes.color[k][3] = light.intensity;
  }
  lanes.identity = std::uint64_t{node.identity} << 32 | cell << 1 | (top ? 1 : 0);
  lanes.grid = node.grid;
  lanes.surface = node.surface;
  return lanes;
}

}  // namespace

void makeFaceLanes(const ViewTransform& view, std::span<const PretiledNode> nodes,
                   std::span<const SeenFace> faces, std::vector<FaceLanes>& lanes) {
  lanes.clear();
  for (const SeenFace& seen : faces) {
    const PretiledNode& node = nodes[seen.node];
    if ((seen.face & kGridFace) != 0) {
      const TerrainFace face = node.face(seen.face);
      const std::vector<Vector3>& position = node.vertices.position;
      const auto& [a, b, c] = face.vertex;
      if (std::min({position[a].x, position[b].x, position[c].x}) >= kHither) {
        lanes.push_back(gridFaceLanes(view, node, face.identity >> 1, (face.identity & 1) != 0, face.vertex));
        continue;
      }
    }
    lanes.push_back(faceLanes(facePlanes(view, node, seen.face), node.grid));
  }
}

}  // namespace deltaz
