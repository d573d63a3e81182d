#include "tools/common/png_file.h"

#include <gtest/gtest.h>
#include <string_view>

#include "formats/file_system.h"
#include "tests/support/temporary_directory.h"
#include "tools/common/output_file.h"

namespace deltaz {
namespace {

Picture noisyPicture(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  std::uint32_t state = 1;
  for (int i = 0; i < 3 * width * height; ++i) {
    state = state * 1664525u + 1013904223u;
    picture.rgb.push_back(static_cast<std::uint8_t>(state >> 24));
  }
  return picture;
}

std::string written(const TemporaryDirectory& folder, std::span<const std::byte> bytes) {
  const std::string path = folder.file("picture.png");
  EXPECT_TRUE(writeOutput(path, bytes, true).ok());
  return path;
}

TEST(PngFile, comes_back_as_it_was) {
  const TemporaryDirectory folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {4, 2}, {640, 3}, {3, 640}}) {
    const Picture picture = noisyPicture(width, height);
    const auto read = readPng(written(folder, encodePng(picture).value()));
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_EQ(read.value().width, width);
    EXPECT_EQ(read.value().height, height);
    EXPECT_TRUE(read.value().rgb == picture.rgb);
  }
}

TEST(PngFile, names_the_program_and_no_date) {
  const auto bytes = encodePng(noisyPicture(4, 2)).value();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(text.find("Software"), text.npos);
  EXPECT_NE(text.find("deltaz"), text.npos);
  EXPECT_NE(text.find("sRGB"), text.npos);
  EXPECT_EQ(text.find("tIME"), text.npos);
}

TEST(PngFile, a_cut_or_changed_file_is_refused) {
  const TemporaryDirectory folder;
  const auto whole = encodePng(noisyPicture(40, 30)).value();
  for (std::size_t length = 0; length + 12 < whole.size(); length += 1 + length / 3)
    EXPECT_FALSE(readPng(written(folder, std::span(whole).first(length))).ok()) << length;
  for (std::size_t place : {std::size_t{0}, std::size_t{13}, std::size_t{18}, whole.size() / 2}) {
    auto changed = whole;
    changed[place] ^= std::byte{0x55};
    EXPECT_FALSE(readPng(written(folder, changed)).ok()) << place;
  }
}

TEST(PngFile, a_missing_file_cannot_be_accessed) {
  const auto read = readPng("/nowhere/picture.png");
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.error().kind, ErrorKind::kCannotAccess);
}

}  // namespace
}  // namespace deltaz
