#include "librender/objects/view_positions.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/objects/view_positions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_VIEW_POSITIONS_ROW
#define DELTAZ_VIEW_POSITIONS_ROW
namespace deltaz {
namespace {

// One view axis as it enters the separable transform.
struct Axis {
  Vector3 m;     // Earth-centred vector, scaled to pixels for V and W
  double t = 0;  // dot(m, eye)
};

// All of a tile that does not change from row to row.
struct AxisTerms {
  std::vector<double> u, v, w;  // m.x cos(lon) + m.y sin(lon) of each axis, padded
  Axis axis_u, axis_v, axis_w;
  double quantum = 1;
};

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// The posts of one row. Whole vectors are read and written.
void geodeticRow(const RowConstants& row, const AxisTerms& terms, const std::int32_t* heights, int columns,
                 double* u, double* v, double* w) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const auto quantum = hn::Set(d, terms.quantum);
  static_assert(hn::MaxLanes(d) <= kVectorPadding);
  const auto a = hn::Set(d, row.a), b = hn::Set(d, row.b), c = hn::Set(d, row.c), s = hn::Set(d, row.s);
  const auto along = [&](const Axis& axis, const double* column_term, auto distance, auto z) {
    return hn::Add(hn::Mul(distance, hn::LoadU(d, column_term)),
                   hn::Sub(hn::Mul(z, hn::Set(d, axis.m.z)), hn::Set(d, axis.t)));
  };
  for (int i = 0; i < columns; i += static_cast<int>(hn::Lanes(d))) {
    const auto height = hn::Mul(hn::PromoteTo(d, hn::LoadU(di, heights + i)), quantum);
    const auto distance = hn::Add(a, hn::Mul(b, height));
    const auto z = hn::Add(c, hn::Mul(s, height));
    hn::StoreU(along(terms.axis_u, terms.u.data() + i, distance, z), d, u + i);
    hn::StoreU(along(terms.axis_v, terms.v.data() + i, distance, z), d, v + i);
    hn::StoreU(along(terms.axis_w, terms.w.data() + i, distance, z), d, w + i);
  }
}

// ViewTransform::toView of `columns` posts. Whole vectors are written.
void projectedRow(const ViewTransform& view, const VectorLists& places, std::size_t first, int columns,
                  double* u, double* v, double* w) {
  const hn::ScalableTag<double> d;
  const auto pixels = hn::Set(d, view.pixels);
  for (int i = 0; i < columns; i += static_cast<int>(hn::Lanes(d))) {
    const std::size_t k = first + static_cast<std::size_t>(i);
    const auto x = hn::Sub(hn::LoadU(d, &places.x[k]), hn::Set(d, view.eye.x));
    const auto y = hn::Sub(hn::LoadU(d, &places.y[k]), hn::Set(d, view.eye.y));
    const auto z = hn::Sub(hn::LoadU(d, &places.z[k]), hn::Set(d, view.eye.z));
    const auto along = [&](const Vector3& m) {
      return hn::Add(hn::Add(hn::Mul(hn::Set(d, m.x), x), hn::Mul(hn::Set(d, m.y), y)),
                     hn::Mul(hn::Set(d, m.z), z));
    };
    hn::StoreU(along(view.forward), d, u + i);
    hn::StoreU(hn::Mul(along(view.right), pixels), d, v + i);
    hn::StoreU(hn::Mul(along(view.down), pixels), d, w + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(geodeticRow);
HWY_EXPORT(projectedRow);

Axis axisOf(const Vector3& vector, const Vector3& eye) {
  return {vector, dot(vector, eye)};
}

// Of the tile's own columns; `columns` begin with the ring's.
void fillTerms(const TerrainTile& tile, const ColumnTerms& columns, const ViewTransform& view,
               AxisTerms& terms) {
  terms.axis_u = axisOf(view.forward, view.eye);
  terms.axis_v = axisOf(view.right * view.pixels, view.eye);
  terms.axis_w = axisOf(view.down * view.pixels, view.eye);
  const auto count = static_cast<std::size_t>(tile.columns);
  for (std::vector<double>* list : {&terms.u, &terms.v, &terms.w}) resizePadded(*list, count);
  for (std::size_t i = 0; i < count; ++i) {
    const double cosine = columns.cosine[i + 1], sine = columns.sine[i + 1];
    terms.u[i] = terms.axis_u.m.x * cosine + terms.axis_u.m.y * sine;
    terms.v[i] = terms.axis_v.m.x * cosine + terms.axis_v.m.y * sine;
    terms.w[i] = terms.axis_w.m.x * cosine + terms.axis_w.m.y * sine;
  }
}

std::size_t postCount(const TerrainTile& tile) {
  return tile.columns < 1 || tile.rows < 1
             ? 0
             : static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
}

// `rows` and `columns` begin with the ring's.
void geodeticPositions(const TerrainTile& tile, const std::vector<RowTerms>& rows, const ColumnTerms& columns,
                       double quantum, const ViewTransform& view, ViewPositions& positions) {
  positions.resize(postCount(tile));
  thread_local AxisTerms terms;
  fillTerms(tile, columns, view, terms);
  terms.quantum = quantum;
  // The last rows' heights are copied to where there is room to read beyond them.
  thread_local std::vector<std::int32_t> last_heights;
  for (int j = 0; j < tile.rows; ++j) {
    const std::int32_t* heights = tile.heights.data() + tile.index(0, j);
    if (tile.index(tile.columns, j) + kVectorPadding > tile.heights.size()) {
      last_heights.assign(heights, heights + tile.columns);
      last_heights.resize(last_heights.size() + kVectorPadding);
      heights = last_heights.data();
    }
    const std::size_t post = static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns);
    HWY_DYNAMIC_DISPATCH(geodeticRow)
    (rows[static_cast<std::size_t>(j) + 1].at, terms, heights, tile.columns, &positions.u[post],
     &positions.v[post], &positions.w[post]);
  }
  // Whole vectors were written.
  positions.resize(postCount(tile));
}

}  // namespace

void ViewPositions::resize(std::size_t posts) {
  for (std::vector<double>* list : {&u, &v, &w}) resizePadded(*list, posts);
}

void terrainViewPositions(const TilePosts& posts, const ViewTransform& view, ViewPositions& positions) {
  const TerrainTile& tile = posts.tile();
  if (posts.isGeodetic())
    return geodeticPositions(tile, posts.rows(), posts.columns(), posts.geometry().metres(1), view,
                             positions);
  positions.resize(postCount(tile));
  for (int j = 0; j < tile.rows; ++j) {
    const std::size_t post = static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns);
    HWY_DYNAMIC_DISPATCH(projectedRow)
    (view, posts.positions(), tile.index(0, j), tile.columns, &positions.u[post], &positions.v[post],
     &positions.w[post]);
  }
  // Whole vectors were written.
  positions.resize(postCount(tile));
}

void terrainViewPositions(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                          ViewPositions& positions) {
  if (postCount(tile) == 0) return positions.resize(0);
  if (geometry.isGeodetic()) {
    thread_local std::vector<RowTerms> rows;
    thread_local ColumnTerms columns;
    geometry.axes().rows(tile.level, {tile.first_row - 1, tile.first_row + tile.rows + 1}, rows);
    geometry.axes().columns(tile.level, {tile.first_column - 1, tile.first_column + tile.columns + 1},
                            columns);
    return geodeticPositions(tile, rows, columns, geometry.metres(1), view, positions);
  }
  thread_local TilePosts posts;
  posts.prepare(tile, geometry);
  terrainViewPositions(posts, view, positions);
}

}  // namespace deltaz
#endif
