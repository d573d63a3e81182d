#include "libdb/access/tile_posts.h"

#include <algorithm>
#include <cstdint>

#include "libdb/access/patch_surface.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libdb/access/tile_posts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

void heightsInMetres(const std::vector<std::int32_t>& quanta, double quantum, double* metres) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t k = 0;
  for (; k + lanes <= quanta.size(); k += lanes)
    hn::StoreU(hn::Mul(hn::PromoteTo(d, hn::LoadU(di, quanta.data() + k)), hn::Set(d, quantum)), d,
               metres + k);
  for (; k < quanta.size(); ++k) metres[k] = static_cast<double>(quanta[k]) * quantum;
}

// From feet on the ellipsoid to positions: the normal is the gradient of (x^2 + y^2) / a^2 + z^2 / b^2, made
// a unit vector.
void raiseFeet(std::size_t count, double squared_ratio, const double* heights, VectorLists& feet,
               VectorLists& ups) {
  const hn::ScalableTag<double> d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const auto x = hn::LoadU(d, &feet.x[k]), y = hn::LoadU(d, &feet.y[k]), z = hn::LoadU(d, &feet.z[k]);
    const auto flat_z = hn::Div(z, hn::Set(d, squared_ratio));
    const auto squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(flat_z, flat_z));
    const auto scale = hn::Div(hn::Set(d, 1.0), hn::Sqrt(squared));
    const auto up_x = hn::Mul(x, scale), up_y = hn::Mul(y, scale), up_z = hn::Mul(flat_z, scale);
    const auto height = hn::LoadU(d, heights + k);
    hn::StoreU(up_x, d, &ups.x[k]);
    hn::StoreU(up_y, d, &ups.y[k]);
    hn::StoreU(up_z, d, &ups.z[k]);
    hn::StoreU(hn::Add(x, hn::Mul(up_x, height)), d, &feet.x[k]);
    hn::StoreU(hn::Add(y, hn::Mul(up_y, height)), d, &feet.y[k]);
    hn::StoreU(hn::Add(z, hn::Mul(up_z, height)), d, &feet.z[k]);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(heightsInMetres);
HWY_EXPORT(raiseFeet);

}  // namespace

void TilePosts::prepare(const TerrainTile& tile, const GridGeometry& geometry) {
  tile_ = &tile;
  geometry_ = &geometry;
  const std::size_t posts = tile.heights.size();
  resizePadded(heights_, posts);
  HWY_DYNAMIC_DISPATCH(heightsInMetres)(tile.heights, geometry.metres(1), heights_.data());
  valid_.clear();
  if (std::find(tile.valid.begin(), tile.valid.end(), std::uint8_t{0}) != tile.valid.end()) {
    resizePadded(valid_, posts);
    for (std::size_t k = 0; k < posts; ++k) valid_[k] = tile.valid[k] != 0 ? 1 : 0;
  }
  const PostRange columns{tile.first_column - 1, tile.first_column + tile.columns + 1};
  const PostRange rows{tile.first_row - 1, tile.first_row + tile.rows + 1};
  if (geometry.isGeodetic()) {
    geometry.axes().rows(tile.level, rows, rows_);
    geometry.axes().columns(tile.level, columns, columns_);
    return;
  }
  const std::int64_t step = std::int64_t{1} << tile.level;
  patchPositions(*geometry.patches(), columns.begin * step, columns.size(), rows.begin * step, rows.size(),
                 step, positions_);
  ups_.resize(posts);
  const EllipsoidShape& ellipsoid = geometry.header().ellipsoid;
  const double f = ellipsoid.inverse_flattening == 0 ? 0 : 1 / ellipsoid.inverse_flattening;
  HWY_DYNAMIC_DISPATCH(raiseFeet)
  (posts, (1 - f) * (1 - f), heights_.data(), positions_, ups_);
  // Whole vectors were written.
  positions_.resize(posts);
  ups_.resize(posts);
}

}  // namespace deltaz
#endif
