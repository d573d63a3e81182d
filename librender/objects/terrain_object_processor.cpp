#include "librender/objects/terrain_object_processor.h"

#include <algorithm>
#include <span>

#include "librender/objects/terrain_vertex_lists.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/objects/terrain_object_processor.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kVectorPadding>;
constexpr D kDouble;
constexpr hn::Rebind<float, D> kFloat;
constexpr std::size_t kLanes = hn::MaxLanes(D());

// Of all posts; the lists are padded, what is written is not.
void gatherPositions(const ViewPositions& lists, Vector3* out) {
  const std::size_t count = lists.count();
  for (std::size_t k = 0; k < count; k += kLanes) {
    Vector3 last[kLanes];
    const bool whole = k + kLanes <= count;
    hn::StoreInterleaved3(hn::LoadU(kDouble, &lists.u[k]), hn::LoadU(kDouble, &lists.v[k]),
                          hn::LoadU(kDouble, &lists.w[k]), kDouble, whole ? &out[k].x : &last[0].x);
    if (!whole) std::copy_n(last, count - k, out + k);
  }
}

void gatherLight(const PostColors& colors, const std::vector<double>& intensity, std::size_t count,
                 VertexLight* out) {
  const auto load = [](const std::vector<double>& list, std::size_t k) {
    return hn::DemoteTo(kFloat, hn::LoadU(kDouble, &list[k]));
  };
  for (std::size_t k = 0; k < count; k += kLanes) {
    VertexLight last[kLanes];
    const bool whole = k + kLanes <= count;
    hn::StoreInterleaved4(load(colors.red, k), load(colors.green, k), load(colors.blue, k),
                          load(intensity, k), kFloat, whole ? &out[k].red : &last[0].red);
    if (!whole) std::copy_n(last, count - k, out + k);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(gatherPositions);
HWY_EXPORT(gatherLight);

static_assert(sizeof(Vector3) == 3 * sizeof(double) && sizeof(VertexLight) == 4 * sizeof(float));

}  // namespace

std::vector<Vector3> terrainPositions(const TerrainTile& tile, const GridGeometry& geometry,
                                      const ViewTransform& view) {
  ViewPositions lists;
  terrainViewPositions(tile, geometry, view, lists);
  std::vector<Vector3> position(lists.count());
  HWY_DYNAMIC_DISPATCH(gatherPositions)(lists, position.data());
  return position;
}

namespace {

std::vector<LinearColor> gathered(const PostColors& colors, std::size_t count) {
  std::vector<LinearColor> list;
  list.reserve(count);
  for (std::size_t k = 0; k < count; ++k) list.push_back({colors.red[k], colors.green[k], colors.blue[k]});
  return list;
}

}  // namespace

TerrainShading terrainShading(const TerrainTile& tile, const GridGeometry& geometry, const Light& light) {
  thread_local TerrainVertexLists lists;
  terrainVertexLists(tile, geometry, {}, light, lists);
  const std::size_t count = lists.position.count();
  TerrainShading shading;
  shading.color = gathered(lists.color, count);
  shading.intensity.assign(lists.intensity.begin(),
                           lists.intensity.begin() + static_cast<std::ptrdiff_t>(count));
  return shading;
}

TerrainVertices terrainVertices(const TerrainTile& tile, const GridGeometry& geometry,
                                const ViewTransform& view, const Light& light, TransformKind transform) {
  thread_local TerrainVertexLists lists;
  terrainVertexLists(tile, geometry, view, light, lists, {PostColoring::kByRule, transform});
  const std::size_t count = lists.position.count();
  TerrainVertices vertices;
  vertices.columns = tile.columns;
  vertices.rows = tile.rows;
  vertices.position.resize(count);
  HWY_DYNAMIC_DISPATCH(gatherPositions)(lists.position, vertices.position.data());
  vertices.light.resize(count);
  HWY_DYNAMIC_DISPATCH(gatherLight)(lists.color, lists.intensity, count, vertices.light.data());
  vertices.step = static_cast<double>(std::int64_t{1} << tile.level);
  vertices.first_post = {static_cast<double>(tile.first_column) * vertices.step,
                         static_cast<double>(tile.first_row) * vertices.step};
  return vertices;
}

TerrainVertex TerrainVertex::moved(const TerrainVertex& from, const TerrainVertex& to, double weight) const {
  return {position + (to.position - from.position) * weight,
          color + (to.color + from.color * -1) * weight,
          intensity + (to.intensity - from.intensity) * weight,
          {texture.column + (to.texture.column - from.texture.column) * weight,
           texture.row + (to.texture.row - from.texture.row) * weight}};
}

TerrainVertex TerrainVertices::at(std::size_t index) const {
  const VertexLight& lit = light[index];
  return {position[index], {lit.red, lit.green, lit.blue}, lit.intensity, texture(index)};
}

namespace {

VertexLight lightOf(const TerrainVertex& vertex) {
  return {static_cast<float>(vertex.color.red), static_cast<float>(vertex.color.green),
          static_cast<float>(vertex.color.blue), static_cast<float>(vertex.intensity)};
}

}  // namespace

void TerrainVertices::setPost(std::size_t index, const TerrainVertex& vertex) {
  position[index] = vertex.position;
  light[index] = lightOf(vertex);
}

void TerrainVertices::append(const TerrainVertex& vertex) {
  position.push_back(vertex.position);
  light.push_back(lightOf(vertex));
  appended_texture.push_back(vertex.texture);
}

namespace {

// The points on the border edge that starts at post `edge` of a side.
std::span<const std::uint32_t> pointsOn(const std::vector<std::vector<std::uint32_t>>& side, int edge) {
  if (side.empty()) return {};
  return side[static_cast<std::size_t>(edge)];
}

}  // namespace

void addFace(TerrainFaces& faces, const std::vector<Vector3>& position, const TerrainFace& face) {
  ++faces.in;
  const auto& [a, b, c] = face.vertex;
  if (isBackFacing(position[a], position[b], position[c])) {
    ++faces.back_facing;
  } else {
    faces.front.push_back(face);
  }
}

TerrainFaces terrainFaces(const TerrainTile& tile, const std::vector<Vector3>& position,
                          const TerrainSplits& splits, const std::vector<std::uint8_t>& left_out) {
  TerrainFaces faces;
  if (tile.columns < 2 || tile.rows < 2) return faces;
  faces.front.reserve(static_cast<std::size_t>(tile.columns - 1) * static_cast<std::size_t>(tile.rows - 1) *
                      2);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t identity) {
    addFace(faces, position, {{a, b, c}, identity});
  };
  const auto drawn = [&](std::uint32_t identity) { return left_out.empty() || left_out[identity] == 0; };
  // A face with points on its edges a-b and b-c: a fan from c through those on a-b, and one from the last of
  // them through those on b-c.
  const auto add_split = [&](std::uint32_t a, std::span<const std::uint32_t> on_ab, std::uint32_t b,
                             std::span<const std::uint32_t> on_bc, std::uint32_t c, std::uint32_t identity) {
    std::uint32_t last = a;
    for (const std::uint32_t point : on_ab) {
      add(last, point, c, identity);
      last = point;
    }
    std::uint32_t from = b;
    for (const std::uint32_t point : on_bc) {
      add(last, from, point, identity);
      from = point;
    }
    add(last, from, c, identity);
  };
  const auto columns = static_cast<std::uint32_t>(tile.columns);
  std::vector<std::uint32_t> north, west;
  for (int j = 0; j + 1 < tile.rows; ++j) {
    for (int i = 0; i + 1 < tile.columns; ++i) {
      const std::uint32_t south_west =
          static_cast<std::uint32_t>(j) * columns + static_cast<std::uint32_t>(i);
      const std::uint32_t south_east = south_west + 1, north_west = south_west + columns;
      const std::uint32_t north_east = north_west + 1;
      const std::uint32_t cell =
          static_cast<std::uint32_t>(j) * (columns - 1) + static_cast<std::uint32_t>(i);
      if (tile.bottomFaceValid(i, j) && drawn(cell << 1)) {
        add_split(south_west, j == 0 ? pointsOn(splits.south, i) : std::span<const std::uint32_t>{},
                  south_east,
                  i + 2 == tile.columns ? pointsOn(splits.east, j) : std::span<const std::uint32_t>{},
                  north_east, cell << 1);
      }
      if (tile.topFaceValid(i, j) && drawn(cell << 1 | 1)) {
        // Its border edges run westwards and southwards.
        north.clear();
        west.clear();
        if (j + 2 == tile.rows) {
          const auto points = pointsOn(splits.north, i);
          north.assign(points.rbegin(), points.rend());
        }
        if (i == 0) {
          const auto points = pointsOn(splits.west, j);
          west.assign(points.rbegin(), points.rend());
        }
        if (north.empty() && west.empty()) {
          add(south_west, north_east, north_west, cell << 1 | 1);
        } else {
          add_split(north_east, north, north_west, west, south_west, cell << 1 | 1);
        }
      }
    }
  }
  return faces;
}

}  // namespace deltaz
#endif
