#include "librender/objects/transform_posts.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/objects/transform_posts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_TRANSFORM_POSTS_GRID
#define DELTAZ_TRANSFORM_POSTS_GRID
namespace deltaz {
namespace {

// A view axis in single precision: what an Earth-centred offset is multiplied by, V and W scaled to pixels.
struct FloatVector {
  float x = 0, y = 0, z = 0;
};

// The flat grid's axes and middle in view coordinates: the rows of the report's 4 x 4 matrix.
struct FloatGrid {
  FloatVector east, north, up, origin;
};

// What the delta transform starts each row from.
struct RowStarts {
  std::vector<float> x, y, z;
};

// Rows are summed side by side, so their delta-z lie side by side: column by column, each of this many
// floats.
std::size_t deltaStride(const TerrainTile& tile) {
  constexpr std::size_t kWidest = 16;
  return (static_cast<std::size_t>(tile.rows) + kWidest - 1) / kWidest * kWidest;
}

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// Doubles, and as many floats.
using D = hn::ScalableTag<double>;
using DF = hn::Rebind<float, D>;
using F = hn::Vec<DF>;

F set(float value) {
  const DF df;
  return hn::Set(df, value);
}

// One row through the matrix: the flat grid's place (x, y) and height z of each post. Whole vectors are
// written.
void matrixRow(const FloatGrid& grid, const float* x, float y, const float* z, int columns, double* u,
               double* v, double* w) {
  const D d;
  const DF df;
  for (int i = 0; i < columns; i += static_cast<int>(hn::Lanes(d))) {
    const F of_x = hn::LoadU(df, x + i), of_z = hn::LoadU(df, z + i);
    const auto along = [&](float east, float north, float up, float origin) {
      const F plan = hn::Add(hn::Mul(set(east), of_x), hn::Mul(set(north), set(y)));
      return hn::PromoteTo(d, hn::Add(hn::Add(plan, hn::Mul(set(up), of_z)), set(origin)));
    };
    hn::StoreU(along(grid.east.x, grid.north.x, grid.up.x, grid.origin.x), d, u + i);
    hn::StoreU(along(grid.east.y, grid.north.y, grid.up.y, grid.origin.y), d, v + i);
    hn::StoreU(along(grid.east.z, grid.north.z, grid.up.z, grid.origin.z), d, w + i);
  }
}

// Offsets of `count` posts through the rotation, then the translation. Whole vectors are written.
void localPosts(const std::array<FloatVector, 3>& axes, const FloatVector& translation,
                const std::array<std::vector<float>, 3>& offsets, std::size_t count, double* u, double* v,
                double* w) {
  const D d;
  const DF df;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const F x = hn::LoadU(df, &offsets[0][k]), y = hn::LoadU(df, &offsets[1][k]),
            z = hn::LoadU(df, &offsets[2][k]);
    const auto along = [&](const FloatVector& m, float t) {
      const F plan = hn::Add(hn::Mul(set(m.x), x), hn::Mul(set(m.y), y));
      return hn::PromoteTo(d, hn::Add(hn::Add(plan, hn::Mul(set(m.z), z)), set(t)));
    };
    hn::StoreU(along(axes[0], translation.x), d, u + k);
    hn::StoreU(along(axes[1], translation.y), d, v + k);
    hn::StoreU(along(axes[2], translation.z), d, w + k);
  }
}

// One running sum for each row in a lane: from post to post the axis and the delta-z times the vertical.
struct RowSums {
  hn::Vec<hn::ScalableTag<float>> sum;
  float axis, up;
  void step(hn::Vec<hn::ScalableTag<float>> delta) {
    const hn::ScalableTag<float> wide;
    sum = hn::Add(sum, hn::Add(hn::Set(wide, axis), hn::Mul(delta, hn::Set(wide, up))));
  }
};

#if HWY_TARGET != HWY_SCALAR
// Four columns of rows into rows of four columns, 128 bits by 128 bits: of entry 4 b + c of columns[r] the
// entry 4 b + r of the c-th result.
void transpose(std::array<hn::Vec<hn::ScalableTag<float>>, 4>& columns) {
  const hn::ScalableTag<float> wide;
  const auto low01 = hn::InterleaveLower(wide, columns[0], columns[2]);
  const auto low23 = hn::InterleaveLower(wide, columns[1], columns[3]);
  const auto high01 = hn::InterleaveUpper(wide, columns[0], columns[2]);
  const auto high23 = hn::InterleaveUpper(wide, columns[1], columns[3]);
  columns = {hn::InterleaveLower(wide, low01, low23), hn::InterleaveUpper(wide, low01, low23),
             hn::InterleaveLower(wide, high01, high23), hn::InterleaveUpper(wide, high01, high23)};
}
#endif

// The sums of as many rows as a vector has lanes, from row `j` on, one list of the positions.
void sumRows(RowSums sums, const float* delta, std::size_t stride, int j, int rows, int columns,
             double* out) {
  const hn::ScalableTag<float> wide;
  constexpr std::size_t kMost = hn::MaxLanes(wide);
  const int count = std::min(rows - j, static_cast<int>(hn::Lanes(wide)));
  HWY_ALIGN float buffer[kMost];
  const auto row = [&](int lane) {
    return out + static_cast<std::size_t>(j + lane) * static_cast<std::size_t>(columns);
  };
  int i = 0;
  const auto next = [&] {
    if (i > 0) sums.step(hn::LoadU(wide, delta + static_cast<std::size_t>(i) * stride));
    ++i;
    return sums.sum;
  };
#if HWY_TARGET != HWY_SCALAR
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  while (i + 4 <= columns) {
    const int first = i;
    std::array<hn::Vec<decltype(wide)>, 4> block;
    for (auto& column : block) column = next();
    transpose(block);
    for (int r = 0; r < 4; ++r) {
      hn::Store(block[static_cast<std::size_t>(r)], wide, buffer);
      for (int lane = r; lane < count; lane += 4) {
        for (std::size_t c = 0; c < 4; c += hn::Lanes(d))
          hn::StoreU(hn::PromoteTo(d, hn::LoadU(df, buffer + (lane - r) + c)), d, row(lane) + first + c);
      }
    }
  }
#endif
  while (i < columns) {
    const int column = i;
    hn::Store(next(), wide, buffer);
    for (int lane = 0; lane < count; ++lane) row(lane)[column] = static_cast<double>(buffer[lane]);
  }
}

void deltaRows(const FloatGrid& grid, const RowStarts& starts, const float* delta, std::size_t stride,
               int rows, int columns, double* u, double* v, double* w) {
  const hn::ScalableTag<float> wide;
  for (int j = 0; j < rows; j += static_cast<int>(hn::Lanes(wide))) {
    const auto sum = [&](const std::vector<float>& start, float axis, float up, double* out) {
      sumRows({hn::LoadU(wide, start.data() + j), axis, up}, delta + j, stride, j, rows, columns, out);
    };
    sum(starts.x, grid.east.x, grid.up.x, u);
    sum(starts.y, grid.east.y, grid.up.y, v);
    sum(starts.z, grid.east.z, grid.up.z, w);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(matrixRow);
HWY_EXPORT(localPosts);
HWY_EXPORT(deltaRows);

FloatVector toFloat(const Vector3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// View coordinates of an Earth-centred direction.
Vector3 directionInView(const ViewTransform& view, const Vector3& d) {
  return {dot(view.forward, d), dot(view.right, d) * view.pixels, dot(view.down, d) * view.pixels};
}

FloatGrid floatGridOf(const PlanarGrid& planar, const ViewTransform& view) {
  return {toFloat(directionInView(view, planar.east)), toFloat(directionInView(view, planar.north)),
          toFloat(directionInView(view, planar.up)), toFloat(view.toView(planar.origin))};
}

// The first post goes through the whole matrix, the first of each further row is summed northwards.
void fillStarts(const FloatGrid& grid, const PlanarGrid& planar, const float* delta, int rows,
                RowStarts& starts) {
  const auto x = static_cast<float>(-planar.middle_column), y = static_cast<float>(-planar.middle_row);
  const auto fill = [&](float east, float north, float up, float origin, std::vector<float>& list) {
    // Whole vectors are read.
    list.assign(static_cast<std::size_t>(rows) + 2 * kVectorPadding, 0);
    float sum = east * x + north * y + up * delta[0] + origin;
    for (int j = 0; j < rows; ++j) {
      if (j > 0) sum = sum + (north + delta[j] * up);
      list[static_cast<std::size_t>(j)] = sum;
    }
  };
  fill(grid.east.x, grid.north.x, grid.up.x, grid.origin.x, starts.x);
  fill(grid.east.y, grid.north.y, grid.up.y, grid.origin.y, starts.y);
  fill(grid.east.z, grid.north.z, grid.up.z, grid.origin.z, starts.z);
}

std::size_t postCount(const TerrainTile& tile) {
  return tile.columns < 1 || tile.rows < 1
             ? 0
             : static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
}

// Differences and heights are taken in integers, where they are exact, before they become floats.
float metresOf(std::int64_t quanta, float quantum) {
  return static_cast<float>(quanta) * quantum;
}

}  // namespace

Result<TileTransform> TileTransform::make(TransformKind kind, const TerrainTile& tile,
                                          const GridGeometry& geometry) {
  if (!geometry.isGeodetic() && geometry.patches() == nullptr)
    return internalError("transform", "a projected grid's posts cannot be placed without its patches");
  TileTransform transform(kind, tile, geometry);
  if (postCount(tile) == 0) return transform;
  if (kind != TransformKind::kExact) transform.planar_ = planarGridOf(tile, geometry);
  if (kind == TransformKind::kDelta) transform.prepareDeltas();
  if (kind == TransformKind::kMatrix) transform.prepareHeights();
  if (kind == TransformKind::kLocal) transform.prepareOffsets();
  return transform;
}

void TileTransform::prepareDeltas() {
  const TerrainTile& tile = *tile_;
  const auto quantum = static_cast<float>(geometry_->header().quantum.value());
  const std::size_t stride = deltaStride(tile);
  heights_.assign(static_cast<std::size_t>(tile.columns) * stride, 0);
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const std::int64_t before = i > 0   ? tile.height(i - 1, j)
                                  : j > 0 ? tile.height(i, j - 1)
                                          : std::int64_t{planar_.base};
      heights_[static_cast<std::size_t>(i) * stride + static_cast<std::size_t>(j)] =
          metresOf(tile.height(i, j) - before, quantum);
    }
  }
}

void TileTransform::prepareHeights() {
  const TerrainTile& tile = *tile_;
  const auto quantum = static_cast<float>(geometry_->header().quantum.value());
  heights_.reserve(postCount(tile) + kVectorPadding);
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i)
      heights_.push_back(metresOf(std::int64_t{tile.height(i, j)} - planar_.base, quantum));
  }
  heights_.resize(postCount(tile) + kVectorPadding);
}

void TileTransform::prepareOffsets() {
  const TerrainTile& tile = *tile_;
  const std::vector<PostPlace> places =
      geometry_->postPlaces(tile.level, {tile.first_column, tile.first_column + tile.columns},
                            {tile.first_row, tile.first_row + tile.rows});
  for (std::vector<float>& list : offsets_) list.resize(places.size() + kVectorPadding);
  std::size_t k = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i, ++k) {
      const Vector3 offset = places[k].at(geometry_->metres(tile.height(i, j))) - planar_.origin;
      offsets_[0][k] = static_cast<float>(offset.x);
      offsets_[1][k] = static_cast<float>(offset.y);
      offsets_[2][k] = static_cast<float>(offset.z);
    }
  }
}

std::size_t TileTransform::storedBytes() const {
  return sizeof(float) * (heights_.size() + offsets_[0].size() + offsets_[1].size() + offsets_[2].size());
}

void TileTransform::apply(const ViewTransform& view, ViewPositions& out) const {
  if (kind_ == TransformKind::kExact) return terrainViewPositions(*tile_, *geometry_, view, out);
  out.resize(postCount(*tile_));
  if (postCount(*tile_) == 0) return;
  if (kind_ == TransformKind::kDelta) applyDelta(view, out);
  if (kind_ == TransformKind::kMatrix) applyMatrix(view, out);
  if (kind_ == TransformKind::kLocal) applyLocal(view, out);
  // Whole vectors were written.
  out.resize(postCount(*tile_));
}

void TileTransform::apply(const ViewTransform& view, std::vector<Vector3>& out) const {
  ViewPositions lists;
  apply(view, lists);
  out.clear();
  out.reserve(lists.count());
  for (std::size_t k = 0; k < lists.count(); ++k) out.push_back(lists.at(k));
}

void TileTransform::applyDelta(const ViewTransform& view, ViewPositions& out) const {
  const FloatGrid grid = floatGridOf(planar_, view);
  thread_local RowStarts starts;
  fillStarts(grid, planar_, heights_.data(), tile_->rows, starts);
  HWY_DYNAMIC_DISPATCH(deltaRows)
  (grid, starts, heights_.data(), deltaStride(*tile_), tile_->rows, tile_->columns, out.u.data(),
   out.v.data(), out.w.data());
}

void TileTransform::applyMatrix(const ViewTransform& view, ViewPositions& out) const {
  const FloatGrid grid = floatGridOf(planar_, view);
  const auto columns = static_cast<std::size_t>(tile_->columns);
  thread_local std::vector<float> x;
  x.assign(columns + kVectorPadding, 0);
  for (int i = 0; i < tile_->columns; ++i)
    x[static_cast<std::size_t>(i)] = static_cast<float>(i - planar_.middle_column);
  for (int j = 0; j < tile_->rows; ++j) {
    const std::size_t first = static_cast<std::size_t>(j) * columns;
    HWY_DYNAMIC_DISPATCH(matrixRow)
    (grid, x.data(), static_cast<float>(j - planar_.middle_row), heights_.data() + first, tile_->columns,
     &out.u[first], &out.v[first], &out.w[first]);
  }
}

void TileTransform::applyLocal(const ViewTransform& view, ViewPositions& out) const {
  const std::array<FloatVector, 3> axes = {toFloat(view.forward), toFloat(view.right * view.pixels),
                                           toFloat(view.down * view.pixels)};
  HWY_DYNAMIC_DISPATCH(localPosts)
  (axes, toFloat(view.toView(planar_.origin)), offsets_, postCount(*tile_), out.u.data(), out.v.data(),
   out.w.data());
}

Result<std::vector<Vector3>> transformPosts(TransformKind kind, const TerrainTile& tile,
                                            const GridGeometry& geometry, const ViewTransform& view) {
  DELTAZ_TRY_ASSIGN(const TileTransform transform, TileTransform::make(kind, tile, geometry));
  std::vector<Vector3> positions;
  transform.apply(view, positions);
  return positions;
}

}  // namespace deltaz
#endif
