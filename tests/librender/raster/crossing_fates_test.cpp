#include "librender/raster/crossing_fates.h"

#include <gtest/gtest.h>

namespace deltaz {
namespace {

TEST(crossing_fates, a_triangle_that_covers_a_sample_anywhere_is_not_hidden) {
  CrossingFates fates;
  fates.reset(2, 5);
  fates.notesOf(0)[1] = kCrossingHidden;
  fates.notesOf(1)[1] = kCrossingCovers;
  fates.notesOf(0)[2] = kCrossingHidden;
  fates.notesOf(1)[3] = kCrossingCovers | kCrossingHidden;
  const CrossingFates::Counts counts = fates.counted();
  EXPECT_EQ(counts.covering, 2U);
  EXPECT_EQ(counts.hidden, 1U);
}

TEST(crossing_fates, a_new_frame_begins_with_nothing) {
  CrossingFates fates;
  fates.reset(3, 9);
  fates.notesOf(2)[8] = kCrossingCovers;
  fates.reset(2, 9);
  EXPECT_EQ(fates.counted().covering, 0U);
}

}  // namespace
}  // namespace deltaz
