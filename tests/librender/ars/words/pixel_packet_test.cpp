#include "librender/ars/words/pixel_packet.h"

#include <gtest/gtest.h>

namespace deltaz::ars {
namespace {

// Report 4.3: 18 + 24 + 8 + 1 bits, 510 Mbit/s a tiler at ten million pixels a second.
TEST(PixelPacket, is_fifty_one_bits_wide) {
  EXPECT_EQ(kPixelPacketBits, 51);
  const PixelPacket all{.i = 511, .j = 511, .color = 255, .background = true, .depth = 0xFFFFFF};
  EXPECT_EQ(packPixel(all), (std::uint64_t{1} << kPixelPacketBits) - 1);
}

TEST(PixelPacket, comes_back_from_every_single_bit) {
  for (int bit = 0; bit < kPixelPacketBits; ++bit) {
    const std::uint64_t bits = std::uint64_t{1} << bit;
    EXPECT_EQ(packPixel(unpackPixel(bits)), bits) << "bit " << bit;
  }
}

TEST(PixelPacket, keeps_fields_apart) {
  EXPECT_EQ(unpackPixel(packPixel({.i = 511})), (PixelPacket{.i = 511}));
  EXPECT_EQ(unpackPixel(packPixel({.j = 511})), (PixelPacket{.j = 511}));
  EXPECT_EQ(unpackPixel(packPixel({.color = 255})), (PixelPacket{.color = 255}));
  EXPECT_EQ(unpackPixel(packPixel({.depth = 0xFFFFFF})), (PixelPacket{.depth = 0xFFFFFF}));
  EXPECT_EQ(unpackPixel(packPixel({.background = true})), (PixelPacket{.background = true}));
}

}  // namespace
}  // namespace deltaz::ars
