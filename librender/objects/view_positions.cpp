#include "librender/objects/view_positions.h"

#include <algorithm>
#include <array>
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
struct ColumnTerms {
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

// The posts of one row. Whole vectors are written, up to ViewPositions::kPadding doubles from each pointer's
// last post on. `heights` may be read that far, too.
void geodeticRow(const RowConstants& row, const ColumnTerms& terms, const std::int32_t* heights, int columns,
                 double* u, double* v, double* w) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  static_assert(hn::MaxLanes(d) <= ViewPositions::kPadding);
  const auto quantum = hn::Set(d, terms.quantum);
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

}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(geodeticRow);

PostRange columnRange(const TerrainTile& tile) {
  return {tile.first_column, tile.first_column + tile.columns};
}
PostRange rowRange(const TerrainTile& tile) {
  return {tile.first_row, tile.first_row + tile.rows};
}

Axis axisOf(const Vector3& vector, const Vector3& eye) {
  return {vector, dot(vector, eye)};
}

void geodeticPositions(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                       ViewPositions& positions) {
  const std::vector<RowConstants> rows = geometry.rowConstantsOf(tile.level, rowRange(tile));
  const std::vector<ColumnConstants> columns = geometry.columnConstantsOf(tile.level, columnRange(tile));
  thread_local ColumnTerms terms;
  terms.axis_u = axisOf(view.forward, view.eye);
  terms.axis_v = axisOf(view.right * view.pixels, view.eye);
  terms.axis_w = axisOf(view.down * view.pixels, view.eye);
  terms.quantum = geometry.metres(1);
  for (std::vector<double>* list : {&terms.u, &terms.v, &terms.w})
    list->assign(columns.size() + ViewPositions::kPadding, 0);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto term = [&](const Axis& axis) {
      return axis.m.x * columns[i].cosine + axis.m.y * columns[i].sine;
    };
    terms.u[i] = term(terms.axis_u);
    terms.v[i] = term(terms.axis_v);
    terms.w[i] = term(terms.axis_w);
  }
  // The last rows' heights are copied to where there is room to read beyond them.
  thread_local std::vector<std::int32_t> last_heights;
  for (int j = 0; j < tile.rows; ++j) {
    const std::int32_t* heights = tile.heights.data() + tile.index(0, j);
    if (tile.index(tile.columns, j) + ViewPositions::kPadding > tile.heights.size()) {
      last_heights.assign(heights, heights + tile.columns);
      last_heights.resize(last_heights.size() + ViewPositions::kPadding);
      heights = last_heights.data();
    }
    const std::size_t post = static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns);
    HWY_DYNAMIC_DISPATCH(geodeticRow)
    (rows[static_cast<std::size_t>(j)], terms, heights, tile.columns, positions.u.data() + post,
     positions.v.data() + post, positions.w.data() + post);
  }
}

// Posts of a projected grid do not separate into rows and columns.
void projectedPositions(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                        ViewPositions& positions) {
  const std::vector<PostPlace> places = geometry.postPlaces(tile.level, columnRange(tile), rowRange(tile));
  std::size_t post = 0;
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i, ++post) {
      const Vector3 position = view.toView(places[post].at(geometry.metres(tile.height(i, j))));
      positions.u[post] = position.x;
      positions.v[post] = position.y;
      positions.w[post] = position.z;
    }
  }
}

}  // namespace

void ViewPositions::resize(std::size_t posts) {
  for (std::vector<double>* list : {&u, &v, &w}) {
    list->resize(posts + kPadding);
    std::fill(list->begin() + static_cast<std::ptrdiff_t>(posts), list->end(), 0.0);
  }
}

void terrainViewPositions(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                          ViewPositions& positions) {
  const std::size_t posts = tile.columns < 1 || tile.rows < 1 ? 0
                                                              : static_cast<std::size_t>(tile.columns) *
                                                                    static_cast<std::size_t>(tile.rows);
  positions.resize(posts);
  if (posts == 0) return;
  if (geometry.isGeodetic()) {
    geodeticPositions(tile, geometry, view, positions);
  } else {
    projectedPositions(tile, geometry, view, positions);
  }
  // Whole vectors were written.
  positions.resize(posts);
}

}  // namespace deltaz
#endif
