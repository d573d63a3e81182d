#include "librender/ars/antialiaser/antialiaser.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "librender/ars/antialiaser/shift_add_filter.h"

namespace deltaz::ars {
namespace {

std::vector<std::uint8_t> streamed(Antialiaser& antialiaser, const std::vector<std::uint8_t>& samples) {
  std::vector<std::uint8_t> picture;
  for (const std::uint8_t sample : samples)
    if (const auto pixel = antialiaser.put(sample)) picture.push_back(*pixel);
  return picture;
}

std::vector<std::uint8_t> noise(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> samples(std::size_t{kScreenLines} * kScreenPixels);
  for (std::uint8_t& sample : samples) sample = static_cast<std::uint8_t>(random());
  return samples;
}

// Report 4.4.4; digest 9 and 15.
TEST(Antialiaser, gives_its_first_pixel_with_input_514) {
  Antialiaser antialiaser;
  for (int input = 1; input < kAntialiaserLatency; ++input) ASSERT_FALSE(antialiaser.put(1)) << input;
  EXPECT_TRUE(antialiaser.put(1));
}

TEST(Antialiaser, streams_what_the_filter_makes_picture_after_picture) {
  const ShiftAddKernel kernel = shiftAddKernelNamed("report").value();
  Antialiaser antialiaser;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const std::vector<std::uint8_t> samples = noise(seed);
    const std::vector<std::uint8_t> picture = streamed(antialiaser, samples);
    ASSERT_EQ(picture.size(), 256U * 256U);
    EXPECT_TRUE(picture == filtered(kernel, samples, kScreenPixels, kScreenLines));
  }
}

}  // namespace
}  // namespace deltaz::ars
