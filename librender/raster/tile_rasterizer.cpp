#include "librender/raster/tile_rasterizer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/tile_rasterizer.cpp"
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <numeric>

#include "librender/raster/block_lanes.h"
#include "librender/raster/rounding-inl.h"

#ifndef DELTAZ_TILE_RASTERIZER_ONCE
#define DELTAZ_TILE_RASTERIZER_ONCE
namespace deltaz {

// Triangles that are set up together.
inline constexpr std::size_t kBatch = 16;

// What set-up makes of a batch, an array for each quantity. Edge functions are per_j * j + per_i * i +
// constant >= 0 for the samples inside; the third one's gradient is what brings the sum of the three to zero.
struct alignas(64) SetUpBatch {
  std::int32_t per_j[2][kBatch], per_i[2][kBatch];
  std::int32_t at_first_block[3][kBatch];  // constant at the first pixel of the first block
  std::int32_t remainder[3]
                        [kBatch];  // 256ths of the constants that rounding took; only where samples are moved
  // Blocks of the tile that the bounding box touches, first_j | first_i << 8 | last_j << 16 | last_i << 24; a
  // first that is greater than the last if there are none.
  std::uint32_t blocks[kBatch];
  // 1/U at the first pixel of the first block, its gradient, and its range.
  float at_first[kBatch], gradient_x[kBatch], gradient_y[kBatch];
  float least[kBatch], greatest[kBatch];
};

// Edge functions of triangles in the guard band change by less than this from one pixel of a tile to any
// other, or to the block behind the last: where they start beyond it only their sign counts, and sums stay in
// 32 bits.
inline constexpr double kSaturation = 1 << 30;
static_assert(2 * 2.0 * kGuardBand * kSubPixels * (kTileSide + 2 * kBlockSide) < kSaturation);
// Samples are moved by less than half a pixel.
static_assert(2 * 2.0 * kGuardBand * kSubPixels * (kSubPixels / 2) < kSaturation * 2);

}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
using DoubleTag = hn::CappedTag<double, 8>;
using HalfFloatTag = hn::Rebind<float, DoubleTag>;
using HalfIntTag = hn::Rebind<std::int32_t, DoubleTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;

constexpr FloatTag kFloat;
constexpr IntTag kInt;
constexpr hn::RebindToUnsigned<FloatTag> kUnsigned;
constexpr std::size_t kLanes = hn::MaxLanes(FloatTag());
constexpr std::size_t kVectors = kBlockPixels / kLanes;  // of a block

class TileRasterizer {
 public:
  TileRasterizer(const Tile& tile, TileBuffer& buffer, TileCounts& counts)
      : tile_(tile),
        buffer_(buffer),
        counts_(counts),
        columns_(std::min(kTileSide, tile.width - tile.j * kTileSide)),
        rows_(std::min(kTileSide, tile.height - tile.i * kTileSide)),
        tested_(hn::Zero(kInt)),
        written_(hn::Zero(kInt)) {}

  void run(std::span<const RasterTriangle* const> triangles, std::size_t from,
           std::span<std::uint8_t> crossing) {
    const bool cut = columns_ % kBlockSide != 0 || rows_ % kBlockSide != 0;
    if (tile_.offsets != nullptr) {
      cut ? runBatches<true, true>(triangles, from, crossing)
          : runBatches<false, true>(triangles, from, crossing);
    } else {
      cut ? runBatches<true, false>(triangles, from, crossing)
          : runBatches<false, false>(triangles, from, crossing);
    }
    counts_.tested += static_cast<std::uint64_t>(sum(tested_));
    counts_.written += static_cast<std::uint64_t>(sum(written_));
  }

 private:
  // `kCut`: the picture ends inside blocks of the tile. `kMoved`: samples are not the pixels' centres.
  template <bool kCut, bool kMoved>
  void runBatches(std::span<const RasterTriangle* const> triangles, std::size_t from,
                  std::span<std::uint8_t> crossing) {
    SetUpBatch batch;
    for (std::size_t first = from; first < triangles.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, triangles.size() - first);
      setUp<kMoved>(triangles.data() + first, count, batch);
      // The triangles after next are on their way while these are drawn.
      for (std::size_t t = first + kBatch; t < std::min(first + 2 * kBatch, triangles.size()); ++t)
        hwy::Prefetch(triangles[t]);
      for (std::size_t t = 0; t < count; ++t) {
        const Outcome outcome = draw<kCut, kMoved>(batch, t, static_cast<std::int32_t>(first + t));
        settle(outcome, triangles[first + t]->crossing, crossing);
      }
    }
  }

  struct Outcome {
    bool covers = false, hidden = false;
  };

  HWY_INLINE void settle(Outcome outcome, std::uint32_t number, std::span<std::uint8_t> crossing) {
    const bool drawn = outcome.covers || outcome.hidden;
    if (number == 0) {
      counts_.drawn += drawn ? 1 : 0;
      counts_.hidden += drawn && !outcome.covers ? 1 : 0;
      counts_.no_sample += drawn ? 0 : 1;
    } else if (drawn) {
      const auto bits = static_cast<std::uint8_t>((outcome.covers ? kCrossingCovers : 0) |
                                                  (outcome.hidden ? kCrossingHidden : 0));
      std::atomic_ref<std::uint8_t>(crossing[number - 1]).fetch_or(bits, std::memory_order_relaxed);
    }
  }

  static std::int64_t sum(Ints counts) {
    alignas(64) std::int32_t lanes[kLanes];
    hn::Store(counts, kInt, lanes);
    return std::accumulate(lanes, lanes + kLanes, std::int64_t{0});
  }

  template <bool kMoved>
  HWY_INLINE void setUp(const RasterTriangle* const* triangles, std::size_t count, SetUpBatch& batch) const {
    alignas(64) RasterVertex vertex[3][kBatch];
    for (std::size_t t = 0; t < kBatch; ++t) {
      const RasterTriangle& triangle = *triangles[std::min(t, count - 1)];
      for (std::size_t k = 0; k < 3; ++k) vertex[k][t] = triangle.vertex[k];
    }
    alignas(64) float x[3][kBatch], y[3][kBatch], w[3][kBatch];
    alignas(64) std::int32_t snapped_x[3][kBatch], snapped_y[3][kBatch];
    alignas(64) float first_x[kBatch], first_y[kBatch];
    alignas(64) std::int32_t first_column[kBatch], first_row[kBatch], at_origin[3][kBatch];
    const std::int32_t tile_x = tile_.j * kTileSide, tile_y = tile_.i * kTileSide;
    for (std::size_t t = 0; t < kBatch; t += kLanes) {
      // Snapped coordinates from the tile's first pixel.
      const Floats scale = hn::Set(kFloat, static_cast<float>(kSubPixels));
      const Ints offset_x = hn::Set(kInt, (tile_.width - 1) * (kSubPixels / 2) - tile_x * kSubPixels);
      const Ints offset_y = hn::Set(kInt, (tile_.height - 1) * (kSubPixels / 2) - tile_y * kSubPixels);
      Ints sx[3], sy[3];
      Floats vw[3];
      for (std::size_t k = 0; k < 3; ++k) {
        Floats vx, vy, payload;
        hn::LoadInterleaved4(kFloat, &vertex[k][t].x, vx, vy, vw[k], payload);
        hn::Store(vx, kFloat, x[k] + t);
        hn::Store(vy, kFloat, y[k] + t);
        hn::Store(vw[k], kFloat, w[k] + t);
        sx[k] = hn::Add(roundedInGuardBand(kFloat, hn::Mul(vx, scale)), offset_x);
        sy[k] = hn::Add(roundedInGuardBand(kFloat, hn::Mul(vy, scale)), offset_y);
        hn::Store(sx[k], kInt, snapped_x[k] + t);
        hn::Store(sy[k], kInt, snapped_y[k] + t);
      }
      for (std::size_t k = 0; k < 2; ++k) {
        hn::Store(hn::Sub(sy[k], sy[k + 1]), kInt, batch.per_j[k] + t);
        hn::Store(hn::Sub(sx[k + 1], sx[k]), kInt, batch.per_i[k] + t);
      }
      const std::int32_t reach = kMoved ? tile_.offsets->reach : 0;
      const auto first_of = [&](const Ints* s) {
        const Ints least = hn::Min(hn::Min(s[0], s[1]), s[2]);
        const Ints rounded =
            hn::ShiftRight<kSubPixelBits>(hn::Add(least, hn::Set(kInt, kSubPixels - 1 - reach)));
        return hn::ShiftRight<2>(hn::Max(hn::Zero(kInt), rounded));
      };
      const auto last_of = [&](const Ints* s, int extent) {
        const Ints greatest = hn::Max(hn::Max(s[0], s[1]), s[2]);
        const Ints rounded = hn::ShiftRight<kSubPixelBits>(hn::Add(greatest, hn::Set(kInt, reach)));
        return hn::ShiftRight<2>(hn::Min(hn::Set(kInt, extent - 1), rounded));
      };
      const Ints first_j = first_of(sx), first_i = first_of(sy);
      const Ints last_j = last_of(sx, columns_), last_i = last_of(sy, rows_);
      const auto none = hn::Or(hn::Gt(first_j, last_j), hn::Gt(first_i, last_i));
      const Ints packed = hn::Or(hn::Or(first_j, hn::ShiftLeft<8>(first_i)),
                                 hn::Or(hn::ShiftLeft<16>(last_j), hn::ShiftLeft<24>(last_i)));
      hn::Store(hn::BitCast(kUnsigned, hn::IfThenElse(none, hn::Set(kInt, 1), packed)), kUnsigned,
                batch.blocks + t);
      hn::Store(hn::ShiftLeft<2>(first_j), kInt, first_column + t);
      hn::Store(hn::ShiftLeft<2>(first_i), kInt, first_row + t);
      const Floats centre_x =
          hn::Set(kFloat, static_cast<float>(tile_x) - static_cast<float>(tile_.width - 1) * 0.5F);
      const Floats centre_y =
          hn::Set(kFloat, static_cast<float>(tile_y) - static_cast<float>(tile_.height - 1) * 0.5F);
      hn::Store(hn::Add(hn::ConvertTo(kFloat, hn::ShiftLeft<2>(first_j)), centre_x), kFloat, first_x + t);
      hn::Store(hn::Add(hn::ConvertTo(kFloat, hn::ShiftLeft<2>(first_i)), centre_y), kFloat, first_y + t);
      hn::Store(hn::Min(hn::Min(vw[0], vw[1]), vw[2]), kFloat, batch.least + t);
      hn::Store(hn::Max(hn::Max(vw[0], vw[1]), vw[2]), kFloat, batch.greatest + t);
    }

    // Products of coordinates are exact in double.
    constexpr DoubleTag d;
    constexpr HalfFloatTag half_float;
    constexpr HalfIntTag half_int;
    const auto one = hn::Set(d, 1.0), zero = hn::Zero(d);
    for (std::size_t t = 0; t < kBatch; t += hn::MaxLanes(DoubleTag())) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        const auto at = [&](const std::int32_t* p) { return hn::PromoteTo(d, hn::Load(half_int, p + t)); };
        const auto vx = at(snapped_x[k]), vy = at(snapped_y[k]);
        const auto per_j = hn::Sub(vy, at(snapped_y[next])), per_i = hn::Sub(at(snapped_x[next]), vx);
        // A sample on an edge is a left or top edge's; the functions are integers, so "greater than zero" is
        // "at least zero" after subtracting one. Samples lie 256 units apart, so a 256th, rounded down, has
        // their sign.
        const auto keeps = hn::Or(hn::Gt(per_j, zero), hn::And(hn::Eq(per_j, zero), hn::Gt(per_i, zero)));
        const auto constant = hn::Sub(hn::Neg(hn::Add(hn::Mul(per_j, vx), hn::Mul(per_i, vy))),
                                      hn::IfThenElse(keeps, zero, one));
        const auto scaled = hn::Floor(hn::Mul(constant, hn::Set(d, 1.0 / kSubPixels)));
        const auto limited = hn::Min(hn::Max(scaled, hn::Set(d, -kSaturation)), hn::Set(d, kSaturation));
        hn::Store(hn::DemoteTo(half_int, limited), half_int, at_origin[k] + t);
        if constexpr (kMoved) {
          const auto rest = hn::Sub(constant, hn::Mul(scaled, hn::Set(d, kSubPixels)));
          hn::Store(hn::DemoteTo(half_int, rest), half_int, batch.remainder[k] + t);
        }
      }
      const auto at = [&](const float* p) { return hn::PromoteTo(d, hn::Load(half_float, p + t)); };
      const auto x0 = at(x[0]), y0 = at(y[0]), w0 = at(w[0]);
      const auto bx = hn::Sub(at(x[1]), x0), by = hn::Sub(at(y[1]), y0), bw = hn::Sub(at(w[1]), w0);
      const auto cx = hn::Sub(at(x[2]), x0), cy = hn::Sub(at(y[2]), y0), cw = hn::Sub(at(w[2]), w0);
      const auto determinant = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
      const auto inverse = hn::IfThenElse(hn::Eq(determinant, zero), zero, hn::Div(one, determinant));
      const auto limited = [&](auto gradient) {
        return hn::Min(hn::Max(hn::Mul(gradient, inverse), hn::Set(d, -kSteepest)), hn::Set(d, kSteepest));
      };
      const auto gradient_x = limited(hn::Sub(hn::Mul(bw, cy), hn::Mul(cw, by)));
      const auto gradient_y = limited(hn::Sub(hn::Mul(bx, cw), hn::Mul(cx, bw)));
      const auto at_first = hn::Add(w0, hn::Add(hn::Mul(gradient_x, hn::Sub(at(first_x), x0)),
                                                hn::Mul(gradient_y, hn::Sub(at(first_y), y0))));
      hn::Store(hn::DemoteTo(half_float, gradient_x), half_float, batch.gradient_x + t);
      hn::Store(hn::DemoteTo(half_float, gradient_y), half_float, batch.gradient_y + t);
      hn::Store(hn::DemoteTo(half_float, at_first), half_float, batch.at_first + t);
    }
    for (std::size_t t = 0; t < kBatch; t += kLanes) {
      const Ints column = hn::Load(kInt, first_column + t), row = hn::Load(kInt, first_row + t);
      Ints sum_j = hn::Zero(kInt), sum_i = sum_j;
      for (std::size_t k = 0; k < 3; ++k) {
        const Ints per_j = k < 2 ? hn::Load(kInt, batch.per_j[k < 2 ? k : 0] + t) : hn::Neg(sum_j);
        const Ints per_i = k < 2 ? hn::Load(kInt, batch.per_i[k < 2 ? k : 0] + t) : hn::Neg(sum_i);
        sum_j = hn::Add(sum_j, per_j);
        sum_i = hn::Add(sum_i, per_i);
        hn::Store(
            hn::Add(hn::Load(kInt, at_origin[k] + t), hn::Add(hn::Mul(per_j, column), hn::Mul(per_i, row))),
            kInt, batch.at_first_block[k] + t);
      }
    }
  }

  // A triangle with what its blocks share: edge functions and 1/U relative to a block's first pixel.
  struct Lanes {
    Ints edge[3][kVectors];
    Floats inverse_u[kVectors], least, greatest;
    Ints number;
  };

  template <bool kCut, bool kMoved>
  HWY_INLINE Outcome draw(const SetUpBatch& batch, std::size_t t, std::int32_t number) {
    const std::uint32_t blocks = batch.blocks[t];
    const auto first_j = static_cast<std::int32_t>(blocks & 0xFF),
               first_i = static_cast<std::int32_t>(blocks >> 8 & 0xFF);
    const auto last_j = static_cast<std::int32_t>(blocks >> 16 & 0xFF),
               last_i = static_cast<std::int32_t>(blocks >> 24);
    Outcome outcome;
    if (first_j > last_j) return outcome;
    const std::int32_t per_j[3] = {batch.per_j[0][t], batch.per_j[1][t],
                                   -batch.per_j[0][t] - batch.per_j[1][t]};
    const std::int32_t per_i[3] = {batch.per_i[0][t], batch.per_i[1][t],
                                   -batch.per_i[0][t] - batch.per_i[1][t]};
    Lanes lanes;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Ints lane_j = hn::Load(kInt, kLaneJ + v * kLanes), lane_i = hn::Load(kInt, kLaneI + v * kLanes);
      for (std::size_t k = 0; k < 2; ++k) {
        lanes.edge[k][v] =
            hn::Add(hn::Mul(hn::Set(kInt, per_j[k]), lane_j), hn::Mul(hn::Set(kInt, per_i[k]), lane_i));
      }
      lanes.edge[2][v] = hn::Neg(hn::Add(lanes.edge[0][v], lanes.edge[1][v]));
      Floats x = hn::Load(kFloat, kLaneX + v * kLanes), y = hn::Load(kFloat, kLaneY + v * kLanes);
      if constexpr (kMoved) {
        const Ints moved_x = hn::Load(kInt, tile_.offsets->x + v * kLanes),
                   moved_y = hn::Load(kInt, tile_.offsets->y + v * kLanes);
        for (std::size_t k = 0; k < 3; ++k) {
          const Ints moved =
              hn::Add(hn::Mul(hn::Set(kInt, per_j[k]), moved_x), hn::Mul(hn::Set(kInt, per_i[k]), moved_y));
          lanes.edge[k][v] =
              hn::Add(lanes.edge[k][v],
                      hn::ShiftRight<kSubPixelBits>(hn::Add(moved, hn::Set(kInt, batch.remainder[k][t]))));
        }
        const Floats unit = hn::Set(kFloat, 1.0F / kSubPixels);
        x = hn::Add(x, hn::Mul(hn::ConvertTo(kFloat, moved_x), unit));
        y = hn::Add(y, hn::Mul(hn::ConvertTo(kFloat, moved_y), unit));
      }
      lanes.inverse_u[v] = hn::Add(hn::Mul(hn::Set(kFloat, batch.gradient_x[t]), x),
                                   hn::Mul(hn::Set(kFloat, batch.gradient_y[t]), y));
    }
    lanes.least = hn::Set(kFloat, batch.least[t]);
    lanes.greatest = hn::Set(kFloat, batch.greatest[t]);
    lanes.number = hn::Set(kInt, number);

    const float step_x = batch.gradient_x[t] * kBlockSide, step_y = batch.gradient_y[t] * kBlockSide;
    if (last_j - first_j >= kWide) {
      std::int32_t corner[3];
      for (std::size_t k = 0; k < 3; ++k)
        corner[k] = batch.at_first_block[k][t] - per_j[k] * (first_j * kBlockSide);
      for (std::int32_t block_i = first_i; block_i <= last_i; ++block_i) {
        drawWideRow<kCut, kMoved>(lanes, per_j, per_i, corner,
                                  batch.at_first[t] + step_y * static_cast<float>(block_i - first_i), step_x,
                                  first_j, last_j, block_i, outcome);
        for (std::size_t k = 0; k < 3; ++k) corner[k] += per_i[k] * kBlockSide;
      }
      return outcome;
    }
    std::int32_t row[3] = {batch.at_first_block[0][t], batch.at_first_block[1][t],
                           batch.at_first_block[2][t]};
    const float greatest = batch.greatest[t];
    for (std::int32_t block_i = first_i; block_i <= last_i; ++block_i) {
      const float row_u = batch.at_first[t] + step_y * static_cast<float>(block_i - first_i);
      std::int32_t e0 = row[0], e1 = row[1], e2 = row[2];
      for (std::int32_t n = 0; n <= last_j - first_j; ++n) {
        const auto block = static_cast<std::size_t>(block_i * kBlocksAcross + first_j + n);
        if (greatest <= buffer_.least[block]) {
          outcome.hidden = true;
        } else {
          outcome.covers |=
              drawBlock<false, kCut>(lanes, e0, e1, e2, row_u + step_x * static_cast<float>(n), block);
        }
        e0 += per_j[0] * kBlockSide;
        e1 += per_j[1] * kBlockSide;
        e2 += per_j[2] * kBlockSide;
      }
      for (std::size_t k = 0; k < 3; ++k) row[k] += per_i[k] * kBlockSide;
    }
    return outcome;
  }

  // All 16 blocks of a row at once: which lie outside an edge, which inside all of them, which behind what is
  // there. `corner`: the edge functions at the tile's first pixel of the row.
  template <bool kCut, bool kMoved>
  HWY_INLINE void drawWideRow(const Lanes& lanes, const std::int32_t (&per_j)[3],
                              const std::int32_t (&per_i)[3], const std::int32_t (&corner)[3], float row_u,
                              float step_x, std::int32_t first_j, std::int32_t last_j, std::int32_t block_i,
                              Outcome& outcome) {
    alignas(64) std::int32_t at_block[3][kBlocksAcross];
    constexpr std::int32_t kFar = kBlockSide - 1;
    std::uint32_t outside = 0, across = 0, nearer = 0;
    for (std::size_t v = 0; v < kBlocksAcross; v += kLanes) {
      Ints least = hn::Set(kInt, 0x7FFFFFFF), greatest = least;
      const Ints block_j = hn::Iota(kInt, static_cast<std::int32_t>(v));
      for (std::size_t k = 0; k < 3; ++k) {
        const Ints value =
            hn::Add(hn::Set(kInt, corner[k]), hn::Mul(hn::Set(kInt, per_j[k] * kBlockSide), block_j));
        hn::Store(value, kInt, at_block[k] + v);
        std::int32_t low = std::min(0, kFar * per_j[k]) + std::min(0, kFar * per_i[k]);
        std::int32_t high = std::max(0, kFar * per_j[k]) + std::max(0, kFar * per_i[k]);
        if constexpr (kMoved) {
          const std::int32_t moved =
              1 + ((std::abs(per_j[k]) + std::abs(per_i[k])) * tile_.offsets->reach >> kSubPixelBits);
          low -= moved;
          high += moved;
        }
        least = hn::Min(least, hn::Add(value, hn::Set(kInt, low)));
        greatest = hn::Min(greatest, hn::Add(value, hn::Set(kInt, high)));
      }
      outside |= bits(hn::Lt(greatest, hn::Zero(kInt))) << v;
      across |= bits(hn::Lt(least, hn::Zero(kInt))) << v;
      const Floats there = hn::Load(kFloat, buffer_.least.data() + block_i * kBlocksAcross + v);
      nearer |= bits(hn::RebindMask(kInt, hn::Gt(lanes.greatest, there))) << v;
    }
    const std::uint32_t in_box = ((1U << (last_j - first_j + 1)) - 1) << first_j;
    const std::uint32_t touched = in_box & ~outside;
    outcome.hidden |= (touched & ~nearer) != 0;
    if constexpr (kCut) across = 0xFFFFFFFF;
    for (std::uint32_t left = touched & nearer; left != 0; left &= left - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(left));
      const float u = row_u + step_x * static_cast<float>(static_cast<std::int32_t>(j) - first_j);
      const std::size_t block = static_cast<std::size_t>(block_i) * kBlocksAcross + j;
      if ((across >> j & 1) != 0) {
        outcome.covers |=
            drawBlock<false, kCut>(lanes, at_block[0][j], at_block[1][j], at_block[2][j], u, block);
      } else {
        outcome.covers = true;
        drawBlock<true, kCut>(lanes, 0, 0, 0, u, block);
      }
    }
  }

  static HWY_INLINE std::uint32_t bits(hn::Mask<IntTag> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kInt, mask, bytes);
    std::uint32_t result = 0;
    std::memcpy(&result, bytes, 4);
    return result;
  }

  // `kFull`: all samples of the block are inside. `u`: 1/U at the block's first pixel. True if it covers a
  // sample.
  template <bool kFull, bool kCut>
  HWY_INLINE bool drawBlock(const Lanes& lanes, std::int32_t e0, std::int32_t e1, std::int32_t e2, float u,
                            std::size_t block) {
    float* const depth = buffer_.inverse_u.data() + block * kBlockPixels;
    const Floats first = hn::Set(kFloat, u);
    const Ints one = hn::Set(kInt, 1);
    hn::Mask<IntTag> pass[kVectors];
    Floats now[kVectors];
    auto any_covered = hn::FirstN(kInt, 0), any_pass = any_covered;
    auto all_pass = hn::FirstN(kInt, kLanes);
    for (std::size_t v = 0; v < kVectors; ++v) {
      auto covered = hn::FirstN(kInt, kLanes);
      if constexpr (!kFull) {
        const Ints inside = hn::Or(hn::Or(hn::Add(hn::Set(kInt, e0), lanes.edge[0][v]),
                                          hn::Add(hn::Set(kInt, e1), lanes.edge[1][v])),
                                   hn::Add(hn::Set(kInt, e2), lanes.edge[2][v]));
        covered = hn::Gt(inside, hn::Set(kInt, -1));
        if constexpr (kCut) {
          const auto block_j = static_cast<std::int32_t>(block % kBlocksAcross),
                     block_i = static_cast<std::int32_t>(block / kBlocksAcross);
          covered = hn::And(
              covered,
              hn::And(
                  hn::Lt(hn::Load(kInt, kLaneJ + v * kLanes), hn::Set(kInt, columns_ - block_j * kBlockSide)),
                  hn::Lt(hn::Load(kInt, kLaneI + v * kLanes), hn::Set(kInt, rows_ - block_i * kBlockSide))));
        }
        any_covered = hn::Or(any_covered, covered);
      }
      tested_ = hn::Add(tested_, hn::IfThenElseZero(covered, one));
      const Floats old = hn::Load(kFloat, depth + v * kLanes);
      const Floats value = hn::Min(hn::Max(hn::Add(first, lanes.inverse_u[v]), lanes.least), lanes.greatest);
      pass[v] = hn::And(covered, hn::RebindMask(kInt, hn::Gt(value, old)));
      now[v] = hn::IfThenElse(hn::RebindMask(kFloat, pass[v]), value, old);
      any_pass = hn::Or(any_pass, pass[v]);
      all_pass = hn::And(all_pass, pass[v]);
    }
    if (hn::AllFalse(kInt, any_pass)) return kFull || !hn::AllFalse(kInt, any_covered);
    Floats least = now[0];
    for (std::size_t v = 0; v < kVectors; ++v) {
      written_ = hn::Add(written_, hn::IfThenElseZero(pass[v], one));
      hn::Store(now[v], kFloat, depth + v * kLanes);
      least = hn::Min(least, now[v]);
    }
    std::uint32_t* const owner = buffer_.triangle.data() + block * kBlockPixels;
    std::uint32_t& whole = buffer_.whole[block];
    if (kFull && hn::AllTrue(kInt, all_pass)) {
      whole = static_cast<std::uint32_t>(hn::GetLane(lanes.number));
    } else {
      if (whole != kNoTriangle) {
        for (std::size_t v = 0; v < kVectors; ++v)
          hn::Store(hn::Set(kUnsigned, whole), kUnsigned, owner + v * kLanes);
        whole = kNoTriangle;
      }
      for (std::size_t v = 0; v < kVectors; ++v)
        hn::BlendedStore(hn::BitCast(kUnsigned, lanes.number), hn::RebindMask(kUnsigned, pass[v]), kUnsigned,
                         owner + v * kLanes);
    }
    buffer_.least[block] = hn::GetLane(hn::MinOfLanes(kFloat, least));
    return true;
  }

  // Triangles at least this many blocks wider than one are tested a row of blocks at a time.
  static constexpr std::int32_t kWide = 3;

  const Tile& tile_;
  TileBuffer& buffer_;
  TileCounts& counts_;
  const int columns_, rows_;  // of the tile that lie in the picture
  Ints tested_, written_;     // a lane each
};

void rasterize(const Tile& tile, std::span<const RasterTriangle* const> triangles, std::size_t first,
               std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts) {
  TileRasterizer(tile, buffer, counts).run(triangles, first, crossing);
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace deltaz {
namespace {
HWY_EXPORT(rasterize);
}

void TileBuffer::clear() {
  inverse_u.fill(0);
  whole.fill(kNoTriangle);
  least.fill(0);
}

void rasterizeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, std::size_t first,
                   std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts) {
  HWY_DYNAMIC_DISPATCH(rasterize)(tile, triangles, first, crossing, buffer, counts);
}

}  // namespace deltaz

#endif  // HWY_ONCE
