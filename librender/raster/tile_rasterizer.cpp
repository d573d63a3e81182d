#include "librender/raster/tile_rasterizer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/tile_rasterizer.cpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "librender/raster/across_lanes-inl.h"
#include "librender/raster/block_lanes.h"
#include "librender/raster/compaction-inl.h"
#include "librender/raster/crossing_fates.h"
#include "librender/raster/load_fours-inl.h"
#include "librender/raster/triangle_setup-inl.h"
#include "librender/raster/triangle_setup.h"

#ifndef DELTAZ_TILE_RASTERIZER_ONCE
#define DELTAZ_TILE_RASTERIZER_ONCE
namespace deltaz {

// Blocks are looked at 4 x 4 at a time.
inline constexpr std::int32_t kPatchSide = 4;
inline constexpr std::size_t kPatchBlocks = kPatchSide * kPatchSide;
static_assert(kPatchBlocks == kBlockPixels);

// What the blocks of a triangle share: edge functions and 1/U from a block's first pixel, and to be loaded
// together the least and the greatest 1/U and, as bits, the triangle's number in the tile and its bit among
// those of the batch.
struct alignas(64) PixelSteps {
  std::int32_t edge[3][kBlockPixels];
  float inverse_u[kBlockPixels];
  float shared[4];
};

// Blocks that are to be drawn, in order: of several triangles, so that no loop ends at a triangle's end,
// which processors guess badly for small ones.
struct BlockList {
  // Drawn when it has so many: what they show is known to the triangles after them. Of B's at 1920 x 1080,
  // 512 is 4 % faster than 128: least depths are loaded again later after they were stored one by one.
  static constexpr std::size_t kLong = 512;
  static constexpr std::size_t kRoom = kLong + 2 * kPatchBlocks;
  // These are drawn together, and their least 1/U found.
  static constexpr std::size_t kDrawnAtOnce = 4;
  // From the lowest bit: 8 of the block in the tile, 4 of its column and 4 of its row from the triangle's
  // first block, then the triangle in the batch.
  alignas(64) std::int32_t entry[kRoom];
  // At the blocks' first pixels: found for all entries at once, not moved to the front patch by patch.
  alignas(64) std::int32_t edge[3][kRoom];
  alignas(64) float inverse_u[kRoom];
  std::size_t count;
};
static_assert(BlockList::kRoom % 16 == 0);
static_assert(kSetUpBatch == 16 && kBlocksAcross == 16);
// An edge function that no step inside a block brings back.
inline constexpr std::int32_t kFarOutside = -static_cast<std::int32_t>(kSaturation);

// Negative for those blocks of a patch that lie right of or below the one a row of this is for: compared and
// combined for each patch they took longer than one load.
alignas(64) inline constexpr auto kBeside = [] {
  std::array<std::array<std::int32_t, kPatchBlocks>, kPatchBlocks> beside{};
  for (std::size_t n = 0; n < kPatchBlocks; ++n) {
    for (std::size_t k = 0; k < kPatchBlocks; ++k)
      beside[n][k] = kLaneJ[k] > kLaneJ[n] || kLaneI[k] > kLaneI[n] ? -1 : 0;
  }
  return beside;
}();

// Of a patch's blocks, from the entry of its first.
alignas(64) inline constexpr auto kNeighbourEntry = [] {
  std::array<std::int32_t, kPatchBlocks> entry{};
  for (std::size_t n = 0; n < kPatchBlocks; ++n)
    entry[n] = kNeighbour[n] + (kLaneJ[n] << 8) + (kLaneI[n] << 12);
  return entry;
}();

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

// Adds `bits` to `all` where a mask says so.
template <class Mask>
HWY_INLINE Ints withBits(Ints all, Mask where, Ints bits) {
  if constexpr (kLanes == 16) {
    return hn::IfThenElse(where, hn::Or(all, bits), all);
  } else {
    return hn::Or(all, hn::IfThenElseZero(where, bits));
  }
}

// One more where a mask says so.
template <class Mask>
HWY_INLINE Ints withOneMore(Ints all, Mask where) {
  if constexpr (kLanes == 16) {
    return hn::IfThenElse(where, hn::Add(all, hn::Set(kInt, 1)), all);
  } else {
    return hn::Sub(all, hn::VecFromMask(kInt, where));
  }
}

// Four floats that are read together; one of them for all lanes.
class FourFloats {
 public:
  explicit HWY_INLINE FourFloats(const float* four) : four_(four) {
    if constexpr (kLanes > 1) loaded_ = hn::LoadDup128(kFloat, four);
  }
  template <int kWhich>
  HWY_INLINE Floats get() const {
    if constexpr (kLanes == 1) {
      return hn::Set(kFloat, four_[kWhich]);
    } else {
      return hn::Broadcast<kWhich>(loaded_);
    }
  }

 private:
  const float* four_;
  Floats loaded_{};
};

// Of a table of sixteen.
template <class D>
HWY_INLINE hn::Vec<D> lookUp(D d, const hn::TFromD<D>* table, Ints index) {
  if constexpr (hn::MaxLanes(D()) == 16) {
    return hn::TableLookupLanes(hn::Load(d, table), hn::IndicesFromVec(d, index));
  } else {
    return hn::GatherIndex(d, table, index);
  }
}

class TileRasterizer {
 public:
  TileRasterizer(const Tile& tile, TileBuffer& buffer, TileCounts& counts)
      : tile_(tile),
        set_up_(tile),
        buffer_(buffer),
        counts_(counts),
        columns_(std::min(kTileSide, tile.width - tile.j * kTileSide)),
        rows_(std::min(kTileSide, tile.height - tile.i * kTileSide)) {}

  void run(std::span<const RasterTriangle* const> triangles, std::size_t first,
           std::span<std::uint8_t> crossing) {
    if (columns_ % kBlockSide == 0 && rows_ % kBlockSide == 0) {
      runBatches<false>(triangles, first, crossing);
    } else {
      runBatches<true>(triangles, first, crossing);
    }
  }

 private:
  // Of TileBuffer, by pixel, and the least by block.
  struct Buffers {
    float* inverse_u;
    std::uint32_t* owner;
    float* least;
  };
  // What became of a batch, for each lane of its blocks: a bit for each triangle that covers a sample there
  // and for each that was seen there; how many samples there were tested and written.
  struct Outcome {
    Ints covers, seen;
    Ints tested, written;
  };
  // Of up to 32 triangles, a bit each: those that cover a sample, those that were found hidden somewhere.
  struct Fates {
    std::uint32_t asked, covers, hidden;
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
      settle(
          {dropped.hidden | dropped.beside, 0, dropped.hidden}, dropped.crossing,
          [&](std::size_t t) { return triangles[first + t]->crossing; }, crossing);
      if (placed.count < kSetUpBatch) continue;
      drawBatch<kCut>(placed, kSetUpBatch, crossing);
      dropFirst(placed);
    }
    if (placed.count > 0) drawBatch<kCut>(placed, placed.count, crossing);
  }

  // Moves those behind the first kSetUpBatch, which are fewer than that, to the front.
  static HWY_INLINE void dropFirst(PlacedTriangles& placed) {
    placed.count -= kSetUpBatch;
    if (placed.count == 0) return;
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
    move(placed.crossing);
  }

  template <bool kCut>
  HWY_INLINE void drawBatch(const PlacedTriangles& placed, std::size_t count,
                            std::span<std::uint8_t> crossing) {
    SetUpTriangles batch;
    set_up_.setUp(placed, batch);
    PixelSteps steps[kSetUpBatch];
    BlockList list;
    list.count = 0;
    Outcome outcome{hn::Zero(kInt), hn::Zero(kInt), hn::Zero(kInt), hn::Zero(kInt)};
    std::uint32_t hidden = 0;
    for (std::size_t t = 0; t < count; ++t) {
      const std::uint32_t blocks = batch.blocks[t];
      const auto first_j = static_cast<std::int32_t>(blocks & 0xFF),
                 first_i = static_cast<std::int32_t>(blocks >> 8 & 0xFF);
      const auto columns = static_cast<std::int32_t>(blocks >> 16 & 0xFF) - first_j + 1,
                 rows = static_cast<std::int32_t>(blocks >> 24) - first_i + 1;
      setSteps(batch, t, steps[t]);
      const std::int32_t first_block = first_i * kBlocksAcross + first_j;
      bool behind = false;
      if (columns > kPatchSide || rows > kPatchSide) {
        behind = listPatches<kCut>(batch, t, steps, first_block, columns, rows, list, outcome);
      } else {
        Patch patch;
        setPatch(batch, t, steps[t], patch);
        behind = listPatch(batch, t, patch, first_block, 0, 0, columns, rows, list);
        if (list.count >= BlockList::kLong) drawList<kCut>(batch, steps, list, outcome);
      }
      hidden |= (behind ? 1U : 0U) << t;
    }
    drawList<kCut>(batch, steps, list, outcome);
    const std::uint32_t covers = orOfLanes(kUnsigned, hn::BitCast(kUnsigned, outcome.covers)),
                        seen = orOfLanes(kUnsigned, hn::BitCast(kUnsigned, outcome.seen));
    std::uint32_t crosses = 0;
    for (std::size_t t = 0; t < kSetUpBatch; t += kLanes)
      crosses |= laneBits(hn::Ne(hn::Load(kUnsigned, placed.crossing + t), hn::Zero(kUnsigned))) << t;
    crosses &= (1U << count) - 1;
    for (std::size_t t = 0; t < count; ++t) {
      buffer_.wrote[batch.number[t]] = static_cast<std::uint8_t>(seen >> t & 1);
    }
    counts_.tested += static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(kInt, outcome.tested)));
    counts_.written += static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(kInt, outcome.written)));
    settle(
        {(1U << count) - 1, covers, hidden}, crosses, [&](std::size_t t) { return placed.crossing[t]; },
        crossing);
  }

  // Counts triangles of this tile alone all at once, for their fates follow each other at random; what
  // becomes of the others is noted. `crosses`: a bit for each of these; number(t): RasterTriangle::crossing.
  template <class Number>
  HWY_INLINE void settle(const Fates& fates, std::uint32_t crosses, Number number,
                         std::span<std::uint8_t> crossing) {
    const std::uint32_t drawn = fates.covers | fates.hidden, here = fates.asked & ~crosses;
    const auto count = [](std::uint32_t bits) { return static_cast<std::uint64_t>(std::popcount(bits)); };
    counts_.drawn += count(here & drawn);
    counts_.hidden += count(here & fates.hidden & ~fates.covers);
    counts_.no_sample += count(here & ~drawn);
    for (std::uint32_t left = fates.asked & crosses & drawn; left != 0; left &= left - 1) {
      const auto t = static_cast<std::size_t>(std::countr_zero(left));
      crossing[number(t)] |= static_cast<std::uint8_t>((fates.covers >> t & 1) * kCrossingCovers +
                                                       (fates.hidden >> t & 1) * kCrossingHidden);
    }
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
    steps.shared[0] = batch.least[t];
    steps.shared[1] = batch.greatest[t];
    steps.shared[2] = std::bit_cast<float>(batch.number[t]);
    steps.shared[3] = std::bit_cast<float>(1U << t);
  }

  // Of the sixteen blocks of a patch, block by block.
  struct Patch {
    Ints greatest[3][kVectors];  // of the edge functions in the block
  };

  HWY_INLINE void setPatch(const SetUpTriangles& batch, std::size_t t, const PixelSteps& steps,
                           Patch& patch) const {
    const bool moved = tile_.offsets != nullptr;
    for (std::size_t v = 0; v < kVectors; ++v) {
      // A step of a block is four of a pixel's centre.
      for (std::size_t k = 0; k < 3; ++k) {
        const Ints of_pixel =
            moved ? edgeSteps(batch, t, k, v * kLanes) : hn::Load(kInt, steps.edge[k] + v * kLanes);
        patch.greatest[k][v] =
            hn::Add(hn::Set(kInt, batch.greatest_in_first_block[k][t]), hn::ShiftLeft<2>(of_pixel));
      }
    }
  }

  // Of a triangle that touches several patches; edge functions go from each to the next by addition.
  template <bool kCut>
  HWY_NOINLINE bool listPatches(const SetUpTriangles& batch, std::size_t t, const PixelSteps* steps,
                                std::int32_t first_block, std::int32_t columns, std::int32_t rows,
                                BlockList& list, Outcome& outcome) {
    Patch row;
    setPatch(batch, t, steps[t], row);
    bool hidden = false;
    static_assert(kBlockSide * kPatchSide == 1 << 4);
    Ints along[3], down[3];  // to the next patch
    for (std::size_t k = 0; k < 3; ++k) {
      along[k] = hn::ShiftLeft<4>(hn::Set(kInt, batch.per_j[k][t]));
      down[k] = hn::ShiftLeft<4>(hn::Set(kInt, batch.per_i[k][t]));
    }
    for (std::int32_t i = 0; i < rows; i += kPatchSide) {
      Patch patch = row;
      for (std::int32_t j = 0; j < columns; j += kPatchSide) {
        if (list.count >= BlockList::kLong) drawList<kCut>(batch, steps, list, outcome);
        hidden |= listPatch(batch, t, patch, first_block, j, i, columns, rows, list);
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t v = 0; v < kVectors; ++v)
            patch.greatest[k][v] = hn::Add(patch.greatest[k][v], along[k]);
        }
      }
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t v = 0; v < kVectors; ++v) row.greatest[k][v] = hn::Add(row.greatest[k][v], down[k]);
      }
    }
    return hidden;
  }

  // Appends those blocks of a patch that the triangle may show in. True if some were left out because it lies
  // behind what they show. The triangle's box begins at `first_block` and has `columns` and `rows`; the patch
  // begins `j` and `i` blocks from there.
  HWY_INLINE bool listPatch(const SetUpTriangles& batch, std::size_t t, const Patch& patch,
                            std::int32_t first_block, std::int32_t j, std::int32_t i, std::int32_t columns,
                            std::int32_t rows, BlockList& list) const {
    const std::int32_t first_of_patch = first_block + i * kBlocksAcross + j;
    const Ints first_entry =
        hn::Set(kInt, first_of_patch + (j << 8) + (i << 12) + (static_cast<std::int32_t>(t) << 16));
    const auto last_j = static_cast<std::size_t>(std::min(columns - j, kPatchSide)) - 1,
               last_i = static_cast<std::size_t>(std::min(rows - i, kPatchSide)) - 1;
    const std::int32_t* const beside = kBeside[last_i * kPatchSide + last_j].data();
    const float* const least = buffer_.least.data() + first_of_patch;
    auto hidden = hn::FirstN(kInt, 0);
    std::size_t count = list.count;
    for (std::size_t n = 0; n < kVectors; ++n) {
      const std::size_t v = n * kLanes;
      const Ints signs =
          hn::Or(hn::Or(hn::Or(patch.greatest[0][n], patch.greatest[1][n]), patch.greatest[2][n]),
                 hn::Load(kInt, beside + v));
      const auto touched = hn::Gt(signs, hn::Set(kInt, -1));
      const Floats there = everyFourth(
          kFloat, [&](std::size_t lane) { return least + kNeighbour[v + lane]; }, 0);
      const auto nearer = hn::RebindMask(kInt, hn::Gt(hn::Set(kFloat, batch.greatest[t]), there));
      hidden = hn::Or(hidden, hn::AndNot(nearer, touched));
      count += storeCompacted(hn::And(touched, nearer),
                              hn::Add(first_entry, hn::Load(kInt, kNeighbourEntry.data() + v)),
                              list.entry + count);
    }
    list.count = count;
    return !hn::AllFalse(kInt, hidden);
  }

  // Where the listed blocks begin.
  static HWY_INLINE void locate(const SetUpTriangles& batch, BlockList& list) {
    // What is drawn together with the last ones, and the rest of a vector.
    for (std::size_t v = 0; v < kBlockPixels; v += kLanes)
      hn::StoreU(hn::Zero(kInt), kInt, list.entry + list.count + v);
    const std::size_t end =
        (list.count + BlockList::kDrawnAtOnce - 1) / BlockList::kDrawnAtOnce * BlockList::kDrawnAtOnce;
    for (std::size_t n = 0; n < end; n += kLanes) {
      const Ints entry = hn::Load(kInt, list.entry + n);
      const Ints t = hn::ShiftRight<16>(entry);
      // Four pixels a block.
      const Ints j = hn::And(hn::ShiftRight<6>(entry), hn::Set(kInt, 15 * kBlockSide)),
                 i = hn::And(hn::ShiftRight<10>(entry), hn::Set(kInt, 15 * kBlockSide));
      for (std::size_t k = 0; k < 3; ++k) {
        const Ints steps =
            hn::Add(hn::Mul(lookUp(kInt, batch.per_j[k], t), j), hn::Mul(lookUp(kInt, batch.per_i[k], t), i));
        hn::Store(hn::Add(lookUp(kInt, batch.at_first_block[k], t), steps), kInt, list.edge[k] + n);
      }
      const Floats steps = hn::Add(hn::Mul(lookUp(kFloat, batch.gradient_x, t), hn::ConvertTo(kFloat, j)),
                                   hn::Mul(lookUp(kFloat, batch.gradient_y, t), hn::ConvertTo(kFloat, i)));
      hn::Store(hn::Add(lookUp(kFloat, batch.at_first, t), steps), kFloat, list.inverse_u + n);
    }
  }

  template <bool kCut>
  HWY_INLINE void drawList(const SetUpTriangles& batch, const PixelSteps* steps, BlockList& list,
                           Outcome& outcome) const {
    // In registers, which members would not be.
    const Buffers buffers{buffer_.inverse_u.data(), buffer_.triangle.data(), buffer_.least.data()};
    locate(batch, list);
    // Behind the last of them are entries that cover nothing.
    for (std::size_t n = 0; n < BlockList::kDrawnAtOnce; ++n) list.edge[0][list.count + n] = kFarOutside;
    Outcome now = outcome;
    for (std::size_t n = 0; n < list.count; n += BlockList::kDrawnAtOnce) {
      Floats furthest[BlockList::kDrawnAtOnce];
      for (std::size_t k = 0; k < BlockList::kDrawnAtOnce; ++k)
        furthest[k] = drawBlock<kCut>(buffers, steps, list, n + k, now);
      float least[BlockList::kDrawnAtOnce];
      leastOfFour(kFloat, furthest, least);
      for (std::size_t k = 0; k < BlockList::kDrawnAtOnce; ++k)
        buffers.least[list.entry[n + k] & 0xFF] = least[k];
    }
    outcome = now;
    list.count = 0;
  }

  // The block of entry `n`: the least of its 1/U afterwards, in each lane.
  template <bool kCut>
  HWY_INLINE Floats drawBlock(const Buffers& buffers, const PixelSteps* all_steps, const BlockList& list,
                              std::size_t n, Outcome& outcome) const {
    const auto t = static_cast<std::size_t>(list.entry[n] >> 16),
               block = static_cast<std::size_t>(list.entry[n] & 0xFF);
    const PixelSteps& steps = all_steps[t];
    float* const depth = buffers.inverse_u + block * kBlockPixels;
    std::uint32_t* const owner = buffers.owner + block * kBlockPixels;
    const Floats first = hn::Set(kFloat, list.inverse_u[n]);
    const FourFloats shared(steps.shared);
    const Floats least = shared.get<0>(), greatest = shared.get<1>();
    const auto number = hn::BitCast(kUnsigned, shared.get<2>());
    const Ints bit = hn::BitCast(kInt, shared.get<3>());
    Floats furthest = hn::Zero(kFloat);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto at = [&](std::size_t k) {
        return hn::Add(hn::Set(kInt, list.edge[k][n]), hn::Load(kInt, steps.edge[k] + v * kLanes));
      };
      auto covered = hn::Gt(hn::Or(hn::Or(at(0), at(1)), at(2)), hn::Set(kInt, -1));
      if constexpr (kCut) {
        const auto block_j = static_cast<std::int32_t>(block % kBlocksAcross),
                   block_i = static_cast<std::int32_t>(block / kBlocksAcross);
        covered = hn::And(
            covered,
            hn::And(
                hn::Lt(hn::Load(kInt, kLaneJ + v * kLanes), hn::Set(kInt, columns_ - block_j * kBlockSide)),
                hn::Lt(hn::Load(kInt, kLaneI + v * kLanes), hn::Set(kInt, rows_ - block_i * kBlockSide))));
      }
      const Floats old = hn::Load(kFloat, depth + v * kLanes);
      // Zero is never nearer than what is there.
      const Floats value = hn::IfThenElseZero(
          hn::RebindMask(kFloat, covered),
          hn::Min(hn::Max(hn::Add(first, hn::Load(kFloat, steps.inverse_u + v * kLanes)), least), greatest));
      const auto pass = hn::RebindMask(kInt, hn::Gt(value, old));
      const Floats now = hn::Max(value, old);
      hn::Store(now, kFloat, depth + v * kLanes);
      furthest = v == 0 ? now : hn::Min(furthest, now);
      const auto owners =
          hn::IfThenElse(hn::RebindMask(kUnsigned, pass), number, hn::Load(kUnsigned, owner + v * kLanes));
      hn::Store(owners, kUnsigned, owner + v * kLanes);
      outcome.covers = withBits(outcome.covers, covered, bit);
      outcome.seen = withBits(outcome.seen, pass, bit);
      outcome.tested = withOneMore(outcome.tested, covered);
      outcome.written = withOneMore(outcome.written, pass);
    }
    return furthest;
  }

  const Tile& tile_;
  const TriangleSetUp set_up_;
  TileBuffer& buffer_;
  TileCounts& counts_;
  const int columns_, rows_;  // of the tile that lie in the picture
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
  triangle.fill(kNoTriangle);
  least.fill(0);
  wrote.clear();
}

void rasterizeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, std::size_t first,
                   std::span<std::uint8_t> crossing, TileBuffer& buffer, TileCounts& counts) {
  HWY_DYNAMIC_DISPATCH(rasterize)(tile, triangles, first, crossing, buffer, counts);
}

}  // namespace deltaz

#endif  // HWY_ONCE
