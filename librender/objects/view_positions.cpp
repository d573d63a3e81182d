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
};

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// The posts of one row. Whole vectors are written.
void geodeticRow(const RowConstants& row, const AxisTerms& terms, const double* heights, int columns,
                 double* u, double* v, double* w) {
  const hn::ScalableTag<double> d;
  static_assert(hn::MaxLanes(d) <= kVectorPadding);
  const auto a = hn::Set(d, row.a), b = hn::Set(d, row.b), c = hn::Set(d, row.c), s = hn::Set(d, row.s);
  const auto along = [&](const Axis& axis, const double* column_term, auto distance, auto z) {
    return hn::Add(hn::Mul(distance, hn::LoadU(d, column_term)),
                   hn::Sub(hn::Mul(z, hn::Set(d, axis.m.z)), hn::Set(d, axis.t)));
  };
  for (int i = 0; i < columns; i += static_cast<int>(hn::Lanes(d))) {
    const auto height = hn::LoadU(d, heights + i);
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

// Of the tile's own columns.
void fillTerms(const TilePosts& posts, const ViewTransform& view, AxisTerms& terms) {
  terms.axis_u = axisOf(view.forward, view.eye);
  terms.axis_v = axisOf(view.right * view.pixels, view.eye);
  terms.axis_w = axisOf(view.down * view.pixels, view.eye);
  const auto columns = static_cast<std::size_t>(posts.tile().columns);
  for (std::vector<double>* list : {&terms.u, &terms.v, &terms.w}) resizePadded(*list, columns);
  for (std::size_t i = 0; i < columns; ++i) {
    const double cosine = posts.columns().cosine[i + 1], sine = posts.columns().sine[i + 1];
    terms.u[i] = terms.axis_u.m.x * cosine + terms.axis_u.m.y * sine;
    terms.v[i] = terms.axis_v.m.x * cosine + terms.axis_v.m.y * sine;
    terms.w[i] = terms.axis_w.m.x * cosine + terms.axis_w.m.y * sine;
  }
}

}  // namespace

void ViewPositions::resize(std::size_t posts) {
  for (std::vector<double>* list : {&u, &v, &w}) resizePadded(*list, posts);
}

void terrainViewPositions(const TilePosts& posts, const ViewTransform& view, ViewPositions& positions) {
  const TerrainTile& tile = posts.tile();
  const std::size_t count = static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
  positions.resize(count);
  thread_local AxisTerms terms;
  if (posts.isGeodetic()) fillTerms(posts, view, terms);
  for (int j = 0; j < tile.rows; ++j) {
    const std::size_t post = static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns);
    double *const u = &positions.u[post], *const v = &positions.v[post], *const w = &positions.w[post];
    if (posts.isGeodetic()) {
      HWY_DYNAMIC_DISPATCH(geodeticRow)
      (posts.rows()[static_cast<std::size_t>(j) + 1].at, terms, &posts.heights()[tile.index(0, j)],
       tile.columns, u, v, w);
    } else {
      HWY_DYNAMIC_DISPATCH(projectedRow)
      (view, posts.positions(), tile.index(0, j), tile.columns, u, v, w);
    }
  }
  // Whole vectors were written.
  positions.resize(count);
}

void terrainViewPositions(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                          ViewPositions& positions) {
  if (tile.columns < 1 || tile.rows < 1) {
    positions.resize(0);
    return;
  }
  thread_local TilePosts posts;
  posts.prepare(tile, geometry);
  terrainViewPositions(posts, view, positions);
}

}  // namespace deltaz
#endif
