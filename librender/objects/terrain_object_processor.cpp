#include "librender/objects/terrain_object_processor.h"

#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "libdb/access/synthetic_color.h"
#include "libdb/access/vertex_normals.h"
#include "librender/objects/view_positions.h"

namespace deltaz {
namespace {

PostRange columnRange(const TerrainTile& tile) {
  return {tile.first_column, tile.first_column + tile.columns};
}
PostRange rowRange(const TerrainTile& tile) {
  return {tile.first_row, tile.first_row + tile.rows};
}

}  // namespace

std::vector<Vector3> terrainPositions(const TerrainTile& tile, const GridGeometry& geometry,
                                      const ViewTransform& view) {
  ViewPositions lists;
  terrainViewPositions(tile, geometry, view, lists);
  std::vector<Vector3> position;
  position.reserve(lists.count());
  for (std::size_t post = 0; post < lists.count(); ++post) position.push_back(lists.at(post));
  return position;
}

TerrainShading terrainShading(const TerrainTile& tile, const GridGeometry& geometry, const Light& light) {
  const std::vector<Vector3> normals = vertexNormals(tile, geometry);
  const std::vector<PostPlace> places = geometry.postPlaces(tile.level, columnRange(tile), rowRange(tile));
  TerrainShading shading;
  shading.color.reserve(normals.size());
  shading.intensity.reserve(normals.size());
  SurfacePoint point;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const Vector3& normal = normals[shading.color.size()];
      const Vector3& up = places[shading.color.size()].up;
      const double across = std::hypot(up.x, up.y);
      // On a geodetic grid a row has one latitude.
      if (i == 0 || !geometry.isGeodetic()) {
        const double latitude =
            geometry.isGeodetic() ? geometry.latitude((tile.first_row + j) * (std::int64_t{1} << tile.level))
                                  : std::atan2(up.z, across) * (180.0 / std::numbers::pi);
        point.snow_line = snowLine(latitude);
      }
      // North, in the plane of the axis and the vertical.
      const Vector3 north =
          across > 0 ? Vector3{-up.z * up.x / across, -up.z * up.y / across, across} : Vector3{-up.z, 0, 0};
      point.height = geometry.metres(tile.height(i, j));
      point.upness = dot(normal, up);
      point.poleward = (up.z < 0 ? -1 : 1) * dot(normal, north);
      const double intensity = light.intensity(normal);
      shading.intensity.push_back(intensity);
      shading.color.push_back(naturalColor(point) * intensity);
    }
  }
  return shading;
}

TerrainVertices terrainVertices(const TerrainTile& tile, const GridGeometry& geometry,
                                const ViewTransform& view, const Light& light) {
  TerrainShading shading = terrainShading(tile, geometry, light);
  TerrainVertices vertices;
  vertices.columns = tile.columns;
  vertices.rows = tile.rows;
  vertices.position = terrainPositions(tile, geometry, view);
  vertices.color = std::move(shading.color);
  vertices.intensity = std::move(shading.intensity);
  vertices.texture.reserve(vertices.position.size());
  const std::int64_t step = std::int64_t{1} << tile.level;
  for (int j = 0; j < tile.rows; ++j) {
    const auto row = static_cast<double>((tile.first_row + j) * step);
    for (int i = 0; i < tile.columns; ++i)
      vertices.texture.push_back({static_cast<double>((tile.first_column + i) * step), row});
  }
  return vertices;
}

TerrainVertex TerrainVertex::moved(const TerrainVertex& from, const TerrainVertex& to, double weight) const {
  return {position + (to.position - from.position) * weight,
          color + (to.color + from.color * -1) * weight,
          intensity + (to.intensity - from.intensity) * weight,
          {texture.column + (to.texture.column - from.texture.column) * weight,
           texture.row + (to.texture.row - from.texture.row) * weight}};
}

void TerrainVertices::set(std::size_t index, const TerrainVertex& vertex) {
  position[index] = vertex.position;
  color[index] = vertex.color;
  intensity[index] = vertex.intensity;
  texture[index] = vertex.texture;
}

void TerrainVertices::append(const TerrainVertex& vertex) {
  position.push_back(vertex.position);
  color.push_back(vertex.color);
  intensity.push_back(vertex.intensity);
  texture.push_back(vertex.texture);
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
