#include "librender/ars/machine/functional_memory.h"

#include <gtest/gtest.h>

#include "librender/ars/experiments/random_triangles.h"
#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "tests/support/every_simd_target.h"

namespace deltaz::ars {
namespace {

// Triangles of all sizes and directions, many of them one in another so that depths tie, some of them
// background.
std::vector<TilerSetup> randomSetups(const TilerConfiguration& configuration, int count) {
  RandomNumbers random(11);
  std::vector<TilerSetup> setups;
  for (int k = 0; k < count; ++k) {
    ProjectedTriangle corners = randomTriangle(random, {.side = random.uniform(2, k % 5 == 0 ? 450 : 40),
                                                        .needle_share = k % 7 == 0 ? 1.0 : 0.0,
                                                        .needle_length = 200});
    const double depth = k % 3 == 0 ? 0.25 : random.uniform(0.01, 1);
    for (ProjectedVertex& vertex : corners) {
      vertex.depth = k % 3 == 0 ? depth : depth * random.uniform(0.2, 1);
      vertex.color = random.uniform(0, 255);
    }
    const EncodedTriangle encoded =
        encodeTriangle(corners, configuration.numbers, {.oversample = k % 2 == 0, .background = k % 11 == 0});
    setups.push_back(setUpTriangle(encoded.variables, configuration, &encoded.supplement));
  }
  return setups;
}

std::vector<std::uint64_t> noWords() {
  return std::vector<std::uint64_t>(FunctionalMemory::kWords + FunctionalMemory::kPadding);
}

void expectEqualCounts(const MemoryCounts& a, const MemoryCounts& b) {
  EXPECT_EQ(a.cycles, b.cycles);
  EXPECT_EQ(a.ties, b.ties);
  EXPECT_EQ(a.split_ties, b.split_ties);
}

// What the memory modules make of the tiler's pixels, one by one.
void expectAsOneByOne(const TilerConfiguration& configuration, TieRule ties, int triangles) {
  const std::vector<TilerSetup> setups = randomSetups(configuration, triangles);
  const int mantissa_bits = configuration.numbers.depth.mantissa_bits;
  std::vector<std::uint64_t> expected = noWords(), words = noWords();
  const std::span<std::uint64_t> picture = std::span<std::uint64_t>(expected).first(FunctionalMemory::kWords);
  MemoryModule module(picture, ties, mantissa_bits);
  FunctionalMemory memory(words, ties, mantissa_bits);
  std::vector<PixelPacket> pixels;
  for (const TilerSetup& setup : setups) {
    pixels.clear();
    tileTriangle(setup, configuration.numbers, pixels);
    for (const PixelPacket& pixel : pixels)
      module.write(static_cast<std::uint32_t>(pixel.i * kScreenPixels + pixel.j),
                   memoryWord(pixel.depth, pixel.color), pixel.background);
    memory.write(setup, configuration.numbers);
  }
  EXPECT_TRUE(words == expected);
  expectEqualCounts(memory.counts(), module.counts());
  EXPECT_GT(module.counts().ties, 100);
  EXPECT_GT(module.counts().split_ties, 0);
}

TEST(FunctionalMemory, holds_and_counts_what_pixels_one_by_one_would) {
  onEverySimdTarget([] {
    expectAsOneByOne({}, TieRule::kFirstStays, 1500);
    expectAsOneByOne({}, TieRule::kBrighter, 1500);
  });
}

TEST(FunctionalMemory, knows_depths_of_other_widths) {
  onEverySimdTarget([] {
    for (const int bits : {9, 14, 22}) {
      TilerConfiguration configuration;
      configuration.numbers.depth.mantissa_bits = bits;
      expectAsOneByOne(configuration, TieRule::kFirstStays, 300);
    }
  });
}

TEST(FunctionalMemory, takes_triangles_that_vectors_do_not_serve_pixel_by_pixel) {
  TilerConfiguration configuration;
  configuration.corrections.clamp_depth = true;
  expectAsOneByOne(configuration, TieRule::kFirstStays, 300);
}

TEST(FunctionalMemory, leaves_what_stands_behind_the_picture) {
  std::vector<std::uint64_t> words = noWords();
  for (std::size_t k = FunctionalMemory::kWords; k < words.size(); ++k) words[k] = 0x123456789ABCDEF0 + k;
  const std::vector<std::uint64_t> before = words;
  FunctionalMemory memory(words, TieRule::kFirstStays, kDepthMantissaBits);
  ProjectedTriangle corner = {{{.i = 505, .j = 511}, {.i = 511, .j = 505}, {.i = 511, .j = 511}}};
  for (ProjectedVertex& vertex : corner) vertex.depth = 0.5, vertex.color = 200;
  const TilerConfiguration configuration;
  memory.write(setUpTriangle(encodeTriangle(corner, configuration.numbers, {}).variables, configuration),
               configuration.numbers);
  EXPECT_GT(memory.counts().writes(), 10);
  EXPECT_NE(words[FunctionalMemory::kWords - 1], before[FunctionalMemory::kWords - 1]);
  EXPECT_TRUE(std::equal(words.end() - FunctionalMemory::kPadding, words.end(),
                         before.end() - FunctionalMemory::kPadding));
}

}  // namespace
}  // namespace deltaz::ars
