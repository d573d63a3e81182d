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
    case 0: return 1.0;
    case 2: return squared;
    case 4: return squared * squared;
    default: return std::pow(squared, 0.5 * exponent);
  }
}

}  // namespace

Vector3 table11Normal(const std::array<VertexNeighbour, 6>& neighbours, const Vector3& fallback, int exponent) {
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

std::vector<Vector3> vertexNormals(const TerrainTile& tile, const GridGeometry& geometry) {
  const PostRange columns{tile.first_column - 1, tile.first_column + tile.columns + 1};
  const PostRange rows{tile.first_row - 1, tile.first_row + tile.rows + 1};
  const std::vector<ColumnConstants> column_constants = geometry.columnConstantsOf(tile.level, columns);
  const std::vector<RowConstants> row_constants = geometry.rowConstantsOf(tile.level, rows);

  // Absolute positions: what a vertex gets depends on global indices and heights alone, not on the tile.
  std::vector<Vector3> positions(tile.heights.size());
  for (int j = -1; j <= tile.rows; ++j) {
    for (int i = -1; i <= tile.columns; ++i) {
      positions[tile.index(i, j)] = earthCentred(row_constants[static_cast<std::size_t>(j + 1)],
                                                 column_constants[static_cast<std::size_t>(i + 1)],
                                                 geometry.metres(tile.height(i, j)));
    }
  }

  std::vector<Vector3> normals;
  normals.reserve(static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows));
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const Vector3 up = upVector(row_constants[static_cast<std::size_t>(j + 1)], column_constants[static_cast<std::size_t>(i + 1)]);
      if (!tile.isValid(i, j)) {
        normals.push_back(up);
        continue;
      }
      const Vector3& vertex = positions[tile.index(i, j)];
      std::array<VertexNeighbour, 6> neighbours;
      for (std::size_t k = 0; k < neighbours.size(); ++k) {
        const int ni = i + kNeighbourSteps[k].i;
        const int nj = j + kNeighbourSteps[k].j;
        neighbours[k] = {positions[tile.index(ni, nj)] - vertex, tile.isValid(ni, nj)};
      }
      normals.push_back(table11Normal(neighbours, up));
    }
  }
  return normals;
}

}  // namespace deltaz
