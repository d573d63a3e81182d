// What travels from a tiler to a memory: 51 bits, 18 of address, 24 of depth, 8 of colour, 1 background flag
// (report 4.3). i counts lines from the top, j pixels from the left.
#pragma once

#include <cstdint>

namespace deltaz::ars {

inline constexpr int kScreenLines = 512, kScreenPixels = 512;  // of one picture, or of a part of a larger one
inline constexpr int kAddressBits = 18, kDepthBits = 24, kColorBits = 8;
inline constexpr int kPixelPacketBits = kAddressBits + kDepthBits + kColorBits + 1;

struct PixelPacket {
  std::uint16_t i = 0, j = 0;  // 0..511
  std::uint8_t color = 0;
  bool background = false;  // writes whatever the memory holds
  std::uint32_t depth = 0;  // 24 bits, 5 of exponent above 19 of mantissa; larger is nearer

  bool operator==(const PixelPacket&) const = default;
};

// The packet as it stands on the wires, from bit 0: colour, depth, j, i, background flag.
std::uint64_t packPixel(const PixelPacket& pixel);
PixelPacket unpackPixel(std::uint64_t bits);

}  // namespace deltaz::ars
