#include "librender/ars/words/triangle_words.h"

#include <gtest/gtest.h>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "tests/librender/ars/tiler/mixed_triangles.h"

namespace deltaz::ars {
namespace {

const NumberProfile kTable8;

TriangleVariables example() {
  return {.vertices = {{{.i = 64, .j = 128}, {.i = 96, .j = 640}, {.i = 320, .j = 192}}},
          .corner = Corner::kUpperLeft,
          .color = 100,
          .color_i = -0.5,
          .color_j = 0.25,
          .depth = 0.5,
          .depth_i = -0.125,
          .depth_j = 0.0625};
}

// Digest section 5, the table of Fig 51.
TEST(TriangleWords, fields_lie_where_figure_51_has_them) {
  TriangleVariables triangle = example();
  const TriangleWords words = encodeTriangleWords(triangle, kTable8);
  EXPECT_EQ(words[0], 64u << 16 | 128u);
  EXPECT_EQ(words[1], 96u << 16 | 640u);
  EXPECT_EQ(words[2], 320u << 16 | 192u);
  EXPECT_EQ(words[3], kColorFormat.encode(100));
  // Delta colour: j above i. Delta depth: i first.
  EXPECT_EQ(words[4], kColorFormat.encode(0.25) << 16 | kColorFormat.encode(-0.5));
  EXPECT_EQ(words[5], kDepthPlaneFormat.encode(0.5));
  EXPECT_EQ(words[6], kDepthPlaneFormat.encode(-0.125));
  EXPECT_EQ(words[7], kDepthPlaneFormat.encode(0.0625));

  triangle.background = true;
  EXPECT_EQ(encodeTriangleWords(triangle, kTable8)[3] ^ words[3], 1u << 16);
  triangle.background = false;
  triangle.oversample = true;
  EXPECT_EQ(encodeTriangleWords(triangle, kTable8)[3] ^ words[3], 1u << 17);
  triangle.oversample = false;
  triangle.corner = Corner::kLowerRight;
  EXPECT_EQ(encodeTriangleWords(triangle, kTable8)[3] ^ words[3], 3u << 18);
  triangle.vertices[0] = {.i = -32, .j = -1};
  EXPECT_EQ(encodeTriangleWords(triangle, kTable8)[0], 0xFFE0FFFFu);
}

TEST(TriangleWords, random_triangles_come_back) {
  RandomNumbers random(1);
  for (int n = 0; n < 20000; ++n) {
    const TriangleVariables triangle =
        encodeTriangle(mixedTriangle(random), kTable8, {.oversample = n % 2 == 0, .background = n % 3 == 0})
            .variables;
    const TriangleWords words = encodeTriangleWords(triangle, kTable8);
    ASSERT_EQ(decodeTriangleWords(words, kTable8), triangle);
    ASSERT_TRUE(checkTriangleWords(words, kTable8, "triangle").ok());
  }
}

// Any bits have a meaning, and saying it again does not change it.
TEST(TriangleWords, any_bits_have_variables_and_settle_in_canonical_words) {
  RandomNumbers random(2);
  int unchanged = 0;
  for (int n = 0; n < 20000; ++n) {
    TriangleWords words{};
    for (std::uint32_t& word : words) word = static_cast<std::uint32_t>(random.next());
    words[3] &= ~kUnstatedBits;
    // Normalised mantissas, as every encoder writes them.
    const bool normalised = n % 2 == 0;
    if (normalised) {
      words[3] |= 0x200;
      words[4] |= 0x0200'0200;
      for (std::size_t k = 5; k < 8; ++k) words[k] |= 0x80'0000;
      // The exponent 0 has two signs; plus is written.
      for (std::size_t k = 5; k < 8; ++k) words[k] |= 1u << 25;
      words[3] |= 1u << 11;
      words[4] |= 1u << 11 | 1u << 27;
    }
    const TriangleWords again = encodeTriangleWords(decodeTriangleWords(words, kTable8), kTable8);
    if (normalised) {
      ASSERT_EQ(again, words);
    }
    ASSERT_EQ(encodeTriangleWords(decodeTriangleWords(again, kTable8), kTable8), again);
    unchanged += again == words ? 1 : 0;
  }
  EXPECT_LT(unchanged, 15000);
}

TEST(TriangleWords, refuses_what_a_tiler_could_not_tile_and_says_why) {
  const auto refusal = [](const TriangleVariables& triangle, std::uint32_t more = 0) -> std::string {
    TriangleWords words = encodeTriangleWords(triangle, kTable8);
    words[3] |= more;
    const Status status = checkTriangleWords(words, kTable8, "triangle 7");
    return status.ok() ? "" : status.error().message();
  };
  TriangleVariables triangle = example();
  EXPECT_EQ(refusal(triangle), "");
  for (int bit = 20; bit < 32; ++bit)
    EXPECT_NE(refusal(triangle, 1u << bit).find("bits 20 to 31"), std::string::npos);
  EXPECT_EQ(refusal(triangle, 1u << 20).find("triangle 7"), 0u);
  triangle.corner = Corner::kLowerRight;
  EXPECT_NE(refusal(triangle).find("corner"), std::string::npos);
  triangle = example();
  std::swap(triangle.vertices[0], triangle.vertices[2]);
  EXPECT_NE(refusal(triangle).find("ordered"), std::string::npos);
  triangle = example();
  triangle.vertices[0] = {.i = -33, .j = 128};
  EXPECT_NE(refusal(triangle).find("beside the picture"), std::string::npos);
  triangle = example();
  triangle.vertices[1].j = 32736;
  EXPECT_NE(refusal(triangle).find("beside the picture"), std::string::npos);
  triangle.vertices[1].j = 32735;
  EXPECT_EQ(refusal(triangle), "");
}

}  // namespace
}  // namespace deltaz::ars
