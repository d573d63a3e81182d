#include "tools/common/picture_file.h"

#include <chrono>
#include <gtest/gtest.h>
#include <limits>
#include <thread>

namespace deltaz {
namespace {

Picture smallPicture() {
  Picture picture;
  picture.width = 4;
  picture.height = 2;
  for (int i = 0; i < 24; ++i) picture.rgb.push_back(static_cast<std::uint8_t>(10 * i));
  picture.depth = {1, 2, 3, 4, 5, 6, 7, std::numeric_limits<float>::infinity()};
  return picture;
}

TEST(PictureFile, equal_pixels_give_equal_bytes_at_any_hour) {
  const Picture picture = smallPicture();
  const auto png = encodePng(picture).value();
  const auto depth = encodeDepthTiff(picture, "{}").value();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_EQ(encodePng(picture).value(), png);
  EXPECT_EQ(encodeDepthTiff(picture, "{}").value(), depth);
  EXPECT_NE(encodeDepthTiff(picture, "{ }").value(), depth);
}

TEST(PictureFile, the_bytes_are_those_of_the_formats) {
  const auto png = encodePng(smallPicture()).value();
  ASSERT_GT(png.size(), 8u);
  EXPECT_EQ(png[1], std::byte{'P'});
  const auto tiff = encodeDepthTiff(smallPicture(), "description").value();
  ASSERT_GT(tiff.size(), 4u);
  EXPECT_EQ(tiff[0], std::byte{'I'});
}

}  // namespace
}  // namespace deltaz
