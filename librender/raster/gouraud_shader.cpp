#include "librender/raster/gouraud_shader.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/gouraud_shader.cpp"
#include <algorithm>
#include <bit>
#include <cstring>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_GOURAUD_SHADER_ONCE
#define DELTAZ_GOURAUD_SHADER_ONCE
namespace deltaz {

alignas(64) inline constexpr float kShadeLaneJ[kBlockPixels] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                                0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) inline constexpr float kShadeLaneI[kBlockPixels] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                                2, 2, 2, 2, 3, 3, 3, 3};

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
constexpr std::size_t kLanes = hn::MaxLanes(FloatTag());
constexpr std::size_t kVectors = kBlockPixels / kLanes;

// Products of coordinates are exact in double.
HWY_INLINE void setUp(const RasterTriangle& triangle, ShadingPlanes& planes) {
  const auto& [a, b, c] = triangle.vertex;
  const double bx = static_cast<double>(b.x) - static_cast<double>(a.x),
               by = static_cast<double>(b.y) - static_cast<double>(a.y);
  const double cx = static_cast<double>(c.x) - static_cast<double>(a.x),
               cy = static_cast<double>(c.y) - static_cast<double>(a.y);
  const double determinant = bx * cy - cx * by;
  const double inverse = determinant != 0 ? 1 / determinant : 0;
  const double b_scaled = static_cast<double>(b.inverse_u) * inverse,
               c_scaled = static_cast<double>(c.inverse_u) * inverse;
  const auto limited = [](double gradient) {
    constexpr double kSteepest = 1e15;  // products with distances stay finite
    return static_cast<float>(std::clamp(gradient, -kSteepest, kSteepest));
  };
  planes.anchor_x = a.x;
  planes.anchor_y = a.y;
  planes.second_x = limited(cy * b_scaled);
  planes.second_y = limited(-(cx * b_scaled));
  planes.third_x = limited(-(by * c_scaled));
  planes.third_y = limited(bx * c_scaled);
  for (int channel = 0; channel < 3; ++channel) {
    const auto value = [&](const RasterVertex& vertex) {
      return static_cast<float>(vertex.payload >> (8 * channel) & 0xFF);
    };
    planes.color[channel] = value(a);
    planes.to_second[channel] = value(b) - value(a);
    planes.to_third[channel] = value(c) - value(a);
  }
  planes.unused = 0;
}

HWY_INLINE Ints shade(const ShadingPlanes& p, Floats x, Floats y, Floats u) {
  const Floats dx = hn::Sub(x, hn::Set(kFloat, p.anchor_x)), dy = hn::Sub(y, hn::Set(kFloat, p.anchor_y));
  const auto weight = [&](float per_x, float per_y) {
    return hn::Mul(hn::Add(hn::Mul(hn::Set(kFloat, per_x), dx), hn::Mul(hn::Set(kFloat, per_y), dy)), u);
  };
  const Floats zero = hn::Zero(kFloat), one = hn::Set(kFloat, 1.0F);
  const Floats second = hn::Min(hn::Max(weight(p.second_x, p.second_y), zero), one);
  const Floats third = hn::Min(hn::Max(weight(p.third_x, p.third_y), zero), hn::Sub(one, second));
  const auto channel = [&](int c) {
    const Floats value =
        hn::Add(hn::Set(kFloat, p.color[c]), hn::Add(hn::Mul(hn::Set(kFloat, p.to_second[c]), second),
                                                     hn::Mul(hn::Set(kFloat, p.to_third[c]), third)));
    return hn::ConvertTo(kInt, hn::Add(value, hn::Set(kFloat, 0.5F)));
  };
  return hn::Or(hn::Or(channel(0), hn::ShiftLeft<8>(channel(1))),
                hn::Or(hn::ShiftLeft<16>(channel(2)), hn::Set(kInt, static_cast<std::int32_t>(0xFF000000U))));
}

HWY_INLINE std::uint32_t bits(hn::Mask<IntTag> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(kInt, mask, bytes);
  std::uint32_t result = 0;
  std::memcpy(&result, bytes, 4);
  return result;
}

// One row of pixels out of a row of blocks.
template <typename T>
HWY_INLINE void copyRow(const T* blocks, int columns, T* out) {
  const hn::CappedTag<T, kBlockSide> d;
  int j = 0;
  for (; j + kBlockSide <= columns; j += kBlockSide, blocks += kBlockPixels, out += kBlockSide) {
    for (std::size_t k = 0; k < kBlockSide; k += hn::MaxLanes(d))
      hn::StoreU(hn::Load(d, blocks + k), d, out + k);
  }
  for (int k = 0; j + k < columns; ++k) out[k] = blocks[k];
}

void shadeTile(const Tile& tile, std::span<const RasterTriangle* const> triangles, const TileBuffer& buffer,
               GouraudScratch& scratch, ColorFrame& frame) {
  scratch.slot.assign(triangles.size(), kNoTriangle);
  scratch.planes.clear();
  // Set-up is made when a triangle is first met.
  const auto slot_of = [&](std::int32_t triangle) {
    std::uint32_t& slot = scratch.slot[static_cast<std::size_t>(triangle)];
    if (slot == kNoTriangle) {
      slot = static_cast<std::uint32_t>(scratch.planes.size());
      setUp(*triangles[static_cast<std::size_t>(triangle)], scratch.planes.emplace_back());
    }
    return slot;
  };
  const auto planes_of = [&](std::int32_t triangle) -> const ShadingPlanes& {
    return scratch.planes[slot_of(triangle)];
  };

  const float origin_x = static_cast<float>(tile.j * kTileSide) - static_cast<float>(tile.width - 1) * 0.5F;
  const float origin_y = static_cast<float>(tile.i * kTileSide) - static_cast<float>(tile.height - 1) * 0.5F;
  const int columns = std::min(kTileSide, tile.width - tile.j * kTileSide);
  const int rows = std::min(kTileSide, tile.height - tile.i * kTileSide);
  // A row of blocks, coloured block by block, leaves as four rows of pixels.
  alignas(64) std::int32_t color[kBlocksAcross * kBlockPixels];
  for (int block_i = 0; block_i * kBlockSide < rows; ++block_i) {
    const Floats block_y = hn::Set(kFloat, origin_y + static_cast<float>(block_i * kBlockSide));
    const auto first_of_row = static_cast<std::size_t>(block_i) * kBlocksAcross * kBlockPixels;
    const float* const depth = buffer.inverse_u.data() + first_of_row;
    const auto* const owner = reinterpret_cast<const std::int32_t*>(buffer.triangle.data()) + first_of_row;
    for (std::size_t block = 0; block < kBlocksAcross; ++block) {
      const Floats block_x = hn::Set(kFloat, origin_x + static_cast<float>(block * kBlockSide));
      const std::uint32_t whole = buffer.whole[static_cast<std::size_t>(block_i) * kBlocksAcross + block];
      const ShadingPlanes* const of_whole =
          whole == kNoTriangle ? nullptr : &planes_of(static_cast<std::int32_t>(whole));
      for (std::size_t v = 0; v < kBlockPixels; v += kLanes) {
        const std::size_t n = block * kBlockPixels + v;
        const Floats inverse_u = hn::Load(kFloat, depth + n);
        const Floats x = hn::Add(block_x, hn::Load(kFloat, kShadeLaneJ + v));
        const Floats y = hn::Add(block_y, hn::Load(kFloat, kShadeLaneI + v));
        const Floats u = hn::Div(hn::Set(kFloat, 1.0F), inverse_u);
        if (of_whole != nullptr) {
          hn::Store(shade(*of_whole, x, y, u), kInt, color + n);
          continue;
        }
        Ints result = hn::Set(kInt, static_cast<std::int32_t>(frame.background));
        const Ints owners = hn::Load(kInt, owner + n);
        auto left = hn::RebindMask(kInt, hn::Gt(inverse_u, hn::Zero(kFloat)));
        while (!hn::AllFalse(kInt, left)) {
          // The first and the last: most blocks show two.
          const std::uint32_t lanes = bits(left);
          const std::int32_t first = owner[n + static_cast<std::size_t>(std::countr_zero(lanes))];
          const std::int32_t last = owner[n + static_cast<std::size_t>(std::bit_width(lanes)) - 1];
          const auto of_first = hn::And(left, hn::Eq(owners, hn::Set(kInt, first)));
          const auto of_last = hn::And(left, hn::Eq(owners, hn::Set(kInt, last)));
          const std::uint32_t first_slot = slot_of(first), last_slot = slot_of(last);
          result = hn::IfThenElse(of_first, shade(scratch.planes[first_slot], x, y, u), result);
          result = hn::IfThenElse(of_last, shade(scratch.planes[last_slot], x, y, u), result);
          left = hn::AndNot(hn::Or(of_first, of_last), left);
        }
        hn::Store(result, kInt, color + n);
      }
    }
    const int height = std::min(kBlockSide, rows - block_i * kBlockSide);
    for (int i = 0; i < height; ++i) {
      const std::size_t pixel = static_cast<std::size_t>(tile.i * kTileSide + block_i * kBlockSide + i) *
                                    static_cast<std::size_t>(frame.width) +
                                static_cast<std::size_t>(tile.j * kTileSide);
      copyRow(reinterpret_cast<const std::uint32_t*>(color) + i * kBlockSide, columns, &frame.rgba[pixel]);
      copyRow(depth + i * kBlockSide, columns, &frame.inverse_u[pixel]);
    }
  }
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
