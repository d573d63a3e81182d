// The valid set of both tilers against its definition, in digest section 6.2's words: visited-valid set ==
// brute force over the box.
#include <cstdlib>
#include <gtest/gtest.h>
#include <vector>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/tiling_cursor.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "tests/librender/ars/tiler/brute_force.h"
#include "tests/librender/ars/tiler/mixed_triangles.h"

namespace deltaz::ars {
namespace {

int triangleCount() {
  const char* const wanted = std::getenv("DELTAZ_SOAK_TRIANGLES");
  return wanted != nullptr ? std::atoi(wanted) : 50000;
}

std::vector<PixelPacket> scannedPixels(const TilerSetup& setup, const NumberProfile& numbers,
                                       TilingCounts& counts) {
  std::vector<PixelPacket> pixels;
  TilingCursor cursor(setup, numbers);
  while (!cursor.done()) {
    if (const auto pixel = cursor.sample()) pixels.push_back(*pixel);
  }
  counts.sampled += cursor.sampled();
  counts.tiled += cursor.tiled();
  return pixels;
}

std::vector<PixelPacket> spanPixels(const TilerSetup& setup, const NumberProfile& numbers,
                                    TilingCounts& counts) {
  std::vector<PixelPacket> pixels;
  counts += tileTriangle(setup, numbers, pixels);
  return pixels;
}

std::vector<PixelAddress> addresses(const std::vector<PixelPacket>& pixels) {
  std::vector<PixelAddress> result;
  for (const PixelPacket& pixel : pixels) result.emplace_back(pixel.i, pixel.j);
  return result;
}

// Equal sequences: no pixel twice, none missing, none too many.
TEST(Tiling, valid_pixels_are_those_of_brute_force_in_both_modes) {
  const TilerConfiguration configuration;
  RandomNumbers random(6);
  TilingCounts scanned, spans;
  std::int64_t empty = 0;
  for (int n = triangleCount(); n > 0; --n) {
    const ProjectedTriangle triangle = mixedTriangle(random);
    for (const bool oversample : {false, true}) {
      const TriangleVariables variables =
          encodeTriangle(triangle, configuration.numbers, {.oversample = oversample}).variables;
      ASSERT_TRUE(isTileable(variables, configuration.numbers.vertex_fraction_bits));
      const TilerSetup setup = setUpTriangle(variables, configuration);
      const std::vector<PixelPacket> pixels = scannedPixels(setup, configuration.numbers, scanned);
      ASSERT_EQ(addresses(pixels), bruteForcePixels(variables, configuration.numbers.vertex_fraction_bits))
          << "triangle " << n << (oversample ? ", oversampled" : ", undersampled");
      ASSERT_EQ(pixels, spanPixels(setup, configuration.numbers, spans)) << "triangle " << n;
      empty += pixels.empty() ? 1 : 0;
    }
  }
  EXPECT_EQ(scanned.sampled, spans.sampled);
  EXPECT_EQ(scanned.tiled, spans.tiled);
  // Not all is trivial, and not all is drawn.
  EXPECT_GT(scanned.tiled, triangleCount() * 50);
  EXPECT_GT(empty, triangleCount() / 50);
}

TEST(Tiling, other_vertex_fractions_keep_the_valid_set) {
  RandomNumbers random(7);
  for (int bits = 0; bits <= kLargestVertexFractionBits; ++bits) {
    TilerConfiguration configuration;
    configuration.numbers = withVertexFractionBits(configuration.numbers, bits);
    TilingCounts scanned, spans;
    for (int n = 0; n < 2000; ++n) {
      const TriangleVariables variables =
          encodeTriangle(mixedTriangle(random), configuration.numbers, {.oversample = n % 2 == 0}).variables;
      ASSERT_TRUE(isTileable(variables, bits));
      const TilerSetup setup = setUpTriangle(variables, configuration);
      const std::vector<PixelPacket> pixels = scannedPixels(setup, configuration.numbers, scanned);
      ASSERT_EQ(addresses(pixels), bruteForcePixels(variables, bits)) << bits << " bits, triangle " << n;
      ASSERT_EQ(pixels, spanPixels(setup, configuration.numbers, spans));
    }
    EXPECT_EQ(scanned.sampled, spans.sampled);
  }
}

// Values: plain float beside the formats themselves, truncation and narrow registers in both tilers,
// corrections.
TEST(Tiling, spans_have_the_values_of_the_scan_in_all_formats) {
  std::vector<TilerConfiguration> configurations(8);
  configurations[1].numbers.arithmetic = Rounding::kTruncate;
  configurations[1].numbers.output = Rounding::kTruncate;
  configurations[2].numbers.depth_plane.mantissa_sign = SignForm::kTwosComplement;
  configurations[2].numbers.color.mantissa_sign = SignForm::kTwosComplement;
  configurations[2].numbers.arithmetic = Rounding::kTruncate;
  configurations[3].numbers.color.leading_one = LeadingOne::kHidden;
  configurations[3].numbers.depth.leading_one = LeadingOne::kWritten;
  configurations[4].numbers.depth_accumulator_bits = 20;
  configurations[4].numbers.color_accumulator_bits = 14;
  configurations[5].corrections.clamp_depth = configurations[5].corrections.true_color = true;
  configurations[6].numbers = withColorMantissaBits(withDepthMantissaBits(NumberProfile{}, 12), 6);
  configurations[7].numbers.fixed_point_sign = SignForm::kSignMagnitude;
  RandomNumbers random(8);
  TilingCounts counts;
  std::vector<int> differs(configurations.size());
  int single = 0;
  for (int n = 0; n < 3000; ++n) {
    const ProjectedTriangle triangle = mixedTriangle(random);
    std::vector<PixelPacket> first;
    for (std::size_t c = 0; c < configurations.size(); ++c) {
      const TilerConfiguration& configuration = configurations[c];
      const EncodedTriangle encoded =
          encodeTriangle(triangle, configuration.numbers, {.oversample = n % 2 == 0});
      const TilerSetup setup = setUpTriangle(encoded.variables, configuration, &encoded.supplement);
      const std::vector<PixelPacket> pixels = scannedPixels(setup, configuration.numbers, counts);
      ASSERT_EQ(pixels, spanPixels(setup, configuration.numbers, counts))
          << "triangle " << n << ", formats " << c;
      if (c == 0) {
        first = pixels;
        single += setup.single_precision ? 1 : 0;
      }
      differs[c] += pixels != first ? 1 : 0;
    }
  }
  // The quick way is the usual one, and each configuration does something.
  EXPECT_GT(single, 2500);
  for (std::size_t c = 1; c < configurations.size(); ++c) EXPECT_GT(differs[c], 0) << "formats " << c;
}

// Digest 6.1: with its bars the undersample tolerance makes up for what rounding vertices can do, so no pixel
// of the exact triangle is lost.
TEST(Tiling, undersampling_loses_no_pixel_of_the_unrounded_triangle) {
  const TilerConfiguration configuration;
  RandomNumbers random(9);
  std::int64_t interior = 0, tiled = 0, lost = 0;
  for (int n = triangleCount() / 2; n > 0; --n) {
    ProjectedTriangle triangle = mixedTriangle(random);
    // Units of 2^-20 pixels, in which products are exact.
    std::array<std::int64_t, 3> i{}, j{};
    for (std::size_t k = 0; k < 3; ++k) {
      i[k] = static_cast<std::int64_t>(std::clamp(triangle[k].i, 0.0, 511.0) * 0x1p20);
      j[k] = static_cast<std::int64_t>(std::clamp(triangle[k].j, 0.0, 511.0) * 0x1p20);
      triangle[k].i = static_cast<double>(i[k]) * 0x1p-20;
      triangle[k].j = static_cast<double>(j[k]) * 0x1p-20;
    }
    const std::int64_t area = (i[1] - i[0]) * (j[2] - j[0]) - (j[1] - j[0]) * (i[2] - i[0]);
    if (area == 0) continue;
    const auto inside = [&](std::int64_t pi, std::int64_t pj) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t m = (k + 1) % 3;
        const std::int64_t p = (i[m] - i[k]) * (pj - j[k]) - (j[m] - j[k]) * (pi - i[k]);
        if (area > 0 ? p < 0 : p > 0) return false;
      }
      return true;
    };
    const TilerSetup setup =
        setUpTriangle(encodeTriangle(triangle, configuration.numbers, {}).variables, configuration);
    std::int64_t exact = 0, found = 0;
    const auto [i_min, i_max] = std::minmax({i[0], i[1], i[2]});
    const auto [j_min, j_max] = std::minmax({j[0], j[1], j[2]});
    for (std::int64_t pi = i_min >> 20; pi <= (i_max >> 20) + 1; ++pi) {
      for (std::int64_t pj = j_min >> 20; pj <= (j_max >> 20) + 1; ++pj)
        exact += inside(pi << 20, pj << 20) ? 1 : 0;
    }
    std::vector<PixelPacket> pixels;
    tiled += tileTriangle(setup, configuration.numbers, pixels).tiled;
    for (const PixelPacket& pixel : pixels)
      found += inside(std::int64_t{pixel.i} << 20, std::int64_t{pixel.j} << 20) ? 1 : 0;
    interior += exact;
    lost += exact - found;
  }
  EXPECT_EQ(lost, 0);
  EXPECT_GT(interior, triangleCount() * 10);
  EXPECT_GT(tiled, interior);
}

// Digest 6.2: oversampled, an interior line is never empty, as the report claims (7.1.2.2).
TEST(Tiling, oversampling_leaves_no_line_empty_but_the_first_or_last) {
  const TilerConfiguration configuration;
  RandomNumbers random(10);
  std::int64_t empty = 0;
  for (int n = 0; n < 20000; ++n) {
    const TriangleVariables variables =
        encodeTriangle(mixedTriangle(random), configuration.numbers, {.oversample = true}).variables;
    const TilerSetup setup = setUpTriangle(variables, configuration);
    std::vector<int> drawn(static_cast<std::size_t>(setup.lines) + 1);
    empty += forEachSpan(setup, [&](int line, StepSpan) {
               drawn[static_cast<std::size_t>(line)] = 1;
             }).empty_lines;
    for (int line = 1; line < setup.lines; ++line)
      ASSERT_EQ(drawn[static_cast<std::size_t>(line)], 1) << "triangle " << n;
  }
  EXPECT_GT(empty, 0);
}

}  // namespace
}  // namespace deltaz::ars
