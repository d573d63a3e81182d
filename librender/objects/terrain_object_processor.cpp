#include "librender/objects/terrain_object_processor.h"

#include "libdb/access/vertex_normals.h"
#include "librender/scene/synthetic_color.h"

namespace deltaz {
namespace {

PostRange columnRange(const TerrainTile& tile) {
  return {tile.first_column, tile.first_column + tile.columns};
}
PostRange rowRange(const TerrainTile& tile) {
  return {tile.first_row, tile.first_row + tile.rows};
}

// One view axis as it enters the separable transform.
struct Axis {
  Vector3 m;     // Earth-centred vector, scaled to pixels for V and W
  double t = 0;  // dot(m, eye)
  Axis(const Vector3& vector, const Vector3& eye) : m(vector), t(dot(vector, eye)) {}
};

}  // namespace

std::vector<Vector3> terrainPositions(const TerrainTile& tile, const GridGeometry& geometry,
                                      const ViewTransform& view) {
  const std::vector<RowConstants> rows = geometry.rowConstantsOf(tile.level, rowRange(tile));
  const std::vector<ColumnConstants> columns = geometry.columnConstantsOf(tile.level, columnRange(tile));
  const Axis u(view.forward, view.eye), v(view.right * view.pixels, view.eye),
      w(view.down * view.pixels, view.eye);
  std::vector<Vector3> column_terms;
  column_terms.reserve(columns.size());
  for (const ColumnConstants& column : columns) {
    column_terms.push_back({u.m.x * column.cosine + u.m.y * column.sine,
                            v.m.x * column.cosine + v.m.y * column.sine,
                            w.m.x * column.cosine + w.m.y * column.sine});
  }

  std::vector<Vector3> position;
  position.reserve(rows.size() * columns.size());
  for (int j = 0; j < tile.rows; ++j) {
    const RowConstants& row = rows[static_cast<std::size_t>(j)];
    for (int i = 0; i < tile.columns; ++i) {
      const double height = geometry.metres(tile.height(i, j));
      const double distance = row.a + row.b * height, z = row.c + row.s * height;
      const Vector3& k = column_terms[static_cast<std::size_t>(i)];
      position.push_back({distance * k.x + (z * u.m.z - u.t), distance * k.y + (z * v.m.z - v.t),
                          distance * k.z + (z * w.m.z - w.t)});
    }
  }
  return position;
}

std::vector<LinearColor> terrainColors(const TerrainTile& tile, const GridGeometry& geometry,
                                       const Light& light) {
  const std::vector<RowConstants> rows = geometry.rowConstantsOf(tile.level, rowRange(tile));
  const std::vector<ColumnConstants> columns = geometry.columnConstantsOf(tile.level, columnRange(tile));
  const std::vector<Vector3> normals = vertexNormals(tile, geometry);
  std::vector<LinearColor> color;
  color.reserve(normals.size());
  for (int j = 0; j < tile.rows; ++j) {
    const RowConstants& row = rows[static_cast<std::size_t>(j)];
    const double latitude = geometry.latitude((tile.first_row + j) * (std::int64_t{1} << tile.level));
    const double hemisphere = latitude < 0 ? -1 : 1;
    SurfacePoint point;
    point.snow_line = snowLine(latitude);
    for (int i = 0; i < tile.columns; ++i) {
      const ColumnConstants& column = columns[static_cast<std::size_t>(i)];
      const Vector3& normal = normals[color.size()];
      const Vector3 north{-row.s * column.cosine, -row.s * column.sine, row.b};
      point.height = geometry.metres(tile.height(i, j));
      point.upness = dot(normal, upVector(row, column));
      point.poleward = hemisphere * dot(normal, north);
      color.push_back(naturalColor(point) * light.intensity(normal));
    }
  }
  return color;
}

TerrainVertices terrainVertices(const TerrainTile& tile, const GridGeometry& geometry,
                                const ViewTransform& view, const Light& light) {
  return {tile.columns, tile.rows, terrainPositions(tile, geometry, view),
          terrainColors(tile, geometry, light)};
}

TerrainFaces terrainFaces(const TerrainTile& tile, const std::vector<Vector3>& position) {
  TerrainFaces faces;
  if (tile.columns < 2 || tile.rows < 2) return faces;
  faces.front.reserve(static_cast<std::size_t>(tile.columns - 1) * static_cast<std::size_t>(tile.rows - 1) *
                      2);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t identity) {
    ++faces.in;
    if (isBackFacing(position[a], position[b], position[c])) {
      ++faces.back_facing;
    } else {
      faces.front.push_back({{a, b, c}, identity});
    }
  };
  const auto columns = static_cast<std::uint32_t>(tile.columns);
  for (int j = 0; j + 1 < tile.rows; ++j) {
    for (int i = 0; i + 1 < tile.columns; ++i) {
      const std::uint32_t south_west =
          static_cast<std::uint32_t>(j) * columns + static_cast<std::uint32_t>(i);
      const std::uint32_t south_east = south_west + 1, north_west = south_west + columns;
      const std::uint32_t north_east = north_west + 1;
      const std::uint32_t cell =
          static_cast<std::uint32_t>(j) * (columns - 1) + static_cast<std::uint32_t>(i);
      if (tile.bottomFaceValid(i, j)) add(south_west, south_east, north_east, cell << 1);
      if (tile.topFaceValid(i, j)) add(south_west, north_east, north_west, cell << 1 | 1);
    }
  }
  return faces;
}

}  // namespace deltaz
