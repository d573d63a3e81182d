#include "librender/raster/tile_rasterizer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/tile_rasterizer.cpp"
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_TILE_RASTERIZER_ONCE
#define DELTAZ_TILE_RASTERIZER_ONCE
namespace deltaz {

// Triangles that are set up together.
inline constexpr std::size_t kBatch = 16;

// What set-up makes of a batch, an array for each quantity.
struct alignas(64) SetUpBatch {
  // Edge functions: per_j * j + per_i * i + at_origin >= 0 for the samples inside, j and i from the tile's
  // first pixel.
  std::int32_t per_j[3][kBatch], per_i[3][kBatch], at_origin[3][kBatch];
  // 1/U = (gradient_x (x - anchor_x) + gradient_y (y - anchor_y)) + value
  float anchor_x[kBatch], anchor_y[kBatch], value[kBatch], gradient_x[kBatch], gradient_y[kBatch];
  float least[kBatch], greatest[kBatch];
  // Blocks of the tile that the bounding box touches; none if first > last.
  std::int32_t first_block_j[kBatch], last_block_j[kBatch], first_block_i[kBatch], last_block_i[kBatch];
};

inline constexpr std::int32_t kLaneJ[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
inline constexpr std::int32_t kLaneI[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};

// Edge functions within a tile stay below this for triangles in the guard band; beyond it only their sign
// counts.
inline constexpr double kSaturation = 1 << 30;
// Gradients of slivers that are lines but for rounding; products with distances stay finite.
inline constexpr double kSteepest = 1e15;

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
constexpr std::size_t kLanes = hn::MaxLanes(FloatTag());
constexpr std::size_t kVectors = kBlockPixels / kLanes;  // of a block

class TileRasterizer {
 public:
  TileRasterizer(const Tile& tile, TileBuffer& buffer, TileCounts& counts)
      : tile_(tile),
        buffer_(buffer),
        counts_(counts),
        origin_x_(static_cast<float>(tile.j * kTileSide) - static_cast<float>(tile.width - 1) * 0.5F),
        origin_y_(static_cast<float>(tile.i * kTileSide) - static_cast<float>(tile.height - 1) * 0.5F),
        columns_(std::min(kTileSide, tile.width - tile.j * kTileSide)),
        rows_(std::min(kTileSide, tile.height - tile.i * kTileSide)) {}

  void run(std::span<const RasterTriangle* const> triangles, std::span<std::uint8_t> crossing) {
    for (std::size_t first = 0; first < triangles.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, triangles.size() - first);
      setUp(triangles.subspan(first, count));
      for (std::size_t t = 0; t < count; ++t) {
        covers_ = hidden_ = false;
        draw(t, static_cast<std::uint32_t>(first + t));
        settle(triangles[first + t]->crossing, crossing);
      }
    }
  }

 private:
  void settle(std::uint32_t number, std::span<std::uint8_t> crossing) {
    if (number == 0) {
      counts_.drawn += covers_ || hidden_ ? 1 : 0;
      counts_.hidden += !covers_ && hidden_ ? 1 : 0;
      counts_.no_sample += covers_ || hidden_ ? 0 : 1;
      return;
    }
    const auto bits =
        static_cast<std::uint8_t>((covers_ ? kCrossingCovers : 0) | (hidden_ ? kCrossingHidden : 0));
    std::atomic_ref<std::uint8_t>(crossing[number - 1]).fetch_or(bits, std::memory_order_relaxed);
  }

  void setUp(std::span<const RasterTriangle* const> triangles) {
    alignas(64) float x[3][kBatch], y[3][kBatch], w[3][kBatch];
    alignas(64) std::int32_t snapped_x[3][kBatch], snapped_y[3][kBatch];
    for (std::size_t t = 0; t < kBatch; ++t) {
      const RasterTriangle& triangle = *triangles[std::min(t, triangles.size() - 1)];
      for (std::size_t k = 0; k < 3; ++k) {
        x[k][t] = triangle.vertex[k].x;
        y[k][t] = triangle.vertex[k].y;
        w[k][t] = triangle.vertex[k].inverse_u;
      }
    }
    const std::int32_t tile_x = tile_.j * kTileSide * kSubPixels, tile_y = tile_.i * kTileSide * kSubPixels;
    for (std::size_t t = 0; t < kBatch; t += kLanes) {
      // Snapped coordinates from the tile's first pixel.
      const Floats scale = hn::Set(kFloat, static_cast<float>(kSubPixels));
      const Ints offset_x = hn::Set(kInt, (tile_.width - 1) * (kSubPixels / 2) - tile_x);
      const Ints offset_y = hn::Set(kInt, (tile_.height - 1) * (kSubPixels / 2) - tile_y);
      Ints sx[3], sy[3];
      for (std::size_t k = 0; k < 3; ++k) {
        sx[k] = hn::Add(hn::NearestInt(hn::Mul(hn::Load(kFloat, x[k] + t), scale)), offset_x);
        sy[k] = hn::Add(hn::NearestInt(hn::Mul(hn::Load(kFloat, y[k] + t), scale)), offset_y);
        hn::Store(sx[k], kInt, snapped_x[k] + t);
        hn::Store(sy[k], kInt, snapped_y[k] + t);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        hn::Store(hn::Sub(sy[k], sy[next]), kInt, batch_.per_j[k] + t);
        hn::Store(hn::Sub(sx[next], sx[k]), kInt, batch_.per_i[k] + t);
      }
      const Ints round_up = hn::Set(kInt, kSubPixels - 1), zero = hn::Zero(kInt);
      const auto first = [&](const Ints* s) {
        const Ints least = hn::Min(hn::Min(s[0], s[1]), s[2]);
        return hn::ShiftRight<2>(hn::Max(zero, hn::ShiftRight<kSubPixelBits>(hn::Add(least, round_up))));
      };
      const auto last = [&](const Ints* s, int extent) {
        const Ints greatest = hn::Max(hn::Max(s[0], s[1]), s[2]);
        return hn::ShiftRight<2>(hn::Min(hn::Set(kInt, extent - 1), hn::ShiftRight<kSubPixelBits>(greatest)));
      };
      hn::Store(first(sx), kInt, batch_.first_block_j + t);
      hn::Store(last(sx, columns_), kInt, batch_.last_block_j + t);
      hn::Store(first(sy), kInt, batch_.first_block_i + t);
      hn::Store(last(sy, rows_), kInt, batch_.last_block_i + t);

      const Floats w0 = hn::Load(kFloat, w[0] + t), w1 = hn::Load(kFloat, w[1] + t),
                   w2 = hn::Load(kFloat, w[2] + t);
      hn::Store(hn::Load(kFloat, x[0] + t), kFloat, batch_.anchor_x + t);
      hn::Store(hn::Load(kFloat, y[0] + t), kFloat, batch_.anchor_y + t);
      hn::Store(w0, kFloat, batch_.value + t);
      hn::Store(hn::Min(hn::Min(w0, w1), w2), kFloat, batch_.least + t);
      hn::Store(hn::Max(hn::Max(w0, w1), w2), kFloat, batch_.greatest + t);
    }

    // Products of coordinates are exact in double.
    constexpr DoubleTag d;
    constexpr HalfFloatTag half_float;
    constexpr HalfIntTag half_int;
    constexpr std::size_t step = hn::MaxLanes(DoubleTag());
    const auto one = hn::Set(d, 1.0), zero = hn::Zero(d);
    for (std::size_t t = 0; t < kBatch; t += step) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto per_j = hn::PromoteTo(d, hn::Load(half_int, batch_.per_j[k] + t));
        const auto per_i = hn::PromoteTo(d, hn::Load(half_int, batch_.per_i[k] + t));
        const auto vx = hn::PromoteTo(d, hn::Load(half_int, snapped_x[k] + t));
        const auto vy = hn::PromoteTo(d, hn::Load(half_int, snapped_y[k] + t));
        // A sample on an edge is a left or top edge's; the functions are integers, so "greater than zero" is
        // "at least zero" after subtracting one. Samples lie 256 units apart, so a 256th, rounded down, has
        // their sign.
        const auto keeps = hn::Or(hn::Gt(per_j, zero), hn::And(hn::Eq(per_j, zero), hn::Gt(per_i, zero)));
        const auto at_origin = hn::Sub(hn::Neg(hn::Add(hn::Mul(per_j, vx), hn::Mul(per_i, vy))),
                                       hn::IfThenElse(keeps, zero, one));
        const auto scaled = hn::Floor(hn::Mul(at_origin, hn::Set(d, 1.0 / kSubPixels)));
        hn::Store(hn::DemoteTo(half_int,
                               hn::Min(hn::Max(scaled, hn::Set(d, -kSaturation)), hn::Set(d, kSaturation))),
                  half_int, batch_.at_origin[k] + t);
      }
      const auto load = [&](const float* p) { return hn::PromoteTo(d, hn::Load(half_float, p + t)); };
      const auto x0 = load(x[0]), y0 = load(y[0]), w0 = load(w[0]);
      const auto bx = hn::Sub(load(x[1]), x0), by = hn::Sub(load(y[1]), y0), bw = hn::Sub(load(w[1]), w0);
      const auto cx = hn::Sub(load(x[2]), x0), cy = hn::Sub(load(y[2]), y0), cw = hn::Sub(load(w[2]), w0);
      const auto determinant = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
      const auto inverse = hn::IfThenElse(hn::Eq(determinant, zero), zero, hn::Div(one, determinant));
      const auto limited = [&](auto gradient) {
        return hn::DemoteTo(half_float,
                            hn::Min(hn::Max(gradient, hn::Set(d, -kSteepest)), hn::Set(d, kSteepest)));
      };
      hn::Store(limited(hn::Mul(hn::Sub(hn::Mul(bw, cy), hn::Mul(cw, by)), inverse)), half_float,
                batch_.gradient_x + t);
      hn::Store(limited(hn::Mul(hn::Sub(hn::Mul(bx, cw), hn::Mul(cx, bw)), inverse)), half_float,
                batch_.gradient_y + t);
    }
  }

  // A triangle with what its blocks share.
  struct Lanes {
    Ints edge[3][kVectors];
    Floats inverse_u[kVectors], least, greatest;
    Ints number;
    float anchor_x, anchor_y, value, gradient_x, gradient_y;
  };

  HWY_INLINE void draw(std::size_t t, std::uint32_t number) {
    const std::int32_t first_j = batch_.first_block_j[t], last_j = batch_.last_block_j[t];
    const std::int32_t first_i = batch_.first_block_i[t], last_i = batch_.last_block_i[t];
    if (first_j > last_j || first_i > last_i) return;
    Lanes lanes;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Ints lane_j = hn::Load(kInt, kLaneJ + v * kLanes), lane_i = hn::Load(kInt, kLaneI + v * kLanes);
      for (std::size_t k = 0; k < 3; ++k) {
        lanes.edge[k][v] = hn::Add(hn::Mul(hn::Set(kInt, batch_.per_j[k][t]), lane_j),
                                   hn::Mul(hn::Set(kInt, batch_.per_i[k][t]), lane_i));
      }
      lanes.inverse_u[v] =
          hn::Add(hn::Mul(hn::Set(kFloat, batch_.gradient_x[t]), hn::ConvertTo(kFloat, lane_j)),
                  hn::Mul(hn::Set(kFloat, batch_.gradient_y[t]), hn::ConvertTo(kFloat, lane_i)));
    }
    lanes.least = hn::Set(kFloat, batch_.least[t]);
    lanes.greatest = hn::Set(kFloat, batch_.greatest[t]);
    lanes.number = hn::Set(kInt, static_cast<std::int32_t>(number));
    lanes.anchor_x = batch_.anchor_x[t];
    lanes.anchor_y = batch_.anchor_y[t];
    lanes.value = batch_.value[t];
    lanes.gradient_x = batch_.gradient_x[t];
    lanes.gradient_y = batch_.gradient_y[t];
    if (last_j - first_j >= kWide) {
      drawWide(t, lanes, first_j, last_j, first_i, last_i);
      return;
    }
    const float greatest = batch_.greatest[t];
    for (std::int32_t block_i = first_i; block_i <= last_i; ++block_i) {
      for (std::int32_t block_j = first_j; block_j <= last_j; ++block_j) {
        if (greatest <= buffer_.least[static_cast<std::size_t>(block_i * kBlocksAcross + block_j)]) {
          hidden_ = true;
          continue;
        }
        std::int32_t corner[3];
        for (std::size_t k = 0; k < 3; ++k) corner[k] = cornerValue(t, k, block_j, block_i);
        drawBlock<false>(lanes, corner, block_j, block_i);
      }
    }
  }

  std::int32_t cornerValue(std::size_t t, std::size_t k, std::int32_t block_j, std::int32_t block_i) const {
    return batch_.at_origin[k][t] + batch_.per_j[k][t] * (block_j * kBlockSide) +
           batch_.per_i[k][t] * (block_i * kBlockSide);
  }

  // Row by row of blocks, all 16 of a row at once: which lie outside an edge, which inside all of them, which
  // behind what is there.
  HWY_INLINE void drawWide(std::size_t t, const Lanes& lanes, std::int32_t first_j, std::int32_t last_j,
                           std::int32_t first_i, std::int32_t last_i) {
    const std::uint32_t in_box = ((1U << (last_j - first_j + 1)) - 1) << first_j;
    constexpr std::int32_t kFar = kBlockSide - 1;
    for (std::int32_t block_i = first_i; block_i <= last_i; ++block_i) {
      std::uint32_t outside = 0, across = 0, nearer = 0;
      for (std::size_t v = 0; v < kVectors; ++v) {
        auto least = hn::Set(kInt, 0x7FFFFFFF), greatest = least;
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t per_j = batch_.per_j[k][t], per_i = batch_.per_i[k][t];
          const Ints at_corner = hn::Add(hn::Set(kInt, cornerValue(t, k, 0, block_i)),
                                         hn::Mul(hn::Set(kInt, per_j * kBlockSide),
                                                 hn::Iota(kInt, static_cast<std::int32_t>(v * kLanes))));
          const std::int32_t low = std::min(0, kFar * per_j) + std::min(0, kFar * per_i);
          const std::int32_t high = std::max(0, kFar * per_j) + std::max(0, kFar * per_i);
          least = hn::Min(least, hn::Add(at_corner, hn::Set(kInt, low)));
          greatest = hn::Min(greatest, hn::Add(at_corner, hn::Set(kInt, high)));
        }
        outside |= bits(hn::Lt(greatest, hn::Zero(kInt))) << (v * kLanes);
        across |= bits(hn::Lt(least, hn::Zero(kInt))) << (v * kLanes);
        const Floats there = hn::Load(kFloat, buffer_.least.data() + block_i * kBlocksAcross + v * kLanes);
        nearer |= floatBits(hn::Gt(lanes.greatest, there)) << (v * kLanes);
      }
      const std::uint32_t touched = in_box & ~outside;
      if ((touched & ~nearer) != 0) hidden_ = true;
      for (std::uint32_t left = touched & nearer; left != 0; left &= left - 1) {
        const auto block_j = static_cast<std::int32_t>(std::countr_zero(left));
        std::int32_t corner[3] = {0, 0, 0};
        const bool partial =
            columns_ - block_j * kBlockSide < kBlockSide || rows_ - block_i * kBlockSide < kBlockSide;
        if ((across >> block_j & 1) != 0 || partial) {
          for (std::size_t k = 0; k < 3; ++k) corner[k] = cornerValue(t, k, block_j, block_i);
          drawBlock<false>(lanes, corner, block_j, block_i);
        } else {
          drawBlock<true>(lanes, corner, block_j, block_i);
        }
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
  static HWY_INLINE std::uint32_t floatBits(hn::Mask<FloatTag> mask) {
    return bits(hn::RebindMask(kInt, mask));
  }

  // `kFull`: all samples of the block are inside.
  template <bool kFull>
  HWY_INLINE void drawBlock(const Lanes& lanes, const std::int32_t (&corner)[3], std::int32_t block_j,
                            std::int32_t block_i) {
    const auto block = static_cast<std::size_t>(block_i * kBlocksAcross + block_j);
    float* const depth = buffer_.inverse_u.data() + block * kBlockPixels;
    std::uint32_t* const owner = buffer_.triangle.data() + block * kBlockPixels;
    const float dx = origin_x_ + static_cast<float>(block_j * kBlockSide) - lanes.anchor_x;
    const float dy = origin_y_ + static_cast<float>(block_i * kBlockSide) - lanes.anchor_y;
    const Floats base = hn::Set(kFloat, lanes.value + (lanes.gradient_x * dx + lanes.gradient_y * dy));
    const int columns = columns_ - block_j * kBlockSide, rows = rows_ - block_i * kBlockSide;
    bool wrote = false;
    Floats least = hn::Set(kFloat, 3.4e38F);
    for (std::size_t v = 0; v < kVectors; ++v) {
      auto covered = hn::FirstN(kInt, kLanes);
      if constexpr (!kFull) {
        const Ints e0 = hn::Add(hn::Set(kInt, corner[0]), lanes.edge[0][v]);
        const Ints e1 = hn::Add(hn::Set(kInt, corner[1]), lanes.edge[1][v]);
        const Ints e2 = hn::Add(hn::Set(kInt, corner[2]), lanes.edge[2][v]);
        covered = hn::Gt(hn::Or(hn::Or(e0, e1), e2), hn::Set(kInt, -1));
        if (columns < kBlockSide || rows < kBlockSide) {
          covered =
              hn::And(covered, hn::And(hn::Lt(hn::Load(kInt, kLaneJ + v * kLanes), hn::Set(kInt, columns)),
                                       hn::Lt(hn::Load(kInt, kLaneI + v * kLanes), hn::Set(kInt, rows))));
        }
      }
      const std::size_t tested = hn::CountTrue(kInt, covered);
      const Floats old = hn::Load(kFloat, depth + v * kLanes);
      if (tested == 0) {
        least = hn::Min(least, old);
        continue;
      }
      covers_ = true;
      counts_.tested += tested;
      const Floats value = hn::Min(hn::Max(hn::Add(base, lanes.inverse_u[v]), lanes.least), lanes.greatest);
      const auto pass = hn::And(hn::RebindMask(kFloat, covered), hn::Gt(value, old));
      const std::size_t written = hn::CountTrue(kFloat, pass);
      const Floats now = hn::IfThenElse(pass, value, old);
      least = hn::Min(least, now);
      if (written == 0) continue;
      wrote = true;
      counts_.written += written;
      hn::Store(now, kFloat, depth + v * kLanes);
      hn::BlendedStore(lanes.number, hn::RebindMask(kInt, pass), kInt,
                       reinterpret_cast<std::int32_t*>(owner) + v * kLanes);
    }
    if (wrote) buffer_.least[block] = hn::GetLane(hn::MinOfLanes(kFloat, least));
  }

  // Triangles at least this many blocks wider than one are tested a row of blocks at a time.
  static constexpr std::int32_t kWide = 3;

  const Tile& tile_;
  TileBuffer& buffer_;
  TileCounts& counts_;
  const float origin_x_, origin_y_;  // of the tile's first pixel, from the picture's centre
  const int columns_, rows_;         // of the tile that lie in the picture
  bool covers_ = false, hidden_ = false;
  SetUpBatch batch_;
};

void rasterize(const Tile& tile, std::span<const RasterTriangle* const> triangles,
               std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts) {
  TileRasterizer(tile, buffer, counts).run(triangles, crossing);
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
  least.fill(0);
}

void rasterizeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles,
                   std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts) {
  HWY_DYNAMIC_DISPATCH(rasterize)(tile, triangles, crossing, buffer, counts);
}

}  // namespace deltaz

#endif  // HWY_ONCE
