#include "tools/common/depth_tiff.h"

#include <algorithm>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <limits>

namespace deltaz {
namespace {

Picture depthPicture(int width, int height) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  for (int i = 0; i < width * height; ++i)
    picture.depth.push_back(i % 7 == 6 ? std::numeric_limits<float>::infinity()
                                       : 1e-3f * static_cast<float>(i) + 0.1f);
  return picture;
}

// Somebody else's reader of what was written.
std::vector<float> readByGdal(const std::vector<std::byte>& bytes, std::string& description) {
  GDALAllRegister();
  std::vector<std::byte> copy = bytes;
  const char* const name = "/vsimem/depth_tiff_test.tif";
  VSIFCloseL(VSIFileFromMemBuffer(name, reinterpret_cast<GByte*>(copy.data()), copy.size(), FALSE));
  std::vector<float> depth;
  {
    const GDALDatasetUniquePtr file(GDALDataset::Open(name));
    if (file == nullptr || file->GetRasterCount() != 1) return depth;
    GDALRasterBand* const band = file->GetRasterBand(1);
    depth.resize(static_cast<std::size_t>(band->GetXSize()) * static_cast<std::size_t>(band->GetYSize()));
    if (band->RasterIO(GF_Read, 0, 0, band->GetXSize(), band->GetYSize(), depth.data(), band->GetXSize(),
                       band->GetYSize(), GDT_Float32, 0, 0) != CE_None)
      depth.clear();
    const char* const text = file->GetMetadataItem("TIFFTAG_IMAGEDESCRIPTION");
    description = text != nullptr ? text : "";
  }
  VSIUnlink(name);
  return depth;
}

TEST(DepthTiff, every_depth_is_read_by_others_as_it_was) {
  for (const auto& [width, height] : {std::pair{1, 1}, {4, 2}, {1280, 40}, {3, 20000}, {20000, 2}}) {
    const Picture picture = depthPicture(width, height);
    std::string description;
    EXPECT_TRUE(readByGdal(encodeDepthTiff(picture, R"({"a": 1})").value(), description) == picture.depth)
        << width;
    EXPECT_EQ(description, R"({"a": 1})");
  }
}

TEST(DepthTiff, equal_depths_give_equal_bytes_without_a_date) {
  const auto bytes = encodeDepthTiff(depthPicture(40, 30), "{}").value();
  EXPECT_EQ(encodeDepthTiff(depthPicture(40, 30), "{}").value(), bytes);
  EXPECT_NE(encodeDepthTiff(depthPicture(40, 30), "{ }").value(), bytes);
  const std::uint8_t date_tag[] = {0x32, 0x01, 0x02, 0x00};  // DateTime, text
  EXPECT_EQ(std::search(bytes.begin(), bytes.end(), date_tag, date_tag + 4,
                        [](std::byte a, std::uint8_t b) { return a == std::byte{b}; }),
            bytes.end());
}

}  // namespace
}  // namespace deltaz
