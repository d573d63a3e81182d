#include "librender/raster/tile_rasterizer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/tile_rasterizer.cpp"
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <numeric>

#include "librender/raster/block_lanes.h"
#include "librender/raster/compaction-inl.h"
#include "librender/raster/triangle_setup-inl.h"
#include "librender/raster/triangle_setup.h"

#ifndef DELTAZ_TILE_RASTERIZER_ONCE
#define DELTAZ_TILE_RASTERIZER_ONCE
namespace deltaz {

// Triangles that touch at most so many blocks each way are taken block by block out of one list, so that no
// loop ends at a triangle's end, which processors guess badly.
inline constexpr std::int32_t kSmallSide = 4;
inline constexpr std::size_t kNeighbours = kSmallSide * kSmallSide;
static_assert(kNeighbours == kBlockPixels);

// What the pixels of a triangle's blocks share: edge functions and 1/U from a block's first pixel.
struct alignas(64) PixelSteps {
  std::int32_t edge[3][kBlockPixels];
  float inverse_u[kBlockPixels];
};

// Blocks of small triangles that are to be drawn, in order.
struct alignas(64) BlockList {
  static constexpr std::size_t kRoom = kSetUpBatch * kNeighbours + kBlockPixels;
  std::int32_t edge[3][kRoom];  // at the block's first pixel
  float inverse_u[kRoom];
  std::int32_t block[kRoom], triangle[kRoom];  // the latter in the batch
  std::size_t count;
};

}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;
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
        set_up_(tile),
        buffer_(buffer),
        counts_(counts),
        columns_(std::min(kTileSide, tile.width - tile.j * kTileSide)),
        rows_(std::min(kTileSide, tile.height - tile.i * kTileSide)),
        tested_(hn::Zero(kInt)),
        written_(hn::Zero(kInt)) {}

  void run(std::span<const RasterTriangle* const> triangles, std::size_t first,
           std::span<std::uint8_t> crossing) {
    if (columns_ % kBlockSide == 0 && rows_ % kBlockSide == 0) {
      runBatches<false>(triangles, first, crossing);
    } else {
      runBatches<true>(triangles, first, crossing);
    }
    counts_.tested += static_cast<std::uint64_t>(sum(tested_));
    counts_.written += static_cast<std::uint64_t>(sum(written_));
  }

 private:
  struct Outcome {
    bool covers = false, hidden = false;
  };

  // `kCut`: the picture ends inside blocks of the tile.
  template <bool kCut>
  void runBatches(std::span<const RasterTriangle* const> triangles, std::size_t first,
                  std::span<std::uint8_t> crossing) {
    buffer_.wrote.resize(triangles.size());
    PlacedTriangles placed;
    std::memset(&placed, 0, sizeof(placed));
    for (; first < triangles.size(); first += kSetUpBatch) {
      const std::size_t count = std::min(kSetUpBatch, triangles.size() - first);
      // The triangles after next are on their way meanwhile.
      for (std::size_t t = first + kSetUpBatch; t < std::min(first + 2 * kSetUpBatch, triangles.size()); ++t)
        hwy::Prefetch(triangles[t]);
      const TriangleSetUp::Dropped dropped = set_up_.place(
          triangles.data() + first, count, static_cast<std::uint32_t>(first), buffer_.least.data(), placed);
      for (std::uint32_t left = dropped.hidden | dropped.beside; left != 0; left &= left - 1) {
        const auto t = static_cast<std::size_t>(std::countr_zero(left));
        settle({false, (dropped.hidden >> t & 1) != 0}, triangles[first + t]->crossing, crossing);
      }
      if (placed.count < kSetUpBatch) continue;
      drawBatch<kCut>(placed, kSetUpBatch, triangles, crossing);
      dropFirst(placed);
    }
    if (placed.count > 0) drawBatch<kCut>(placed, placed.count, triangles, crossing);
  }

  // Moves those behind the first kSetUpBatch, which are fewer than that, to the front.
  static HWY_INLINE void dropFirst(PlacedTriangles& placed) {
    const auto move = [](auto* values) {
      std::memcpy(values, values + kSetUpBatch, kSetUpBatch * sizeof(*values));
    };
    for (std::size_t k = 0; k < 3; ++k) {
      move(placed.x[k]);
      move(placed.y[k]);
      move(placed.inverse_u[k]);
      move(placed.snapped_x[k]);
      move(placed.snapped_y[k]);
    }
    move(placed.blocks);
    move(placed.number);
    placed.count -= kSetUpBatch;
  }

  template <bool kCut>
  HWY_INLINE void drawBatch(const PlacedTriangles& placed, std::size_t count,
                            std::span<const RasterTriangle* const> triangles,
                            std::span<std::uint8_t> crossing) {
    SetUpTriangles batch;
    set_up_.setUp(placed, batch);
    PixelSteps steps[kSetUpBatch];
    BlockList list;
    list.count = 0;
    std::uint8_t covers[kSetUpBatch] = {}, hidden[kSetUpBatch] = {};
    for (std::size_t t = 0; t < count; ++t) {
      const std::uint32_t blocks = batch.blocks[t];
      const auto first_j = static_cast<std::int32_t>(blocks & 0xFF),
                 first_i = static_cast<std::int32_t>(blocks >> 8 & 0xFF),
                 last_j = static_cast<std::int32_t>(blocks >> 16 & 0xFF),
                 last_i = static_cast<std::int32_t>(blocks >> 24);
      setSteps(batch, t, steps[t]);
      if (last_j - first_j < kSmallSide && last_i - first_i < kSmallSide) {
        hidden[t] = listBlocks(batch, t, steps[t], first_j, first_i, last_j - first_j + 1,
                               last_i - first_i + 1, list);
        continue;
      }
      // In the order they came.
      drawList<kCut>(batch, steps, list, covers);
      Outcome outcome;
      drawLarge<kCut>(batch, t, steps[t], first_j, first_i, last_j, last_i, outcome);
      covers[t] = outcome.covers;
      hidden[t] = outcome.hidden;
    }
    drawList<kCut>(batch, steps, list, covers);
    for (std::size_t t = 0; t < count; ++t)
      settle({covers[t] != 0, hidden[t] != 0}, triangles[batch.number[t]]->crossing, crossing);
  }

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

  static HWY_INLINE Ints edgeSteps(const SetUpTriangles& batch, std::size_t t, std::size_t k, std::size_t v) {
    return hn::Add(hn::Mul(hn::Set(kInt, batch.per_j[k][t]), hn::Load(kInt, kLaneJ + v)),
                   hn::Mul(hn::Set(kInt, batch.per_i[k][t]), hn::Load(kInt, kLaneI + v)));
  }

  static HWY_INLINE Floats planeSteps(const SetUpTriangles& batch, std::size_t t, Floats x, Floats y) {
    return hn::Add(hn::Mul(hn::Set(kFloat, batch.gradient_x[t]), x),
                   hn::Mul(hn::Set(kFloat, batch.gradient_y[t]), y));
  }

  HWY_INLINE void setSteps(const SetUpTriangles& batch, std::size_t t, PixelSteps& steps) const {
    for (std::size_t v = 0; v < kBlockPixels; v += kLanes) {
      Ints edges[3] = {edgeSteps(batch, t, 0, v), edgeSteps(batch, t, 1, v)};
      // The gradients of the three sum up to zero.
      edges[2] = hn::Neg(hn::Add(edges[0], edges[1]));
      Floats x = hn::Load(kFloat, kLaneX + v), y = hn::Load(kFloat, kLaneY + v);
      if (tile_.offsets != nullptr) {
        const Ints moved_x = hn::Load(kInt, tile_.offsets->x + v),
                   moved_y = hn::Load(kInt, tile_.offsets->y + v);
        for (std::size_t k = 0; k < 3; ++k) {
          const Ints moved = hn::Add(hn::Mul(hn::Set(kInt, batch.per_j[k][t]), moved_x),
                                     hn::Mul(hn::Set(kInt, batch.per_i[k][t]), moved_y));
          edges[k] = hn::Add(
              edges[k], hn::ShiftRight<kSubPixelBits>(hn::Add(moved, hn::Set(kInt, batch.remainder[k][t]))));
        }
        const Floats unit = hn::Set(kFloat, 1.0F / kSubPixels);
        x = hn::Add(x, hn::Mul(hn::ConvertTo(kFloat, moved_x), unit));
        y = hn::Add(y, hn::Mul(hn::ConvertTo(kFloat, moved_y), unit));
      }
      for (std::size_t k = 0; k < 3; ++k) hn::Store(edges[k], kInt, steps.edge[k] + v);
      hn::Store(planeSteps(batch, t, x, y), kFloat, steps.inverse_u + v);
    }
  }

  // Appends those blocks of the neighbourhood that the triangle may show in. True if some were left out
  // because it lies behind what they show.
  HWY_INLINE bool listBlocks(const SetUpTriangles& batch, std::size_t t, const PixelSteps& steps,
                             std::int32_t first_j, std::int32_t first_i, std::int32_t columns,
                             std::int32_t rows, BlockList& list) const {
    const Ints first_block = hn::Set(kInt, first_i * kBlocksAcross + first_j);
    const Ints beyond_j = hn::Set(kInt, columns), beyond_i = hn::Set(kInt, rows);
    const bool moved = tile_.offsets != nullptr;
    auto hidden = hn::FirstN(kInt, 0);
    std::size_t count = list.count;
    for (std::size_t v = 0; v < kNeighbours; v += kLanes) {
      auto touched =
          hn::And(hn::Lt(hn::Load(kInt, kLaneJ + v), beyond_j), hn::Lt(hn::Load(kInt, kLaneI + v), beyond_i));
      // A step of a block is four of a pixel's centre.
      Ints at_block[3];
      Ints greatest = hn::Zero(kInt);
      for (std::size_t k = 0; k < 3; ++k) {
        const Ints of_pixel = moved ? edgeSteps(batch, t, k, v) : hn::Load(kInt, steps.edge[k] + v);
        at_block[k] = hn::Add(hn::Set(kInt, batch.at_first_block[k][t]), hn::ShiftLeft<2>(of_pixel));
        greatest = hn::Or(greatest, hn::Add(at_block[k], hn::Set(kInt, batch.rise[k][t])));
      }
      touched = hn::And(touched, hn::Gt(greatest, hn::Set(kInt, -1)));
      const Ints block = hn::Add(first_block, hn::Load(kInt, kNeighbour + v));
      const Floats there = hn::GatherIndex(kFloat, buffer_.least.data(), block);
      const auto nearer = hn::RebindMask(kInt, hn::Gt(hn::Set(kFloat, batch.greatest[t]), there));
      hidden = hn::Or(hidden, hn::AndNot(nearer, touched));
      const auto kept = hn::And(touched, nearer);
      const Compaction compaction(kept);
      for (std::size_t k = 0; k < 3; ++k) compaction.store(kInt, at_block[k], list.edge[k] + count);
      const Floats of_pixel =
          moved ? planeSteps(batch, t, hn::Load(kFloat, kLaneX + v), hn::Load(kFloat, kLaneY + v))
                : hn::Load(kFloat, steps.inverse_u + v);
      const Floats inverse_u =
          hn::Add(hn::Set(kFloat, batch.at_first[t]), hn::Mul(hn::Set(kFloat, 4.0F), of_pixel));
      compaction.store(kFloat, inverse_u, list.inverse_u + count);
      hn::StoreU(hn::Set(kInt, static_cast<std::int32_t>(t)), kInt, list.triangle + count);
      compaction.store(kInt, block, list.block + count);
      count += compaction.count();
    }
    list.count = count;
    return !hn::AllFalse(kInt, hidden);
  }

  template <bool kCut>
  HWY_INLINE void drawList(const SetUpTriangles& batch, const PixelSteps* steps, BlockList& list,
                           std::uint8_t* covers) {
    for (std::size_t n = 0; n < list.count; ++n) {
      const auto t = static_cast<std::size_t>(list.triangle[n]),
                 block = static_cast<std::size_t>(list.block[n]);
      const std::int32_t edge[3] = {list.edge[0][n], list.edge[1][n], list.edge[2][n]};
      covers[t] |= drawBlock<false, kCut>(batch, t, steps[t], edge, list.inverse_u[n], block);
    }
    list.count = 0;
  }

  // Row by row of blocks, all 16 blocks of a row at once: which lie outside an edge, which inside all of
  // them, which behind what is there.
  template <bool kCut>
  HWY_INLINE void drawLarge(const SetUpTriangles& batch, std::size_t t, const PixelSteps& steps,
                            std::int32_t first_j, std::int32_t first_i, std::int32_t last_j,
                            std::int32_t last_i, Outcome& outcome) {
    const std::uint32_t in_box = ((1U << (last_j - first_j + 1)) - 1) << first_j;
    std::int32_t corner[3];  // the edge functions at the tile's first pixel of the row
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = batch.at_first_block[k][t] - batch.per_j[k][t] * (first_j * kBlockSide);
    const float step_x = batch.gradient_x[t] * kBlockSide, step_y = batch.gradient_y[t] * kBlockSide;
    const Floats nearest = hn::Set(kFloat, batch.greatest[t]);
    for (std::int32_t block_i = first_i; block_i <= last_i; ++block_i) {
      const float row_u = batch.at_first[t] + step_y * static_cast<float>(block_i - first_i);
      alignas(64) std::int32_t at_block[3][kBlocksAcross];
      std::uint32_t outside = 0, across = 0, nearer = 0;
      for (std::size_t v = 0; v < kBlocksAcross; v += kLanes) {
        Ints low = hn::Zero(kInt), high = low;
        const Ints block_j = hn::Iota(kInt, static_cast<std::int32_t>(v));
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t per_j = batch.per_j[k][t], per_i = batch.per_i[k][t];
          const Ints value =
              hn::Add(hn::Set(kInt, corner[k]), hn::Mul(hn::Set(kInt, per_j * kBlockSide), block_j));
          hn::Store(value, kInt, at_block[k] + v);
          const std::int32_t rise = batch.rise[k][t], fall = (kBlockSide - 1) * (per_j + per_i) - rise;
          low = hn::Or(low, hn::Add(value, hn::Set(kInt, fall)));
          high = hn::Or(high, hn::Add(value, hn::Set(kInt, rise)));
        }
        outside |= TriangleSetUp::bits(hn::Lt(high, hn::Zero(kInt))) << v;
        across |= TriangleSetUp::bits(hn::Lt(low, hn::Zero(kInt))) << v;
        const Floats there = hn::Load(kFloat, buffer_.least.data() + block_i * kBlocksAcross + v);
        nearer |= TriangleSetUp::bits(hn::RebindMask(kInt, hn::Gt(nearest, there))) << v;
      }
      for (std::size_t k = 0; k < 3; ++k) corner[k] += batch.per_i[k][t] * kBlockSide;
      const std::uint32_t touched = in_box & ~outside;
      outcome.hidden |= (touched & ~nearer) != 0;
      if constexpr (kCut) across = 0xFFFFFFFF;
      for (std::uint32_t left = touched & nearer; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        const float u = row_u + step_x * static_cast<float>(static_cast<std::int32_t>(j) - first_j);
        const std::size_t block = static_cast<std::size_t>(block_i) * kBlocksAcross + j;
        const std::int32_t edge[3] = {at_block[0][j], at_block[1][j], at_block[2][j]};
        if ((across >> j & 1) != 0) {
          outcome.covers |= drawBlock<false, kCut>(batch, t, steps, edge, u, block);
        } else {
          outcome.covers = true;
          drawBlock<true, kCut>(batch, t, steps, edge, u, block);
        }
      }
    }
  }

  // `kFull`: all samples of the block are inside. `edge` and `u`: at the block's first pixel. True if it
  // covers a sample.
  template <bool kFull, bool kCut>
  HWY_INLINE bool drawBlock(const SetUpTriangles& batch, std::size_t t, const PixelSteps& steps,
                            const std::int32_t (&edge)[3], float u, std::size_t block) {
    float* const depth = buffer_.inverse_u.data() + block * kBlockPixels;
    std::uint32_t* const owner = buffer_.triangle.data() + block * kBlockPixels;
    const Floats first = hn::Set(kFloat, u), least = hn::Set(kFloat, batch.least[t]),
                 greatest = hn::Set(kFloat, batch.greatest[t]);
    const std::uint32_t number = batch.number[t];
    const Ints one = hn::Set(kInt, 1);
    hn::Mask<IntTag> pass[kVectors];
    auto any_covered = hn::FirstN(kInt, 0), any_pass = any_covered;
    auto all_pass = hn::FirstN(kInt, kLanes);
    Floats nearest = hn::Set(kFloat, 3.0e38F);
    for (std::size_t v = 0; v < kVectors; ++v) {
      auto covered = hn::FirstN(kInt, kLanes);
      if constexpr (!kFull) {
        const auto at = [&](std::size_t k) {
          return hn::Add(hn::Set(kInt, edge[k]), hn::Load(kInt, steps.edge[k] + v * kLanes));
        };
        covered = hn::Gt(hn::Or(hn::Or(at(0), at(1)), at(2)), hn::Set(kInt, -1));
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
      const Floats value =
          hn::Min(hn::Max(hn::Add(first, hn::Load(kFloat, steps.inverse_u + v * kLanes)), least), greatest);
      pass[v] = hn::And(covered, hn::RebindMask(kInt, hn::Gt(value, old)));
      written_ = hn::Add(written_, hn::IfThenElseZero(pass[v], one));
      const Floats now = hn::IfThenElse(hn::RebindMask(kFloat, pass[v]), value, old);
      hn::Store(now, kFloat, depth + v * kLanes);
      nearest = hn::Min(nearest, now);
      any_pass = hn::Or(any_pass, pass[v]);
      all_pass = hn::And(all_pass, pass[v]);
    }
    buffer_.wrote[number] |= static_cast<std::uint8_t>(!hn::AllFalse(kInt, any_pass));
    buffer_.least[block] = hn::GetLane(hn::MinOfLanes(kFloat, nearest));
    const std::uint32_t whole = buffer_.whole[block];
    if (hn::AllTrue(kInt, all_pass)) {
      buffer_.whole[block] = number;
    } else {
      if (whole != kNoTriangle && !hn::AllFalse(kInt, any_pass)) {
        for (std::size_t v = 0; v < kVectors; ++v)
          hn::Store(hn::Set(kUnsigned, whole), kUnsigned, owner + v * kLanes);
        buffer_.whole[block] = kNoTriangle;
      }
      for (std::size_t v = 0; v < kVectors; ++v)
        hn::BlendedStore(hn::Set(kUnsigned, number), hn::RebindMask(kUnsigned, pass[v]), kUnsigned,
                         owner + v * kLanes);
    }
    return kFull || !hn::AllFalse(kInt, any_covered);
  }

  const Tile& tile_;
  const TriangleSetUp set_up_;
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
  wrote.clear();
}

void rasterizeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, std::size_t first,
                   std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts) {
  HWY_DYNAMIC_DISPATCH(rasterize)(tile, triangles, first, crossing, buffer, counts);
}

}  // namespace deltaz

#endif  // HWY_ONCE
