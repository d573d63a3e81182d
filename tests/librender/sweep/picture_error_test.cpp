#include "librender/sweep/picture_error.h"

#include <cmath>
#include <gtest/gtest.h>

namespace deltaz {
namespace {

Picture gray(std::size_t pixels, std::uint8_t value) {
  Picture picture;
  picture.rgb.assign(3 * pixels, value);
  return picture;
}

TEST(PictureError, of_equal_pictures_is_none) {
  const PictureError error = comparePictures(gray(10, 7), gray(10, 7));
  EXPECT_EQ(error.pixels, 10u);
  EXPECT_EQ(error.differing, 0u);
  EXPECT_TRUE(std::isinf(error.peakSignalToNoise()));
}

TEST(PictureError, counts_pixels_that_are_seen_to_differ) {
  Picture a = gray(4, 100);
  a.rgb[0] = 102;  // within two
  a.rgb[5] = 97;   // one channel of the second pixel
  a.rgb[9] = 0;    // the fourth
  a.rgb[10] = 0;
  const PictureError error = comparePictures(a, gray(4, 100));
  EXPECT_EQ(error.differing, 2u);
  EXPECT_DOUBLE_EQ(error.differingShare(), 0.5);
  EXPECT_EQ(error.largest, 100);
  EXPECT_DOUBLE_EQ(error.mean_square, (4.0 + 9 + 20000) / 12);
  EXPECT_NEAR(error.peakSignalToNoise(), 10 * std::log10(65025 / error.mean_square), 1e-12);
}

TEST(PictureError, of_pictures_joined_is_that_of_one_large_picture) {
  Picture a = gray(2, 10), b = gray(6, 10);
  a.rgb[1] = 50;
  b.rgb[17] = 90;
  Picture both = a;
  both.rgb.insert(both.rgb.end(), b.rgb.begin(), b.rgb.end());
  const PictureError sum = joined(comparePictures(a, gray(2, 10)), comparePictures(b, gray(6, 10)));
  const PictureError whole = comparePictures(both, gray(8, 10));
  EXPECT_EQ(sum.pixels, whole.pixels);
  EXPECT_EQ(sum.differing, whole.differing);
  EXPECT_EQ(sum.largest, whole.largest);
  EXPECT_DOUBLE_EQ(sum.mean_square, whole.mean_square);
}

}  // namespace
}  // namespace deltaz
