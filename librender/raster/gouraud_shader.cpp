#include "librender/raster/gouraud_shader.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/gouraud_shader.cpp"
#include <algorithm>
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

// Up to sixteen triangles at once, by their numbers; products of coordinates are exact in double.
HWY_INLINE void setUp(const RasterTriangle* const* triangles, const std::uint32_t* numbers, std::size_t count,
                      ShadingPlanes* planes) {
  alignas(64) float x[3][kShadeBatch], y[3][kShadeBatch], w[3][kShadeBatch], color[3][3][kShadeBatch];
  alignas(64) float gradient[4][kShadeBatch];
  for (std::size_t t = 0; t < kShadeBatch; t += kLanes) {
    for (std::size_t k = 0; k < 3; ++k) {
      Floats record[4];
      loadFours(
          kFloat, [&](std::size_t n) { return &triangles[numbers[std::min(t + n, count - 1)]]->vertex[k].x; },
          record);
      hn::Store(record[0], kFloat, x[k] + t);
      hn::Store(record[1], kFloat, y[k] + t);
      hn::Store(record[2], kFloat, w[k] + t);
      const Ints rgba = hn::BitCast(kInt, record[3]), byte = hn::Set(kInt, 0xFF);
      hn::Store(hn::ConvertTo(kFloat, hn::And(rgba, byte)), kFloat, color[k][0] + t);
      hn::Store(hn::ConvertTo(kFloat, hn::And(hn::ShiftRight<8>(rgba), byte)), kFloat, color[k][1] + t);
      hn::Store(hn::ConvertTo(kFloat, hn::And(hn::ShiftRight<16>(rgba), byte)), kFloat, color[k][2] + t);
    }
  }
  constexpr DoubleTag d;
  constexpr HalfFloatTag half_float;
  const auto zero = hn::Zero(d);
  for (std::size_t t = 0; t < kShadeBatch; t += hn::MaxLanes(DoubleTag())) {
    const auto at = [&](const float* p) { return hn::PromoteTo(d, hn::Load(half_float, p + t)); };
    const auto x0 = at(x[0]), y0 = at(y[0]);
    const auto bx = hn::Sub(at(x[1]), x0), by = hn::Sub(at(y[1]), y0);
    const auto cx = hn::Sub(at(x[2]), x0), cy = hn::Sub(at(y[2]), y0);
    const auto determinant = hn::Sub(hn::Mul(bx, cy), hn::Mul(cx, by));
    const auto inverse =
        hn::IfThenElse(hn::Eq(determinant, zero), zero, hn::Div(hn::Set(d, 1.0), determinant));
    const auto b_scaled = hn::Mul(at(w[1]), inverse), c_scaled = hn::Mul(at(w[2]), inverse);
    const auto store = [&](auto value, float* to) {
      const auto limited = hn::Min(hn::Max(value, hn::Set(d, -kSteepest)), hn::Set(d, kSteepest));
      hn::Store(hn::DemoteTo(half_float, limited), half_float, to + t);
    };
    store(hn::Mul(cy, b_scaled), gradient[0]);
    store(hn::Neg(hn::Mul(cx, b_scaled)), gradient[1]);
    store(hn::Neg(hn::Mul(by, c_scaled)), gradient[2]);
    store(hn::Mul(bx, c_scaled), gradient[3]);
  }
  for (std::size_t t = 0; t < kShadeBatch; t += kLanes) {
    const auto difference = [&](std::size_t k, std::size_t channel) {
      return hn::Sub(hn::Load(kFloat, color[k][channel] + t), hn::Load(kFloat, color[0][channel] + t));
    };
    // Four floats of each triangle at a time.
    alignas(64) float four[4][4 * kLanes];
    hn::StoreInterleaved4(hn::Load(kFloat, x[0] + t), hn::Load(kFloat, y[0] + t),
                          hn::Load(kFloat, gradient[0] + t), hn::Load(kFloat, gradient[1] + t), kFloat,
                          four[0]);
    hn::StoreInterleaved4(hn::Load(kFloat, gradient[2] + t), hn::Load(kFloat, gradient[3] + t),
                          hn::Load(kFloat, color[0][0] + t), hn::Load(kFloat, color[0][1] + t), kFloat,
                          four[1]);
    hn::StoreInterleaved4(hn::Load(kFloat, color[0][2] + t), difference(1, 0), difference(1, 1),
                          difference(1, 2), kFloat, four[2]);
    hn::StoreInterleaved4(difference(2, 0), difference(2, 1), difference(2, 2), hn::Zero(kFloat), kFloat,
                          four[3]);
    for (std::size_t n = 0; n < kLanes && t + n < count; ++n) {
      for (std::size_t part = 0; part < 4; ++part)
        std::memcpy(planes[numbers[t + n]].value + 4 * part, four[part] + 4 * n, 4 * sizeof(float));
    }
  }
}

// `plane`: ShadingPlanes::value of the lanes, by number.
template <class Plane>
HWY_INLINE Ints shade(Plane plane, Floats x, Floats y, Floats u) {
  const Floats dx = hn::Sub(x, plane(0)), dy = hn::Sub(y, plane(1));
  const auto weight = [&](std::size_t per_x, std::size_t per_y) {
    return hn::Mul(hn::Add(hn::Mul(plane(per_x), dx), hn::Mul(plane(per_y), dy)), u);
  };
  const Floats zero = hn::Zero(kFloat), one = hn::Set(kFloat, 1.0F);
  const Floats second = hn::Min(hn::Max(weight(2, 3), zero), one);
  const Floats third = hn::Min(hn::Max(weight(4, 5), zero), hn::Sub(one, second));
  // The last bits of a number with this added are its nearest integer.
  constexpr float kBias = 8388608.0F;
  const auto channel = [&](std::size_t c) {
    const Floats change = hn::Add(hn::Mul(plane(9 + c), second), hn::Mul(plane(12 + c), third));
    return hn::BitCast(kInt, hn::Add(hn::Add(plane(6 + c), change), hn::Set(kFloat, kBias)));
  };
  // What the bias leaves above the lowest byte is taken away from the sum.
  constexpr std::uint32_t kBiasBits = 0x4B000000;
  constexpr std::uint32_t kRest = 0xFF000000U - kBiasBits - (kBiasBits << 8) - (kBiasBits << 16);
  return hn::Add(hn::Add(channel(0), hn::ShiftLeft<8>(channel(1))),
                 hn::Add(hn::ShiftLeft<16>(channel(2)), hn::Set(kInt, static_cast<std::int32_t>(kRest))));
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

HWY_INLINE Ints shadeTwo(const ShadingPlanes* planes, std::uint32_t first, std::uint32_t second,
                         const Pixels& pixels, Ints background) {
  const auto is_second =
      hn::RebindMask(kFloat, hn::Eq(hn::Load(kUnsigned, pixels.owner), hn::Set(kUnsigned, second)));
  const float* const of_second = planes[second == kNoTriangle ? first : second].value;
  const float* const of_first = planes[first == kNoTriangle ? second : first].value;
  const Ints color = shade(
      [&](std::size_t k) {
        return hn::IfThenElse(is_second, hn::Set(kFloat, of_second[k]), hn::Set(kFloat, of_first[k]));
      },
      pixels.x, pixels.y, reciprocal(pixels.inverse_u));
  return withBackground(pixels, color, background);
}

// What each pixel needs is loaded from its own.
HWY_INLINE Ints shadeMore(const ShadingPlanes* planes, const Pixels& pixels, Ints background) {
  alignas(64) std::uint32_t number[kLanes];
  const auto owner = hn::Load(kUnsigned, pixels.owner);
  hn::Store(hn::IfThenZeroElse(hn::Eq(owner, hn::Set(kUnsigned, kNoTriangle)), owner), kUnsigned, number);
  Floats values[4][4];
  for (std::size_t part = 0; part < 4; ++part)
    loadFours(
        kFloat, [&](std::size_t n) { return planes[number[n]].value + 4 * part; }, values[part]);
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

void shadeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, const TileBuffer& buffer,
               GouraudScratch& scratch, ColorFrame& frame) {
  // Of those that were seen for a while.
  scratch.planes.resize(std::max(triangles.size(), kShadeBatch));
  alignas(64) std::uint32_t numbers[kShadeBatch];
  std::size_t count = 0;
  const auto flush = [&] {
    if (count > 0) setUp(triangles.data(), numbers, count, scratch.planes.data());
    count = 0;
  };
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    numbers[count] = static_cast<std::uint32_t>(n);
    count += buffer.wrote[n];
    if (count == kShadeBatch) flush();
  }
  flush();
  const ShadingPlanes* const planes = scratch.planes.data();
  const Ints background = hn::Set(kInt, static_cast<std::int32_t>(frame.background));

  const float origin_x = static_cast<float>(tile.j * kTileSide) - static_cast<float>(tile.width - 1) * 0.5F;
  const float origin_y = static_cast<float>(tile.i * kTileSide) - static_cast<float>(tile.height - 1) * 0.5F;
  const int columns = std::min(kTileSide, tile.width - tile.j * kTileSide);
  const int rows = std::min(kTileSide, tile.height - tile.i * kTileSide);
  const bool lines =
      columns == kTileSide && static_cast<std::size_t>(frame.width) % (kCacheLine / sizeof(float)) == 0;
  // A row of blocks, coloured block by block, leaves as four rows of pixels.
  alignas(64) std::uint32_t color[kBlocksAcross * kBlockPixels];
  for (int block_i = 0; block_i * kBlockSide < rows; ++block_i) {
    const Floats block_y = hn::Set(kFloat, origin_y + static_cast<float>(block_i * kBlockSide));
    const auto first_of_row = static_cast<std::size_t>(block_i) * kBlocksAcross * kBlockPixels;
    const float* const depth = buffer.inverse_u.data() + first_of_row;
    const std::uint32_t* const owner = buffer.triangle.data() + first_of_row;
    for (std::size_t block = 0; block < kBlocksAcross; ++block) {
      const Floats block_x = hn::Set(kFloat, origin_x + static_cast<float>(block * kBlockSide));
      const auto colorBlock = [&](auto colors) {
        for (std::size_t v = 0; v < kBlockPixels; v += kLanes) {
          const std::size_t n = block * kBlockPixels + v;
          const Pixels pixels{hn::Add(block_x, hn::Load(kFloat, kLaneX + v)),
                              hn::Add(block_y, hn::Load(kFloat, kLaneY + v)), hn::Load(kFloat, depth + n),
                              owner + n};
          hn::Store(hn::BitCast(kUnsigned, colors(pixels)), kUnsigned, color + n);
        }
      };
      const std::uint32_t* const of_block = owner + block * kBlockPixels;
      const std::uint32_t first = of_block[0], not_first = notOwnedBy(first, of_block);
      if (not_first == 0) {
        if (first == kNoTriangle) {
          colorBlock([&](const Pixels&) { return background; });
        } else {
          colorBlock([&](const Pixels& pixels) { return shadeOne(planes[first], pixels); });
        }
        continue;
      }
      const std::uint32_t second = of_block[std::countr_zero(not_first)];
      if ((not_first & notOwnedBy(second, of_block)) == 0) {
        colorBlock([&](const Pixels& pixels) { return shadeTwo(planes, first, second, pixels, background); });
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
  }
  if (lines) hwy::FlushStream();
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

void shadeTileGouraud(const Tile& tile, std::span<const RasterTriangle* const> triangles,
                      const TileBuffer& buffer, GouraudScratch& scratch, ColorFrame& frame) {
  HWY_DYNAMIC_DISPATCH(shadeTile)(tile, triangles, buffer, scratch, frame);
}

}  // namespace deltaz

#endif  // HWY_ONCE
