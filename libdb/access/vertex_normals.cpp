#include "libdb/access/vertex_normals.h"

namespace deltaz {

namespace {

struct Step {
  int i, j;
};
constexpr std::array<Step, 6> kNeighbourSteps = {{{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}}};

// D^p for the exponents that matter; D from its square.
double distancePower(double squared, int exponent) {
  switch (exponent) {
    case 0:
      return 1.0;
    case 2:
      return squared;
    case 4:
      return squared * squared;
    default:
      return std::pow(squared, 0.5 * exponent);
  }
}

}  // namespace

Vector3 table11Normal(const std::array<VertexNeighbour, 6>& neighbours, const Vector3& fallback,
                      int exponent) {
  Vector3 sum;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const VertexNeighbour& first = neighbours[k];
    const VertexNeighbour& second = neighbours[(k + 1) % neighbours.size()];
    if (!first.valid || !second.valid) continue;
    const Vector3 normal = cross(first.offset, second.offset);
    // The centroid of the vertex (the origin here) and its two neighbours.
    const Vector3 centroid = (first.offset + second.offset) * (1.0 / 3.0);
    const double squared = dot(centroid, centroid);
    if (!(squared > 0)) continue;
    sum = sum + normal * (1.0 / distancePower(squared, exponent));
  }
  const double size = length(sum);
  return size > 0 ? sum * (1.0 / size) : fallback;
}

namespace {

// The vectors from a tile's posts to their neighbours, computed as differences from the start: as exact
// beside a pole, where posts stand a fraction of a millimetre apart, as anywhere else.
class PostOffsets {
 public:
  PostOffsets(const TerrainTile& tile, const GridGeometry& geometry) : tile_(tile), geometry_(geometry) {
    const std::int64_t step = std::int64_t{1} << tile.level;
    const EllipsoidShape& ellipsoid = geometry.header().ellipsoid;
    const PostRange columns{tile.first_column - 1, tile.first_column + tile.columns + 1};
    const PostRange rows{tile.first_row - 1, tile.first_row + tile.rows + 1};
    columns_ = geometry.columnConstantsOf(tile.level, columns);
    rows_ = geometry.rowConstantsOf(tile.level, rows);
    for (std::int64_t g = columns.begin; g + 1 < columns.end; ++g) {
      column_steps_.push_back(columnStep(geometry.longitude(g * step), geometry.longitude((g + 1) * step)));
    }
    for (std::int64_t g = rows.begin; g + 1 < rows.end; ++g) {
      row_steps_.push_back(
          rowStep(ellipsoid, geometry.latitude(g * step), geometry.latitude((g + 1) * step)));
    }
  }

  Vector3 up(int i, int j) const { return upVector(row(j), column(i)); }

  // From post (i, j) to post (i + di, j + dj); di and dj are -1, 0 or 1.
  Vector3 offset(int i, int j, int di, int dj) const {
    const RowConstants& from_row = row(j);
    const RowConstants& to_row = row(j + dj);
    const ColumnConstants& to_column = column(i + di);
    const double from_height = geometry_.metres(tile_.height(i, j));
    const double to_height = geometry_.metres(tile_.height(i + di, j + dj));
    const double row_sign = dj;
    const double column_sign = di;
    const RowStep none;
    const RowStep& r = dj == 0 ? none : row_steps_[static_cast<std::size_t>(dj > 0 ? j + 1 : j)];
    const ColumnStep no_step;
    const ColumnStep& c = di == 0 ? no_step : column_steps_[static_cast<std::size_t>(di > 0 ? i + 1 : i)];
    // Products of constants and heights change by the constant's change times one height plus the height's
    // times the other.
    const double rise = to_height - from_height;
    const double distance = from_row.a + from_row.b * from_height;
    const double distance_step = row_sign * (r.a + r.b * from_height) + to_row.b * rise;
    return {distance_step * to_column.cosine + distance * column_sign * c.cosine,
            distance_step * to_column.sine + distance * column_sign * c.sine,
            row_sign * (r.c + r.s * from_height) + to_row.s * rise};
  }

 private:
  const RowConstants& row(int j) const { return rows_[static_cast<std::size_t>(j + 1)]; }
  const ColumnConstants& column(int i) const { return columns_[static_cast<std::size_t>(i + 1)]; }

  const TerrainTile& tile_;
  const GridGeometry& geometry_;
  std::vector<ColumnConstants> columns_;
  std::vector<RowConstants> rows_;
  std::vector<ColumnStep> column_steps_;  // from column i to i + 1, i from the ring on
  std::vector<RowStep> row_steps_;
};

// The same on a projected grid, whose posts lie at least 0.1 mm apart: differences of positions, each of
// which has the same bits in whatever tile it occurs.
class ProjectedOffsets {
 public:
  ProjectedOffsets(const TerrainTile& tile, const GridGeometry& geometry)
      : columns_(static_cast<std::size_t>(tile.columns + 2)),
        places_(geometry.postPlaces(tile.level, {tile.first_column - 1, tile.first_column + tile.columns + 1},
                                    {tile.first_row - 1, tile.first_row + tile.rows + 1})) {
    positions_.reserve(places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k)
      positions_.push_back(places_[k].at(geometry.metres(tile.heights[k])));
  }

  Vector3 up(int i, int j) const { return places_[index(i, j)].up; }
  Vector3 offset(int i, int j, int di, int dj) const {
    return positions_[index(i + di, j + dj)] - positions_[index(i, j)];
  }

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j + 1) * columns_ + static_cast<std::size_t>(i + 1);
  }
  std::size_t columns_;
  std::vector<PostPlace> places_;
  std::vector<Vector3> positions_;
};

template <typename Offsets>
std::vector<Vector3> normalsFrom(const TerrainTile& tile, const Offsets& offsets) {
  std::vector<Vector3> normals;
  normals.reserve(static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows));
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const Vector3 up = offsets.up(i, j);
      if (!tile.isValid(i, j)) {
        normals.push_back(up);
        continue;
      }
      std::array<VertexNeighbour, 6> neighbours;
      for (std::size_t k = 0; k < neighbours.size(); ++k) {
        const auto [di, dj] = kNeighbourSteps[k];
        neighbours[k] = {offsets.offset(i, j, di, dj), tile.isValid(i + di, j + dj)};
      }
      normals.push_back(table11Normal(neighbours, up));
    }
  }
  return normals;
}

}  // namespace

std::vector<Vector3> vertexNormals(const TerrainTile& tile, const GridGeometry& geometry) {
  return geometry.isGeodetic() ? normalsFrom(tile, PostOffsets(tile, geometry))
                               : normalsFrom(tile, ProjectedOffsets(tile, geometry));
}

}  // namespace deltaz
