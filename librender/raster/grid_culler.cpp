#include "librender/raster/grid_culler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/grid_culler.cpp"
#include <algorithm>
#include <array>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "librender/raster/compaction-inl.h"
#include "librender/raster/raster_triangle.h"
#include "librender/raster/tile_bins.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<std::int32_t, 16>;
using Vec = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;

// Least and greatest of the coordinates of a face, or of a cell.
struct Range {
  Vec least, greatest;
};

HWY_INLINE Range joined(Range range, Vec value) {
  return {hn::Min(range.least, value), hn::Max(range.greatest, value)};
}

class FaceCuller {
 public:
  FaceCuller(int width, int height, std::int32_t reach = 0)
      : reach_(hn::Set(d_, reach)),
        to_first_(hn::Set(d_, kSubPixels - 1 - reach)),
        first_(hn::Set(d_, -reach)),
        beyond_x_(hn::Set(d_, (width - 1) * kSubPixels + reach)),
        beyond_y_(hn::Set(d_, (height - 1) * kSubPixels + reach)),
        last_x_(hn::Set(d_, (width - 1) * kSubPixels)),
        last_y_(hn::Set(d_, (height - 1) * kSubPixels)),
        guard_low_x_(hn::Set(d_, (width - 1) * (kSubPixels / 2) - kGuardCoordinate + 1)),
        guard_low_y_(hn::Set(d_, (height - 1) * (kSubPixels / 2) - kGuardCoordinate + 1)),
        guard_high_x_(hn::Set(d_, (width - 1) * (kSubPixels / 2) + kGuardCoordinate - 1)),
        guard_high_y_(hn::Set(d_, (height - 1) * (kSubPixels / 2) + kGuardCoordinate - 1)) {}

  // Bottom faces to the front of `out`, top faces to the front of `top`.
  void cullRow(const GridRow& row, CulledFaces& out, CulledFaces& top, CullCounts& counts) const {
    const std::size_t lanes = hn::Lanes(d_);
    for (std::size_t cell = 0; cell < row.cells; cell += lanes) {
      const Vec sw_x = hn::LoadU(d_, row.south_x + cell), sw_y = hn::LoadU(d_, row.south_y + cell);
      const Vec se_x = hn::LoadU(d_, row.south_x + cell + 1), se_y = hn::LoadU(d_, row.south_y + cell + 1);
      const Vec nw_x = hn::LoadU(d_, row.north_x + cell), nw_y = hn::LoadU(d_, row.north_y + cell);
      const Vec ne_x = hn::LoadU(d_, row.north_x + cell + 1), ne_y = hn::LoadU(d_, row.north_y + cell + 1);
      Mask bottom_in = hn::FirstN(d_, row.cells - cell), top_in = bottom_in;
      if (row.drawn != nullptr) {
        const hn::Rebind<std::uint8_t, Tag> bytes;
        const Vec drawn = hn::PromoteTo(d_, hn::LoadU(bytes, row.drawn + cell));
        bottom_in = hn::And(bottom_in, hn::TestBit(drawn, hn::Set(d_, 1)));
        top_in = hn::And(top_in, hn::TestBit(drawn, hn::Set(d_, 2)));
      }
      counts.in += hn::CountTrue(d_, bottom_in) + hn::CountTrue(d_, top_in);

      // The diagonal is both faces'.
      const Range diagonal_x{hn::Min(sw_x, ne_x), hn::Max(sw_x, ne_x)};
      const Range diagonal_y{hn::Min(sw_y, ne_y), hn::Max(sw_y, ne_y)};
      // Whole strips of cells lie beside the picture more often than not.
      const Mask beside =
          isBeside(joined(joined(diagonal_x, se_x), nw_x), joined(joined(diagonal_y, se_y), nw_y));
      if (hn::AllTrue(d_, hn::Or(beside, hn::Not(hn::Or(bottom_in, top_in))))) {
        counts.outside += hn::CountTrue(d_, bottom_in) + hn::CountTrue(d_, top_in);
        continue;
      }
      const Vec along_x = hn::Sub(ne_x, sw_x), along_y = hn::Sub(ne_y, sw_y);
      const Vec face = hn::Iota(d_, static_cast<std::int32_t>(cell));
      const Vec bottom_face = hn::Add(face, face);
      // Twice the area, positive for clockwise on the screen: bottom (SW, NE, SE), top (SW, NW, NE).
      const Vec bottom_area =
          hn::Sub(hn::Mul(along_x, hn::Sub(se_y, sw_y)), hn::Mul(hn::Sub(se_x, sw_x), along_y));
      const Vec top_area =
          hn::Sub(hn::Mul(hn::Sub(nw_x, sw_x), along_y), hn::Mul(along_x, hn::Sub(nw_y, sw_y)));
      cull(joined(diagonal_x, se_x), joined(diagonal_y, se_y), bottom_area, bottom_in, bottom_face, out,
           counts);
      cull(joined(diagonal_x, nw_x), joined(diagonal_y, nw_y), top_area, top_in,
           hn::Add(bottom_face, hn::Set(d_, 1)), top, counts);
    }
  }

  // Faces by the vertices corner(n)[0..2] in the order they run clockwise on the screen.
  template <class Corners>
  void cullByCorners(std::size_t count, const std::int32_t* snapped_x, const std::int32_t* snapped_y,
                     Corners corners, CulledFaces& out, CullCounts& counts) const {
    // Vectors of them are collected one by one: hardware gathers take several times as long. Many at a time,
    // for what has just been stored in parts can be loaded as a whole only after a while.
    constexpr std::size_t kCollected = 64;
    alignas(64) std::int32_t x[3][kCollected] = {}, y[3][kCollected] = {};
    for (std::size_t first = 0; first < count; first += kCollected) {
      const std::size_t collected = std::min(kCollected, count - first);
      for (std::size_t n = 0; n < collected; ++n) {
        const std::array<std::uint32_t, 3> vertex = corners(first + n);
        for (std::size_t k = 0; k < 3; ++k) {
          x[k][n] = snapped_x[vertex[k]];
          y[k][n] = snapped_y[vertex[k]];
        }
      }
      for (std::size_t n = 0; n < collected; n += hn::Lanes(d_)) {
        const Vec ax = hn::Load(d_, x[0] + n), ay = hn::Load(d_, y[0] + n);
        const Vec bx = hn::Load(d_, x[1] + n), by = hn::Load(d_, y[1] + n);
        const Vec cx = hn::Load(d_, x[2] + n), cy = hn::Load(d_, y[2] + n);
        const Mask in = hn::FirstN(d_, collected - n);
        counts.in += hn::CountTrue(d_, in);
        const Vec area =
            hn::Sub(hn::Mul(hn::Sub(bx, ax), hn::Sub(cy, ay)), hn::Mul(hn::Sub(cx, ax), hn::Sub(by, ay)));
        cull(joined({hn::Min(ax, bx), hn::Max(ax, bx)}, cx), joined({hn::Min(ay, by), hn::Max(ay, by)}, cy),
             area, in, hn::Iota(d_, static_cast<std::int32_t>(first + n)), out, counts);
      }
    }
  }

 private:
  // Of ranges without a vertex before the hither plane, or with nothing but such.
  HWY_INLINE Mask isBeside(Range x, Range y) const {
    const Vec hither = hn::Set(d_, kBeforeHitherCoordinate);
    const Mask beside = hn::Or(hn::Or(hn::Lt(x.greatest, first_), hn::Gt(x.least, beyond_x_)),
                               hn::Or(hn::Lt(y.greatest, first_), hn::Gt(y.least, beyond_y_)));
    return hn::Or(hn::And(beside, hn::Lt(x.greatest, hither)), hn::Eq(x.least, hither));
  }

  HWY_INLINE void cull(Range x, Range y, Vec area, Mask in, Vec face, CulledFaces& out,
                       CullCounts& counts) const {
    const Mask beside = hn::And(in, isBeside(x, y));
    const Vec limit = hn::Set(d_, (1 << 15) - 1);
    const Mask exceptional = hn::AndNot(
        beside,
        hn::And(in,
                hn::Or(hn::Or(hn::Gt(hn::Sub(x.greatest, x.least), limit),
                              hn::Gt(hn::Sub(y.greatest, y.least), limit)),
                       hn::Or(hn::Or(hn::Lt(x.least, guard_low_x_), hn::Gt(x.greatest, guard_high_x_)),
                              hn::Or(hn::Lt(y.least, guard_low_y_), hn::Gt(y.greatest, guard_high_y_))))));
    Mask left = hn::AndNot(hn::Or(beside, exceptional), in);
    const Mask back = hn::And(left, hn::Lt(area, hn::Zero(d_)));
    left = hn::AndNot(back, left);
    const Vec first_j = hn::Max(hn::Zero(d_), hn::ShiftRight<kSubPixelBits>(hn::Add(x.least, to_first_)));
    const Vec first_i = hn::Max(hn::Zero(d_), hn::ShiftRight<kSubPixelBits>(hn::Add(y.least, to_first_)));
    const Vec last_j = hn::ShiftRight<kSubPixelBits>(hn::Min(hn::Add(x.greatest, reach_), last_x_));
    const Vec last_i = hn::ShiftRight<kSubPixelBits>(hn::Min(hn::Add(y.greatest, reach_), last_y_));
    const Mask empty = hn::And(
        left, hn::Or(hn::Eq(area, hn::Zero(d_)), hn::Or(hn::Gt(first_j, last_j), hn::Gt(first_i, last_i))));
    left = hn::AndNot(empty, left);
    counts.outside += hn::CountTrue(d_, beside);
    counts.back_facing += hn::CountTrue(d_, back);
    counts.no_sample += hn::CountTrue(d_, empty);
    const Mask kept = hn::Or(left, exceptional);
    if (hn::AllFalse(d_, kept)) return;

    constexpr int kTileShift = 6;
    static_assert(1 << kTileShift == kTileSide);
    const Vec range = hn::Or(
        hn::Or(hn::ShiftRight<kTileShift>(first_j), hn::ShiftLeft<8>(hn::ShiftRight<kTileShift>(first_i))),
        hn::Or(hn::ShiftLeft<16>(hn::ShiftRight<kTileShift>(last_j)),
               hn::ShiftLeft<24>(hn::ShiftRight<kTileShift>(last_i))));
    const Vec tiles =
        hn::IfThenElse(exceptional, hn::Set(d_, static_cast<std::int32_t>(kExceptional)), range);
    const hn::RebindToUnsigned<Tag> du;
    const Compaction compaction(kept);
    compaction.store(du, hn::BitCast(du, face), out.face + out.count);
    compaction.store(du, hn::BitCast(du, tiles), out.tiles + out.count);
    out.count += compaction.count();
  }

  const Tag d_;
  const Vec reach_, to_first_, first_, beyond_x_, beyond_y_;
  const Vec last_x_, last_y_, guard_low_x_, guard_low_y_, guard_high_x_, guard_high_y_;
};

void cullRow(const GridRow& row, int width, int height, CulledFaces& out, CulledFaces& top,
             CullCounts& counts, std::int32_t reach) {
  FaceCuller(width, height, reach).cullRow(row, out, top, counts);
}

void cullByCorners(const CornerFaces& faces, int width, int height, CulledFaces& out, CullCounts& counts,
                   std::int32_t reach) {
  FaceCuller(width, height, reach)
      .cullByCorners(
          faces.count, faces.snapped_x, faces.snapped_y,
          [&](std::size_t n) {
            const std::uint32_t* const vertex = faces.words + 4 * n;
            return std::array{vertex[0], vertex[2], vertex[1]};
          },
          out, counts);
}

void cullIndexed(const IndexedFaces& faces, int width, int height, CulledFaces& out, CullCounts& counts) {
  FaceCuller(width, height)
      .cullByCorners(
          faces.count, faces.snapped_x, faces.snapped_y,
          [&](std::size_t n) {
            return std::array<std::uint32_t, 3>{faces.first[n], faces.second[n], faces.third[n]};
          },
          out, counts);
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace deltaz {
namespace {
HWY_EXPORT(cullRow);
HWY_EXPORT(cullIndexed);
HWY_EXPORT(cullByCorners);
}  // namespace

void cullGridRow(const GridRow& row, int width, int height, CulledFaces& out, CullCounts& counts,
                 std::int32_t reach) {
  out.count = 0;
  // Top faces wait in the upper half until the number of bottom faces is known.
  const std::size_t half = row.cells + kRowPadding;
  CulledFaces top{out.face + half, out.tiles + half, 0};
  HWY_DYNAMIC_DISPATCH(cullRow)(row, width, height, out, top, counts, reach);
  std::copy_n(top.face, top.count, out.face + out.count);
  std::copy_n(top.tiles, top.count, out.tiles + out.count);
  out.count += top.count;
}

void cullIndexedFaces(const IndexedFaces& faces, int width, int height, CulledFaces& out,
                      CullCounts& counts) {
  out.count = 0;
  HWY_DYNAMIC_DISPATCH(cullIndexed)(faces, width, height, out, counts);
}

void cullCornerFaces(const CornerFaces& faces, int width, int height, CulledFaces& out, CullCounts& counts,
                     std::int32_t reach) {
  out.count = 0;
  HWY_DYNAMIC_DISPATCH(cullByCorners)(faces, width, height, out, counts, reach);
}

}  // namespace deltaz

#endif  // HWY_ONCE
