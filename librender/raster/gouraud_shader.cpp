#include "librender/raster/gouraud_shader.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/gouraud_shader.cpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "librender/raster/block_lanes.h"
#include "librender/raster/lane_bits-inl.h"
#include "librender/raster/load_fours-inl.h"

#ifndef DELTAZ_GOURAUD_SHADER_ONCE
#define DELTAZ_GOURAUD_SHADER_ONCE
namespace deltaz {

// Triangles that are set up together.
inline constexpr std::size_t kShadeBatch = 16;
// Planes of slivers that are lines but for rounding are limited by the reciprocal of twice their area, per
// square pixel, so that they stay finite.
inline constexpr double kGreatestInverseArea = 1e12;
// Where the blocks of a row begin, in pixels of the tile.
alignas(64) inline constexpr auto kBlockX = [] {
  std::array<float, kBlocksAcross> x{};
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = static_cast<float>(n * kBlockSide);
  return x;
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
constexpr std::size_t kVectors = kBlockPixels / kLanes;

using DoubleTag = hn::CappedTag<double, 8>;
using HalfFloatTag = hn::Rebind<float, DoubleTag>;

// The four bytes of each lane on their own. `two`: of two vectors, the lesser or the greater of each pair.
template <class D, class Two>
HWY_INLINE hn::Vec<D> bytewise(D d, hn::Vec<D> a, hn::Vec<D> b, Two two) {
  if constexpr (hn::MaxLanes(D()) == 1) {
    auto result = hn::Zero(d);
    for (int shift = 0; shift < 32; shift += 8) {
      const auto byte = [&](auto v) { return hn::And(hn::ShiftRightSame(v, shift), hn::Set(d, 0xFF)); };
      result = hn::Or(result, hn::ShiftLeftSame(two(byte(a), byte(b)), shift));
    }
    return result;
  } else {
    const hn::Repartition<std::uint8_t, D> bytes;
    return hn::BitCast(d, two(hn::BitCast(bytes, a), hn::BitCast(bytes, b)));
  }
}

HWY_INLINE Ints leastBytes(Ints a, Ints b) {
  return bytewise(kInt, a, b, [](auto x, auto y) { return hn::Min(x, y); });
}

HWY_INLINE Ints greatestBytes(Ints a, Ints b) {
  return bytewise(kInt, a, b, [](auto x, auto y) { return hn::Max(x, y); });
}

// Up to sixteen triangles at once, by their numbers; products of coordinates are exact in double. `origin_x`,
// `origin_y`: the tile's first pixel. Kept out of the loop over pixels, which wants all registers.
HWY_NOINLINE void setUp(const RasterTriangle* const* triangles, const std::uint32_t* numbers,
                        std::size_t count, float origin_x, float origin_y, ShadingPlanes* planes) {
  alignas(64) float x[3][kShadeBatch], y[3][kShadeBatch], w[3][kShadeBatch], color[3][3][kShadeBatch];
  alignas(64) std::int32_t rgba[3][kShadeBatch];
  alignas(64) float plane[9][kShadeBatch];
  for (std::size_t t = 0; t < kShadeBatch; t += kLanes) {
    for (std::size_t k = 0; k < 3; ++k) {
      Floats record[4];
      loadFours(
          kFloat, [&](std::size_t n) { return &triangles[numbers[std::min(t + n, count - 1)]]->vertex[k].x; },
          record);
      hn::Store(record[0], kFloat, x[k] + t);
      hn::Store(record[1], kFloat, y[k] + t);
      hn::Store(record[2], kFloat, w[k] + t);
      const Ints packed = hn::BitCast(kInt, record[3]), byte = hn::Set(kInt, 0xFF);
      hn::Store(packed, kInt, rgba[k] + t);
      hn::Store(hn::ConvertTo(kFloat, hn::And(packed, byte)), kFloat, color[k][0] + t);
      hn::Store(hn::ConvertTo(kFloat, hn::And(hn::ShiftRight<8>(packed), byte)), kFloat, color[k][1] + t);
      hn::Store(hn::ConvertTo(kFloat, hn::And(hn::ShiftRight<16>(packed), byte)), kFloat, color[k][2] + t);
    }
  }
  constexpr DoubleTag d;
  constexpr HalfFloatTag half_float;
  const auto zero = hn::Zero(d), limit = hn::Set(d, kGreatestInverseArea);
  for (std::size_t t = 0; t < kShadeBatch; t += hn::MaxLanes(DoubleTag())) {
    const auto at = [&](const float* p) { return hn::PromoteTo(d, hn::Load(half_float, p + t)); };
    const auto store = [&](auto value, float* to) {
      hn::Store(hn::DemoteTo(half_float, value), half_float, to + t);
    };
    const auto x0 = at(x[0]), y0 = at(y[0]), w0 = at(w[0]), w1 = at(w[1]), w2 = at(w[2]);
    const auto bx = hn::Sub(at(x[1]), x0), by = hn::Sub(at(y[1]), y0);
    const auto cx = hn::Sub(at(x[2]), x0), cy = hn::Sub(at(y[2]), y0);
    const auto determinant = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
    const auto inverse =
        hn::IfThenElse(hn::Eq(determinant, zero), zero, hn::Div(hn::Set(d, 1.0), determinant));
    const auto limited = hn::Min(hn::Max(inverse, hn::Neg(limit)), limit);
    // Gradients of the weights of the second and of the third vertex.
    const auto second_x = hn::Mul(cy, limited), second_y = hn::Neg(hn::Mul(cx, limited));
    const auto third_x = hn::Neg(hn::Mul(by, limited)), third_y = hn::Mul(bx, limited);
    const auto to_origin_x = hn::Sub(hn::Set(d, static_cast<double>(origin_x)), x0),
               to_origin_y = hn::Sub(hn::Set(d, static_cast<double>(origin_y)), y0);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto first = hn::Mul(at(color[0][c]), w0);
      const auto second = hn::Sub(hn::Mul(at(color[1][c]), w1), first),
                 third = hn::Sub(hn::Mul(at(color[2][c]), w2), first);
      const auto per_x = hn::Add(hn::Mul(second, second_x), hn::Mul(third, third_x)),
                 per_y = hn::Add(hn::Mul(second, second_y), hn::Mul(third, third_y));
      store(per_x, plane[3 * c]);
      store(per_y, plane[3 * c + 1]);
      store(hn::Add(first, hn::Add(hn::Mul(per_x, to_origin_x), hn::Mul(per_y, to_origin_y))),
            plane[3 * c + 2]);
    }
  }
  for (std::size_t t = 0; t < kShadeBatch; t += kLanes) {
    const auto of = [&](std::size_t n) { return hn::Load(kFloat, plane[n] + t); };
    const auto corner = [&](std::size_t k) { return hn::Load(kInt, rgba[k] + t); };
    const Ints opaque = hn::Set(kInt, static_cast<std::int32_t>(0xFF000000));
    const Ints least = hn::Or(opaque, leastBytes(leastBytes(corner(0), corner(1)), corner(2)));
    const Ints greatest = hn::Or(opaque, greatestBytes(greatestBytes(corner(0), corner(1)), corner(2)));
    // Four floats of each triangle at a time.
    alignas(64) float four[3][4 * kLanes];
    hn::StoreInterleaved4(of(0), of(1), of(2), of(3), kFloat, four[0]);
    hn::StoreInterleaved4(of(4), of(5), of(6), of(7), kFloat, four[1]);
    hn::StoreInterleaved4(of(8), hn::BitCast(kFloat, least), hn::BitCast(kFloat, greatest), hn::Zero(kFloat),
                          kFloat, four[2]);
    for (std::size_t n = 0; n < kLanes && t + n < count; ++n) {
      for (std::size_t part = 0; part < 3; ++part)
        std::memcpy(planes[numbers[t + n]].value + 4 * part, four[part] + 4 * n, 4 * sizeof(float));
    }
  }
}

// `plane`: ShadingPlanes::value of the lanes, by number.
template <class Plane>
HWY_INLINE Ints shade(Plane plane, Floats x, Floats y, Floats u) {
  // The last bits of a number with this added are its nearest integer.
  constexpr float kBias = 8388608.0F;
  const auto channel = [&](std::size_t c) {
    const Floats at =
        hn::Add(hn::Add(hn::Mul(plane(3 * c), x), hn::Mul(plane(3 * c + 1), y)), plane(3 * c + 2));
    const Floats kept = hn::Min(hn::Max(hn::Mul(at, u), hn::Zero(kFloat)), hn::Set(kFloat, 255.0F));
    return hn::BitCast(kInt, hn::Add(kept, hn::Set(kFloat, kBias)));
  };
  // What the bias leaves above the lowest byte is taken away from the sum.
  constexpr std::uint32_t kBiasBits = 0x4B000000;
  constexpr std::uint32_t kRest = 0xFF000000U - kBiasBits - (kBiasBits << 8) - (kBiasBits << 16);
  const Ints color =
      hn::Add(hn::Add(channel(0), hn::ShiftLeft<8>(channel(1))),
              hn::Add(hn::ShiftLeft<16>(channel(2)), hn::Set(kInt, static_cast<std::int32_t>(kRest))));
  return leastBytes(greatestBytes(color, hn::BitCast(kInt, plane(9))), hn::BitCast(kInt, plane(10)));
}

// Where pixels lie, and what is there.
struct Pixels {
  Floats x, y, inverse_u;
  const std::uint32_t* owner;
};

HWY_INLINE Floats reciprocal(Floats value) {
  return hn::Div(hn::Set(kFloat, 1.0F), value);
}

// Pixels without an owner show the background.
HWY_INLINE Ints withBackground(const Pixels& pixels, Ints color, Ints background) {
  return hn::IfThenElse(hn::RebindMask(kInt, hn::Gt(pixels.inverse_u, hn::Zero(kFloat))), color, background);
}

HWY_INLINE Ints shadeOne(const ShadingPlanes& planes, const Pixels& pixels) {
  return shade([&](std::size_t k) { return hn::Set(kFloat, planes.value[k]); }, pixels.x, pixels.y,
               reciprocal(pixels.inverse_u));
}

// Of an owner, kNoTriangle as well.
HWY_INLINE const float* planesOf(const ShadingPlanes* planes, std::uint32_t owner) {
  return planes[static_cast<std::int32_t>(owner)].value;
}

HWY_INLINE Ints shadeTwo(const ShadingPlanes* planes, std::uint32_t first, std::uint32_t second,
                         const Pixels& pixels, Ints background) {
  const auto is_second =
      hn::RebindMask(kFloat, hn::Eq(hn::Load(kUnsigned, pixels.owner), hn::Set(kUnsigned, second)));
  const float *const of_first = planesOf(planes, first), *const of_second = planesOf(planes, second);
  const Ints color = shade(
      [&](std::size_t k) {
        return hn::IfThenElse(is_second, hn::Set(kFloat, of_second[k]), hn::Set(kFloat, of_first[k]));
      },
      pixels.x, pixels.y, reciprocal(pixels.inverse_u));
  return withBackground(pixels, color, background);
}

// What each pixel needs is loaded from its own.
HWY_INLINE Ints shadeMore(const ShadingPlanes* planes, const Pixels& pixels, Ints background) {
  Floats values[3][4];
  for (std::size_t part = 0; part < 3; ++part)
    loadFours(
        kFloat, [&](std::size_t n) { return planesOf(planes, pixels.owner[n]) + 4 * part; }, values[part]);
  const Ints color = shade([&](std::size_t n) { return values[n / 4][n % 4]; }, pixels.x, pixels.y,
                           reciprocal(pixels.inverse_u));
  return withBackground(pixels, color, background);
}

// A bit for each pixel of a block that is not `known`'s.
HWY_INLINE std::uint32_t notOwnedBy(std::uint32_t known, const std::uint32_t* owner) {
  std::uint32_t others = 0;
  for (std::size_t v = 0; v < kBlockPixels; v += kLanes)
    others |= laneBits(hn::Ne(hn::Load(kUnsigned, owner + v), hn::Set(kUnsigned, known))) << v;
  return others;
}

// The triangle of a block's first pixel, and a bit for each pixel that is not its.
struct Owners {
  std::uint32_t first, others;
};
HWY_INLINE Owners ownersOf(const std::uint32_t* block) {
  return {.first = block[0], .others = notOwnedBy(block[0], block)};
}

// One row of pixels out of a row of blocks.
template <typename T>
HWY_INLINE void copyRow(const T* blocks, int columns, T* out) {
  for (; columns > 0; columns -= kBlockSide, blocks += kBlockPixels, out += kBlockSide)
    std::copy_n(blocks, std::min(columns, kBlockSide), out);
}

// A whole row of a tile, in whole cache lines. Pictures are larger than caches and nothing reads them soon,
// so that it goes past them.
template <typename T>
HWY_INLINE void streamRow(const T* blocks, T* out) {
  const hn::CappedTag<T, 16> d;
  constexpr std::size_t kAtOnce = hn::MaxLanes(d);
  for (std::size_t j = 0; j < kTileSide; j += kAtOnce) {
    const auto at = [&](std::size_t n) {
      return blocks + (j + n) / kBlockSide * kBlockPixels + (j + n) % kBlockSide;
    };
    hn::Stream(everyFourth(d, at, 0), d, out + j);
  }
}

// As TileBuffer::clear(), of a row of blocks.
HWY_INLINE void clearRow(int block_i, TileBuffer& buffer) {
  const std::size_t first_block = static_cast<std::size_t>(block_i) * kBlocksAcross;
  const auto zero = hn::Zero(kFloat);
  const auto nothing = hn::Set(kUnsigned, kNoTriangle);
  for (std::size_t n = 0; n < kBlocksAcross * kBlockPixels; n += kLanes) {
    hn::Store(zero, kFloat, buffer.inverse_u.data() + first_block * kBlockPixels + n);
    hn::Store(nothing, kUnsigned, buffer.triangle.data() + first_block * kBlockPixels + n);
  }
  for (std::size_t n = 0; n < kBlocksAcross; n += kLanes)
    hn::Store(zero, kFloat, buffer.least.data() + first_block + n);
}

void shadeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, TileBuffer& buffer,
               GouraudScratch& scratch, ColorFrame& frame) {
  const float origin_x = static_cast<float>(tile.j * kTileSide) - static_cast<float>(tile.width - 1) * 0.5F;
  const float origin_y = static_cast<float>(tile.i * kTileSide) - static_cast<float>(tile.height - 1) * 0.5F;
  // Of those that were seen for a while. kNoTriangle, as a signed number, is the one before the first.
  static_assert(static_cast<std::int32_t>(kNoTriangle) == -1);
  scratch.planes.resize(1 + std::max(triangles.size(), kShadeBatch));
  ShadingPlanes* const planes = scratch.planes.data() + 1;
  alignas(64) std::uint32_t numbers[kShadeBatch];
  std::size_t count = 0;
  const auto flush = [&] {
    if (count > 0) setUp(triangles.data(), numbers, count, origin_x, origin_y, planes);
    count = 0;
  };
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    numbers[count] = static_cast<std::uint32_t>(n);
    count += buffer.wrote[n];
    if (count == kShadeBatch) flush();
  }
  flush();
  const Ints background = hn::Set(kInt, static_cast<std::int32_t>(frame.background));

  const int columns = std::min(kTileSide, tile.width - tile.j * kTileSide);
  const int rows = std::min(kTileSide, tile.height - tile.i * kTileSide);
  const bool lines =
      columns == kTileSide && static_cast<std::size_t>(frame.width) % (kCacheLine / sizeof(float)) == 0;
  // A row of blocks, coloured block by block, leaves as four rows of pixels.
  alignas(64) std::uint32_t color[kBlocksAcross * kBlockPixels];
  for (int block_i = 0; block_i * kBlockSide < rows; ++block_i) {
    const Floats block_y = hn::Set(kFloat, static_cast<float>(block_i * kBlockSide));
    const auto first_of_row = static_cast<std::size_t>(block_i) * kBlocksAcross * kBlockPixels;
    float* const depth = buffer.inverse_u.data() + first_of_row;
    std::uint32_t* const owner = buffer.triangle.data() + first_of_row;
    // Which of the three ways a block takes is hard to guess: it is found out two blocks ahead, so that
    // a processor that guessed wrong knows before much was done in vain.
    Owners next = ownersOf(owner), after_next = ownersOf(owner + kBlockPixels);
    for (std::size_t block = 0; block < kBlocksAcross; ++block) {
      const Owners owners = next;
      next = after_next;
      after_next = ownersOf(owner + std::min<std::size_t>(block + 2, kBlocksAcross - 1) * kBlockPixels);
      const Floats block_x = hn::Set(kFloat, kBlockX[block]);
      const auto colorBlock = [&](auto colors) {
        for (std::size_t v = 0; v < kBlockPixels; v += kLanes) {
          const std::size_t n = block * kBlockPixels + v;
          const Pixels pixels{hn::Add(block_x, hn::Load(kFloat, kLaneX + v)),
                              hn::Add(block_y, hn::Load(kFloat, kLaneY + v)), hn::Load(kFloat, depth + n),
                              owner + n};
          hn::Store(hn::BitCast(kUnsigned, colors(pixels)), kUnsigned, color + n);
        }
      };
      if (owners.others == 0) {
        if (owners.first == kNoTriangle) {
          colorBlock([&](const Pixels&) { return background; });
        } else {
          colorBlock([&](const Pixels& pixels) { return shadeOne(planes[owners.first], pixels); });
        }
        continue;
      }
      const std::uint32_t* const of_block = owner + block * kBlockPixels;
      const std::uint32_t second = of_block[std::countr_zero(owners.others)];
      if ((owners.others & notOwnedBy(second, of_block)) == 0) {
        colorBlock(
            [&](const Pixels& pixels) { return shadeTwo(planes, owners.first, second, pixels, background); });
      } else {
        colorBlock([&](const Pixels& pixels) { return shadeMore(planes, pixels, background); });
      }
    }
    const int height = std::min(kBlockSide, rows - block_i * kBlockSide);
    for (int i = 0; i < height; ++i) {
      const std::size_t pixel = static_cast<std::size_t>(tile.i * kTileSide + block_i * kBlockSide + i) *
                                    static_cast<std::size_t>(frame.width) +
                                static_cast<std::size_t>(tile.j * kTileSide);
      if (lines) {
        streamRow(color + i * kBlockSide, &frame.rgba[pixel]);
        streamRow(depth + i * kBlockSide, &frame.inverse_u[pixel]);
      } else {
        copyRow(color + i * kBlockSide, columns, &frame.rgba[pixel]);
        copyRow(depth + i * kBlockSide, columns, &frame.inverse_u[pixel]);
      }
    }
    clearRow(block_i, buffer);
  }
  buffer.wrote.clear();
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace deltaz {
namespace {
HWY_EXPORT(shadeTile);
}

void ColorFrame::resize(int new_width, int new_height) {
  width = new_width;
  height = new_height;
  rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  inverse_u.resize(rgba.size());
}

void shadeTileGouraud(const Tile& tile, std::span<const RasterTriangle* const> triangles, TileBuffer& buffer,
                      GouraudScratch& scratch, ColorFrame& frame) {
  HWY_DYNAMIC_DISPATCH(shadeTile)(tile, triangles, buffer, scratch, frame);
}

}  // namespace deltaz

#endif  // HWY_ONCE
