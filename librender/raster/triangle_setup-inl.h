// Set-up of a tile's triangles in vector code, in two stages: where they lie, which drops most of those that
// show nothing, then edge functions and the plane of 1/U of what is left. Included once for each instruction
// set.
#if defined(DELTAZ_TRIANGLE_SETUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_TRIANGLE_SETUP_INL_H
#undef DELTAZ_TRIANGLE_SETUP_INL_H
#else
#define DELTAZ_TRIANGLE_SETUP_INL_H
#endif

#include <algorithm>
#include <hwy/highway.h>
#include <span>

#include "librender/raster/block_lanes.h"
#include "librender/raster/compaction-inl.h"
#include "librender/raster/lane_bits-inl.h"
#include "librender/raster/load_fours-inl.h"
#include "librender/raster/rounding-inl.h"
#include "librender/raster/triangle_setup.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

class TriangleSetUp {
  using FloatTag = hwy::HWY_NAMESPACE::CappedTag<float, 16>;
  using IntTag = hwy::HWY_NAMESPACE::RebindToSigned<FloatTag>;
  using UnsignedTag = hwy::HWY_NAMESPACE::RebindToUnsigned<FloatTag>;
  using Floats = hwy::HWY_NAMESPACE::Vec<FloatTag>;
  using Ints = hwy::HWY_NAMESPACE::Vec<IntTag>;
  static constexpr std::size_t kLanes = hwy::HWY_NAMESPACE::MaxLanes(FloatTag());

 public:
  // Triangles that were dropped, by their number among those asked about: hidden behind what is there, or
  // without a pixel of the tile in the bounding box.
  struct Dropped {
    std::uint32_t hidden = 0, beside = 0;  // a bit each
    std::uint32_t crossing = 0;            // of all that were asked about: those that touch several tiles
  };

  explicit TriangleSetUp(const Tile& tile) : tile_(tile) {}

  // Appends up to kSetUpBatch triangles, the first of them number `first`. `least`: of the tile's blocks.
  HWY_INLINE Dropped place(const RasterTriangle* const* triangles, std::size_t count, std::uint32_t first,
                           const float* least, PlacedTriangles& placed) const {
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr FloatTag f;
    constexpr IntTag s;
    constexpr UnsignedTag u;
    const std::int32_t columns = std::min(kTileSide, tile_.width - tile_.j * kTileSide);
    const std::int32_t rows = std::min(kTileSide, tile_.height - tile_.i * kTileSide);
    Dropped dropped;
    const std::int32_t reach = tile_.offsets != nullptr ? tile_.offsets->reach : 0;
    const Floats scale = hn::Set(f, static_cast<float>(kSubPixels));
    const Ints offset_x = hn::Set(s, (tile_.width - 1) * (kSubPixels / 2) - tile_.j * kTileSide * kSubPixels);
    const Ints offset_y =
        hn::Set(s, (tile_.height - 1) * (kSubPixels / 2) - tile_.i * kTileSide * kSubPixels);
    for (std::size_t t = 0; t < kSetUpBatch; t += kLanes) {
      Floats x[3], y[3], w[3];
      Ints sx[3], sy[3];
      for (std::size_t k = 0; k < 3; ++k) {
        Floats record[4];
        loadFours(
            f, [&](std::size_t n) { return &triangles[std::min(t + n, count - 1)]->vertex[k].x; }, record);
        x[k] = record[0];
        y[k] = record[1];
        w[k] = record[2];
        sx[k] = hn::Add(roundedInGuardBand(f, hn::Mul(x[k], scale)), offset_x);
        sy[k] = hn::Add(roundedInGuardBand(f, hn::Mul(y[k], scale)), offset_y);
      }
      const auto first_of = [&](const Ints* v) {
        const Ints lowest = hn::Min(hn::Min(v[0], v[1]), v[2]);
        const Ints rounded =
            hn::ShiftRight<kSubPixelBits>(hn::Add(lowest, hn::Set(s, kSubPixels - 1 - reach)));
        return hn::ShiftRight<2>(hn::Max(hn::Zero(s), rounded));
      };
      const auto last_of = [&](const Ints* v, std::int32_t extent) {
        const Ints highest = hn::Max(hn::Max(v[0], v[1]), v[2]);
        const Ints rounded = hn::ShiftRight<kSubPixelBits>(hn::Add(highest, hn::Set(s, reach)));
        return hn::ShiftRight<2>(hn::Min(hn::Set(s, extent - 1), rounded));
      };
      const Ints first_j = first_of(sx), first_i = first_of(sy);
      const Ints last_j = last_of(sx, columns), last_i = last_of(sy, rows);
      const auto asked = hn::FirstN(s, count > t ? count - t : 0);
      const auto beside = hn::Or(hn::Gt(first_j, last_j), hn::Gt(first_i, last_i));
      // Triangles of one block, which are most of the small ones, against what the block shows.
      const auto one_block = hn::And(hn::Eq(first_j, last_j), hn::Eq(first_i, last_i));
      const Ints block = hn::IfThenElseZero(one_block, hn::Add(hn::ShiftLeft<4>(first_i), first_j));
      static_assert(kBlocksAcross == 1 << 4);
      const Floats there = hn::GatherIndex(f, least, block);
      const Floats greatest = hn::Max(hn::Max(w[0], w[1]), w[2]);
      const auto behind = hn::AndNot(beside, hn::And(one_block, hn::RebindMask(s, hn::Le(greatest, there))));
      dropped.beside |= laneBits(hn::RebindMask(u, hn::And(asked, beside))) << t;
      dropped.hidden |= laneBits(hn::RebindMask(u, hn::And(asked, behind))) << t;

      const Compaction kept(hn::AndNot(hn::Or(beside, behind), asked));
      const std::size_t end = placed.count;
      const auto append = [&](auto d, auto values, auto* to) { kept.store(d, values, to + end); };
      for (std::size_t k = 0; k < 3; ++k) {
        append(f, x[k], placed.x[k]);
        append(f, y[k], placed.y[k]);
        append(f, w[k], placed.inverse_u[k]);
        append(s, sx[k], placed.snapped_x[k]);
        append(s, sy[k], placed.snapped_y[k]);
      }
      hn::Vec<UnsignedTag> name[4];
      loadFours(
          u, [&](std::size_t n) { return &triangles[std::min(t + n, count - 1)]->node; }, name);
      dropped.crossing |= laneBits(hn::And(hn::RebindMask(u, asked), hn::Ne(name[2], hn::Zero(u)))) << t;
      append(u, name[2], placed.crossing);
      const Ints blocks = hn::Or(hn::Or(first_j, hn::ShiftLeft<8>(first_i)),
                                 hn::Or(hn::ShiftLeft<16>(last_j), hn::ShiftLeft<24>(last_i)));
      append(u, hn::BitCast(u, blocks), placed.blocks);
      append(u, hn::Iota(u, static_cast<std::uint32_t>(first + t)), placed.number);
      placed.count = end + kept.count();
    }
    return dropped;
  }

  // The first kSetUpBatch of `placed`, however many are valid.
  HWY_INLINE void setUp(const PlacedTriangles& placed, SetUpTriangles& out) const {
    namespace hn = hwy::HWY_NAMESPACE;
    constexpr FloatTag f;
    constexpr IntTag s;
    constexpr UnsignedTag u;
    alignas(64) float first_x[kSetUpBatch], first_y[kSetUpBatch];
    alignas(64) std::int32_t at_origin[3][kSetUpBatch];
    const Floats centre_x =
        hn::Set(f, static_cast<float>(tile_.j * kTileSide) - static_cast<float>(tile_.width - 1) * 0.5F);
    const Floats centre_y =
        hn::Set(f, static_cast<float>(tile_.i * kTileSide) - static_cast<float>(tile_.height - 1) * 0.5F);
    const auto first_pixel = [&](Ints blocks) { return hn::ShiftLeft<2>(hn::And(blocks, hn::Set(s, 0xFF))); };
    for (std::size_t t = 0; t < kSetUpBatch; t += kLanes) {
      const auto packed = hn::Load(u, placed.blocks + t);
      hn::Store(packed, u, out.blocks + t);
      hn::Store(hn::Load(u, placed.number + t), u, out.number + t);
      const Ints blocks = hn::BitCast(s, packed);
      const Ints column = first_pixel(blocks), row = first_pixel(hn::ShiftRight<8>(blocks));
      hn::Store(hn::Add(hn::ConvertTo(f, column), centre_x), f, first_x + t);
      hn::Store(hn::Add(hn::ConvertTo(f, row), centre_y), f, first_y + t);
      const Floats w0 = hn::Load(f, placed.inverse_u[0] + t), w1 = hn::Load(f, placed.inverse_u[1] + t),
                   w2 = hn::Load(f, placed.inverse_u[2] + t);
      hn::Store(hn::Min(hn::Min(w0, w1), w2), f, out.least + t);
      hn::Store(hn::Max(hn::Max(w0, w1), w2), f, out.greatest + t);
    }

    // Products of coordinates are exact in double.
    constexpr hn::CappedTag<double, 8> d;
    constexpr hn::Rebind<float, decltype(d)> half_float;
    constexpr hn::Rebind<std::int32_t, decltype(d)> half_int;
    const auto one = hn::Set(d, 1.0), zero = hn::Zero(d);
    for (std::size_t t = 0; t < kSetUpBatch; t += hn::MaxLanes(d)) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        const auto at = [&](const std::int32_t* p) { return hn::PromoteTo(d, hn::Load(half_int, p + t)); };
        const auto vx = at(placed.snapped_x[k]), vy = at(placed.snapped_y[k]);
        const auto per_j = hn::Sub(vy, at(placed.snapped_y[next])),
                   per_i = hn::Sub(at(placed.snapped_x[next]), vx);
        // A sample on an edge is a left or top edge's; the functions are integers, so "greater than zero" is
        // "at least zero" after subtracting one. Samples lie 256 units apart, so a 256th, rounded down, has
        // their sign.
        const auto keeps = hn::Or(hn::Gt(per_j, zero), hn::And(hn::Eq(per_j, zero), hn::Gt(per_i, zero)));
        const auto constant = hn::Sub(hn::Neg(hn::Add(hn::Mul(per_j, vx), hn::Mul(per_i, vy))),
                                      hn::IfThenElse(keeps, zero, one));
        const auto scaled = hn::Floor(hn::Mul(constant, hn::Set(d, 1.0 / kSubPixels)));
        const auto limited = hn::Min(hn::Max(scaled, hn::Set(d, -kSaturation)), hn::Set(d, kSaturation));
        hn::Store(hn::DemoteTo(half_int, limited), half_int, at_origin[k] + t);
        if (tile_.offsets != nullptr) {
          const auto rest = hn::Sub(constant, hn::Mul(scaled, hn::Set(d, kSubPixels)));
          hn::Store(hn::DemoteTo(half_int, rest), half_int, out.remainder[k] + t);
        }
      }
      const auto at = [&](const float* p) { return hn::PromoteTo(d, hn::Load(half_float, p + t)); };
      const auto x0 = at(placed.x[0]), y0 = at(placed.y[0]), w0 = at(placed.inverse_u[0]);
      const auto bx = hn::Sub(at(placed.x[1]), x0), by = hn::Sub(at(placed.y[1]), y0),
                 bw = hn::Sub(at(placed.inverse_u[1]), w0);
      const auto cx = hn::Sub(at(placed.x[2]), x0), cy = hn::Sub(at(placed.y[2]), y0),
                 cw = hn::Sub(at(placed.inverse_u[2]), w0);
      const auto determinant = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
      const auto inverse = hn::IfThenElse(hn::Eq(determinant, zero), zero, hn::Div(one, determinant));
      const auto limited = [&](auto gradient) {
        return hn::Min(hn::Max(hn::Mul(gradient, inverse), hn::Set(d, -kSteepest)), hn::Set(d, kSteepest));
      };
      const auto gradient_x = limited(hn::Sub(hn::Mul(bw, cy), hn::Mul(cw, by)));
      const auto gradient_y = limited(hn::Sub(hn::Mul(bx, cw), hn::Mul(cx, bw)));
      const auto at_first = hn::Add(w0, hn::Add(hn::Mul(gradient_x, hn::Sub(at(first_x), x0)),
                                                hn::Mul(gradient_y, hn::Sub(at(first_y), y0))));
      hn::Store(hn::DemoteTo(half_float, gradient_x), half_float, out.gradient_x + t);
      hn::Store(hn::DemoteTo(half_float, gradient_y), half_float, out.gradient_y + t);
      hn::Store(hn::DemoteTo(half_float, at_first), half_float, out.at_first + t);
    }
    for (std::size_t t = 0; t < kSetUpBatch; t += kLanes) {
      const Ints blocks = hn::BitCast(s, hn::Load(u, out.blocks + t));
      const Ints column = first_pixel(blocks), row = first_pixel(hn::ShiftRight<8>(blocks));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        const auto at = [&](const std::int32_t* p) { return hn::Load(s, p + t); };
        const Ints per_j = hn::Sub(at(placed.snapped_y[k]), at(placed.snapped_y[next])),
                   per_i = hn::Sub(at(placed.snapped_x[next]), at(placed.snapped_x[k]));
        hn::Store(per_j, s, out.per_j[k] + t);
        hn::Store(per_i, s, out.per_i[k] + t);
        const Ints at_first = hn::Add(at(at_origin[k]), hn::Add(hn::Mul(per_j, column), hn::Mul(per_i, row)));
        hn::Store(at_first, s, out.at_first_block[k] + t);
        static_assert(kBlockSide == 4);
        const Ints of_pixel = hn::Add(hn::Max(per_j, hn::Zero(s)), hn::Max(per_i, hn::Zero(s)));
        Ints rise = hn::Add(of_pixel, hn::Add(of_pixel, of_pixel));
        if (tile_.offsets != nullptr) {
          const Ints moved =
              hn::Mul(hn::Add(hn::Abs(per_j), hn::Abs(per_i)), hn::Set(s, tile_.offsets->reach));
          rise = hn::Add(rise, hn::Add(hn::ShiftRight<kSubPixelBits>(moved), hn::Set(s, 1)));
        }
        hn::Store(hn::Add(at_first, rise), s, out.greatest_in_first_block[k] + t);
      }
    }
  }

 private:
  const Tile& tile_;
};

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
