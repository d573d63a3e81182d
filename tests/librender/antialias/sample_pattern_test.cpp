#include "librender/antialias/sample_pattern.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace deltaz {
namespace {

TEST(SamplePattern, places_are_distinct_symmetric_about_the_centre_and_inside_their_cells) {
  for (const int count : kSampleCounts) {
    for (const SamplePattern pattern : {SamplePattern::kOrdered, SamplePattern::kRotated}) {
      const std::vector<SamplePlace> places = samplePlaces(count, pattern);
      ASSERT_EQ(places.size(), static_cast<std::size_t>(count));
      std::set<std::pair<int, int>> all;
      for (const SamplePlace& place : places) all.insert({place.x, place.y});
      EXPECT_EQ(all.size(), places.size());
      for (const SamplePlace& place : places) EXPECT_TRUE(all.contains({-place.x, -place.y}));
      const int across = samplesAcross(count), cell = 256 / across;
      for (int k = 0; k < count; ++k) {
        const SamplePlace& place = places[static_cast<std::size_t>(k)];
        EXPECT_LE(std::abs(2 * (place.x + 128) - (2 * (k % across) + 1) * cell), cell);
        EXPECT_LE(std::abs(2 * (place.y + 128) - (2 * (k / across) + 1) * cell), cell);
      }
    }
  }
}

TEST(SamplePattern, one_sample_is_the_centre) {
  for (const SamplePattern pattern : {SamplePattern::kOrdered, SamplePattern::kRotated}) {
    EXPECT_EQ(sampleOffsets(1, pattern), nullptr);
    EXPECT_EQ(samplePlaces(1, pattern).front().x, 0);
    EXPECT_EQ(samplePlaces(1, pattern).front().y, 0);
  }
}

// What a level edge passes one after the other as it moves over the pixel.
TEST(SamplePattern, rotated_samples_share_hardly_any_column_or_row) {
  for (const auto& [count, columns] : {std::pair(4, 4), std::pair(16, 16), std::pair(64, 32)}) {
    std::set<int> x, y;
    for (const SamplePlace& place : samplePlaces(count, SamplePattern::kRotated)) {
      x.insert(place.x);
      y.insert(place.y);
    }
    EXPECT_EQ(x.size(), static_cast<std::size_t>(columns));
    EXPECT_EQ(y.size(), static_cast<std::size_t>(columns));
  }
}

// Offsets are by place in 4 x 4 cells, and places by sample of a pixel: two ways to say the same.
TEST(SamplePattern, offsets_and_places_agree) {
  for (const int count : {4, 16, 64}) {
    const SampleOffsets& offsets = *sampleOffsets(count, SamplePattern::kRotated);
    const std::vector<SamplePlace> places = samplePlaces(count, SamplePattern::kRotated);
    const int across = samplesAcross(count);
    for (int k = 0; k < count; ++k) {
      const int j = k % across, i = k / across;
      const auto cell = static_cast<std::size_t>(i % 4 * 4 + j % 4);
      const SamplePlace& place = places[static_cast<std::size_t>(k)];
      // Both in 1/512 of a cell from the pixel's left upper corner.
      EXPECT_EQ((place.x + 128) * across, 256 * j + 128 + offsets.x[cell]);
      EXPECT_EQ((place.y + 128) * across, 256 * i + 128 + offsets.y[cell]);
      EXPECT_LE(std::max(std::abs(offsets.x[cell]), std::abs(offsets.y[cell])), offsets.reach);
    }
    EXPECT_LT(offsets.reach, 128);
  }
}

TEST(SamplePattern, the_central_sample_is_the_first_of_the_nearest) {
  EXPECT_EQ(centralSample(samplePlaces(1, SamplePattern::kOrdered)), 0);
  EXPECT_EQ(centralSample(samplePlaces(4, SamplePattern::kOrdered)), 0);
  EXPECT_EQ(centralSample(samplePlaces(16, SamplePattern::kOrdered)), 5);
  EXPECT_EQ(centralSample(samplePlaces(64, SamplePattern::kOrdered)), 27);
}

}  // namespace
}  // namespace deltaz
