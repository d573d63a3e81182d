#include "tests/stress/scalar_transforms.h"

namespace deltaz {
namespace {

// A view axis in single precision: what an Earth-centred offset is multiplied by, V and W scaled to pixels.
struct FloatVector {
  float x = 0, y = 0, z = 0;
};

FloatVector toFloat(const Vector3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// View coordinates of an Earth-centred direction.
Vector3 directionInView(const ViewTransform& view, const Vector3& d) {
  return {dot(view.forward, d), dot(view.right, d) * view.pixels, dot(view.down, d) * view.pixels};
}

// The flat grid's axes and middle in view coordinates: the rows of the report's 4 x 4 matrix.
struct FloatGrid {
  FloatVector east, north, up, origin;
  FloatGrid(const PlanarGrid& planar, const ViewTransform& view)
      : east(toFloat(directionInView(view, planar.east))),
        north(toFloat(directionInView(view, planar.north))),
        up(toFloat(directionInView(view, planar.up))),
        origin(toFloat(view.toView(planar.origin))) {}

  // `x` and `y` in posts from the middle, `z` in metres above the base.
  FloatVector at(float x, float y, float z) const {
    return {east.x * x + north.x * y + up.x * z + origin.x, east.y * x + north.y * y + up.y * z + origin.y,
            east.z * x + north.z * y + up.z * z + origin.z};
  }
};

FloatVector stepped(const FloatVector& from, const FloatVector& axis, const FloatVector& up, float delta) {
  return {from.x + (axis.x + delta * up.x), from.y + (axis.y + delta * up.y),
          from.z + (axis.z + delta * up.z)};
}

Vector3 widened(const FloatVector& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Differences and heights are taken in integers, where they are exact, before they become floats.
float metresOf(std::int64_t quanta, float quantum) {
  return static_cast<float>(quanta) * quantum;
}

// One view axis as it enters the separable transform.
struct Axis {
  Vector3 m;     // Earth-centred vector, scaled to pixels for V and W
  double t = 0;  // dot(m, eye)
  Axis(const Vector3& vector, const Vector3& eye) : m(vector), t(dot(vector, eye)) {}
};

PostRange columnRange(const TerrainTile& tile) {
  return {tile.first_column, tile.first_column + tile.columns};
}
PostRange rowRange(const TerrainTile& tile) {
  return {tile.first_row, tile.first_row + tile.rows};
}

std::vector<float> deltasOf(const TerrainTile& tile_of, const GridGeometry& geometry,
                            const PlanarGrid& planar) {
  std::vector<float> heights;
  const TerrainTile& tile = tile_of;
  const auto quantum = static_cast<float>(geometry.header().quantum.value());
  heights.reserve(tile.heights.size());
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const std::int64_t before = i > 0   ? tile.height(i - 1, j)
                                  : j > 0 ? tile.height(i, j - 1)
                                          : std::int64_t{planar.base};
      heights.push_back(metresOf(tile.height(i, j) - before, quantum));
    }
  }
  return heights;
}

std::vector<float> heightsOf(const TerrainTile& tile_of, const GridGeometry& geometry,
                             const PlanarGrid& planar) {
  std::vector<float> heights;
  const TerrainTile& tile = tile_of;
  const auto quantum = static_cast<float>(geometry.header().quantum.value());
  heights.reserve(tile.heights.size());
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i)
      heights.push_back(metresOf(std::int64_t{tile.height(i, j)} - planar.base, quantum));
  }
  return heights;
}

std::vector<std::array<float, 3>> offsetsOf(const TerrainTile& tile_of, const GridGeometry& geometry,
                                            const PlanarGrid& planar) {
  std::vector<std::array<float, 3>> offsets;
  const TerrainTile& tile = tile_of;
  const std::vector<PostPlace> places =
      geometry.postPlaces(tile.level, {tile.first_column, tile.first_column + tile.columns},
                          {tile.first_row, tile.first_row + tile.rows});
  offsets.reserve(places.size());
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const Vector3 offset = places[offsets.size()].at(geometry.metres(tile.height(i, j))) - planar.origin;
      offsets.push_back(
          {static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)});
    }
  }
  return offsets;
}

}  // namespace

ScalarTransform::ScalarTransform(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry)
    : kind_(kind), tile_(&tile), geometry_(&geometry) {
  if (kind != TransformKind::kExact) planar_ = planarGridOf(tile, geometry);
  if (kind == TransformKind::kDelta) heights_ = deltasOf(tile, geometry, planar_);
  if (kind == TransformKind::kMatrix) heights_ = heightsOf(tile, geometry, planar_);
  if (kind == TransformKind::kLocal) offsets_ = offsetsOf(tile, geometry, planar_);
}

void ScalarTransform::apply(const ViewTransform& view, std::vector<Vector3>& out) const {
  out.clear();
  out.reserve(tile_->heights.size());
  switch (kind_) {
    case TransformKind::kExact:
      return applyExact(view, out);
    case TransformKind::kDelta:
      return applyDelta(view, out);
    case TransformKind::kMatrix:
      return applyMatrix(view, out);
    case TransformKind::kLocal:
      return applyLocal(view, out);
  }
}

void ScalarTransform::applyExact(const ViewTransform& view, std::vector<Vector3>& out) const {
  const TerrainTile& tile = *tile_;
  if (!geometry_->isGeodetic()) {
    const std::vector<PostPlace> places =
        geometry_->postPlaces(tile.level, columnRange(tile), rowRange(tile));
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i)
        out.push_back(view.toView(places[out.size()].at(geometry_->metres(tile.height(i, j)))));
    }
    return;
  }
  const std::vector<RowConstants> rows = geometry_->rowConstantsOf(tile.level, rowRange(tile));
  const std::vector<ColumnConstants> columns = geometry_->columnConstantsOf(tile.level, columnRange(tile));
  const Axis u(view.forward, view.eye), v(view.right * view.pixels, view.eye),
      w(view.down * view.pixels, view.eye);
  std::vector<Vector3> column_terms;
  column_terms.reserve(columns.size());
  for (const ColumnConstants& column : columns) {
    column_terms.push_back({u.m.x * column.cosine + u.m.y * column.sine,
                            v.m.x * column.cosine + v.m.y * column.sine,
                            w.m.x * column.cosine + w.m.y * column.sine});
  }
  for (int j = 0; j < tile.rows; ++j) {
    const RowConstants& row = rows[static_cast<std::size_t>(j)];
    for (int i = 0; i < tile.columns; ++i) {
      const double height = geometry_->metres(tile.height(i, j));
      const double distance = row.a + row.b * height, z = row.c + row.s * height;
      const Vector3& k = column_terms[static_cast<std::size_t>(i)];
      out.push_back({distance * k.x + (z * u.m.z - u.t), distance * k.y + (z * v.m.z - v.t),
                     distance * k.z + (z * w.m.z - w.t)});
    }
  }
}

void ScalarTransform::applyDelta(const ViewTransform& view, std::vector<Vector3>& out) const {
  const FloatGrid grid(planar_, view);
  const float* delta = heights_.data();
  FloatVector row_start =
      grid.at(static_cast<float>(-planar_.middle_column), static_cast<float>(-planar_.middle_row), *delta);
  for (int j = 0; j < tile_->rows; ++j) {
    if (j > 0) row_start = stepped(row_start, grid.north, grid.up, *delta);
    ++delta;
    FloatVector post = row_start;
    out.push_back(widened(post));
    for (int i = 1; i < tile_->columns; ++i) {
      post = stepped(post, grid.east, grid.up, *delta++);
      out.push_back(widened(post));
    }
  }
}

void ScalarTransform::applyMatrix(const ViewTransform& view, std::vector<Vector3>& out) const {
  const FloatGrid grid(planar_, view);
  const float* height = heights_.data();
  for (int j = 0; j < tile_->rows; ++j) {
    const auto y = static_cast<float>(j - planar_.middle_row);
    for (int i = 0; i < tile_->columns; ++i)
      out.push_back(widened(grid.at(static_cast<float>(i - planar_.middle_column), y, *height++)));
  }
}

void ScalarTransform::applyLocal(const ViewTransform& view, std::vector<Vector3>& out) const {
  const FloatVector u = toFloat(view.forward), v = toFloat(view.right * view.pixels),
                    w = toFloat(view.down * view.pixels), t = toFloat(view.toView(planar_.origin));
  for (const std::array<float, 3>& p : offsets_) {
    out.push_back(
        widened({u.x * p[0] + u.y * p[1] + u.z * p[2] + t.x, v.x * p[0] + v.y * p[1] + v.z * p[2] + t.y,
                 w.x * p[0] + w.y * p[1] + w.z * p[2] + t.z}));
  }
}

}  // namespace deltaz
