#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

constexpr int kCoordinateBits = kAddressBits / 2;
constexpr int kDepthShift = kColorBits, kColumnShift = kDepthShift + kDepthBits,
              kLineShift = kColumnShift + kCoordinateBits, kBackgroundShift = kLineShift + kCoordinateBits;

constexpr std::uint64_t mask(int bits) {
  return (std::uint64_t{1} << bits) - 1;
}

}  // namespace

std::uint64_t packPixel(const PixelPacket& pixel) {
  return std::uint64_t{pixel.color} | (pixel.depth & mask(kDepthBits)) << kDepthShift |
         (pixel.j & mask(kCoordinateBits)) << kColumnShift | (pixel.i & mask(kCoordinateBits)) << kLineShift |
         std::uint64_t{pixel.background} << kBackgroundShift;
}

PixelPacket unpackPixel(std::uint64_t bits) {
  return {.i = static_cast<std::uint16_t>(bits >> kLineShift & mask(kCoordinateBits)),
          .j = static_cast<std::uint16_t>(bits >> kColumnShift & mask(kCoordinateBits)),
          .color = static_cast<std::uint8_t>(bits & mask(kColorBits)),
          .background = (bits >> kBackgroundShift & 1) != 0,
          .depth = static_cast<std::uint32_t>(bits >> kDepthShift & mask(kDepthBits))};
}

}  // namespace deltaz::ars
