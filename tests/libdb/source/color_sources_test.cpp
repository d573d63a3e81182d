// What the texts and rasters that give colours are taken for, and what is refused.
#include <fstream>
#include <gtest/gtest.h>

#include "libdb/source/class_legend.h"
#include "libdb/source/color_image.h"
#include "libdb/source/color_ramp.h"
#include "tests/libdb/source/test_rasters.h"

namespace deltaz {
namespace {

std::string written(const TemporaryDirectory& folder, const std::string& text) {
  static int count = 0;
  const std::string path = folder.file("colors" + std::to_string(++count) + ".txt");
  std::ofstream(path) << text;
  return path;
}

TEST(ColorText, takes_what_gdaldem_and_qgis_write) {
  const TemporaryDirectory folder;
  const auto lines = readColorLines(written(folder,
                                            "# a comment\n"
                                            "INTERPOLATION:INTERPOLATED\n"
                                            "-10 1 2 3\r\n"
                                            "0,4,5,6,7,sea level\n"
                                            "10:7:8:9\n"
                                            "\n"
                                            "20\tRed\n"
                                            "30 1 2 3 30 m trees  # tall\n"
                                            "40 1 2 3 128\n"
                                            "nv 0 0 0 0"));
  ASSERT_TRUE(lines.ok()) << lines.error().message();
  ASSERT_EQ(lines.value().size(), 7u);
  EXPECT_EQ(lines.value()[0].line, 3);
  EXPECT_EQ(lines.value()[0].color, (ColorCode{1, 2, 3, 255}));
  EXPECT_EQ(lines.value()[1].color, (ColorCode{4, 5, 6, 7}));
  EXPECT_EQ(lines.value()[1].label, "sea level");
  EXPECT_EQ(lines.value()[2].color, (ColorCode{7, 8, 9, 255}));
  EXPECT_EQ(lines.value()[3].color, (ColorCode{255, 0, 0, 255}));
  EXPECT_EQ(lines.value()[4].color, (ColorCode{1, 2, 3, 255}));
  EXPECT_EQ(lines.value()[4].label, "30 m trees");
  EXPECT_EQ(lines.value()[5].color, (ColorCode{1, 2, 3, 128}));
  EXPECT_EQ(lines.value()[6].value, "nv");
}

TEST(ColorText, names_file_and_line_of_what_it_does_not_understand) {
  const TemporaryDirectory folder;
  for (const std::string wrong :
       {"5", "5 1 2", "5 1 2 256", "5 1 2 -1", "5 1 2 3 300", "5 pinkish", "5 1.5 2 3"}) {
    const std::string path = written(folder, "0 1 2 3\n" + wrong + "\n");
    const auto lines = readColorLines(path);
    ASSERT_FALSE(lines.ok()) << wrong;
    EXPECT_EQ(lines.error().kind, ErrorKind::kInvalid);
    EXPECT_EQ(lines.error().where, path + ", line 2") << wrong;
  }
  EXPECT_FALSE(readColorLines(written(folder, "# nothing\n")).ok());
  EXPECT_EQ(readColorLines(folder.file("missing")).error().kind, ErrorKind::kCannotAccess);
}

TEST(ColorRamp, interpolates_codes_and_holds_beyond_its_ends) {
  const TemporaryDirectory folder;
  const auto ramp =
      ColorRamp::read(written(folder, "50% 100 0 0 255\n0 0 0 0 55\n1000 200 10 0\nnv 1 2 3\n"), -100, 300);
  ASSERT_TRUE(ramp.ok()) << ramp.error().message();
  EXPECT_EQ(ramp.value().colorAt(-5), (ColorCode{0, 0, 0, 55}));
  EXPECT_EQ(ramp.value().colorAt(25), (ColorCode{25, 0, 0, 105}));
  EXPECT_EQ(ramp.value().colorAt(100), (ColorCode{100, 0, 0, 255}));
  EXPECT_EQ(ramp.value().colorAt(550), (ColorCode{150, 5, 0, 255}));
  EXPECT_EQ(ramp.value().colorAt(5000), (ColorCode{200, 10, 0, 255}));
  EXPECT_EQ(ramp.value().colorOfVoid(), (ColorCode{1, 2, 3, 255}));
  EXPECT_FALSE(ColorRamp::read(written(folder, "low 1 2 3\n"), 0, 1).ok());
  EXPECT_FALSE(ColorRamp::read(written(folder, "nv 1 2 3\n"), 0, 1).ok());
}

TEST(ClassLegend, takes_whole_numbers_once_each) {
  const TemporaryDirectory folder;
  const auto legend = ClassLegend::read(written(folder, "-1 1 2 3\n91 4 5 6 urban\n"));
  ASSERT_TRUE(legend.ok()) << legend.error().message();
  EXPECT_EQ(legend.value().colors.at(91), (ColorCode{4, 5, 6, 255}));
  EXPECT_EQ(legend.value().colors.size(), 2u);
  EXPECT_FALSE(ClassLegend::read(written(folder, "1 1 2 3\n1 1 2 3\n")).ok());
  EXPECT_FALSE(ClassLegend::read(written(folder, "1.5 1 2 3\n")).ok());
}

Result<std::vector<CoveredColor>> pixelsOf(const TemporaryDirectory& folder, const TestRaster& raster,
                                           const ColorImageOptions& options = {}) {
  std::vector<std::string> warnings;
  DELTAZ_TRY_ASSIGN(const ColorImage image,
                    ColorImage::open(makeRaster(folder, raster, "image.tif"), options, warnings));
  std::vector<CoveredColor> colors(static_cast<std::size_t>(image.columns()) *
                                   static_cast<std::size_t>(image.rows()));
  DELTAZ_TRY(image.read({0, 0, image.columns(), image.rows()}, colors));
  return colors;
}

TestRaster grey(GDALDataType type, std::vector<double> values) {
  TestRaster raster;
  raster.type = type;
  raster.columns = 2;
  raster.rows = 1;
  raster.values = std::move(values);
  return raster;
}

TEST(ColorImage, scales_16_bits_by_what_the_file_says_or_fills) {
  const TemporaryDirectory folder;
  const auto full = pixelsOf(folder, grey(GDT_UInt16, {0, 65535}));
  ASSERT_TRUE(full.ok()) << full.error().message();
  EXPECT_EQ(full.value()[1].green, 1);
  const auto dark = pixelsOf(folder, grey(GDT_UInt16, {0, 4095}));
  ASSERT_FALSE(dark.ok());
  EXPECT_NE(dark.error().message().find("4095 of 65535"), std::string::npos) << dark.error().message();
  // The same numbers in a file of 12 bits.
  const std::string twelve = folder.file("twelve.tif");
  {
    const GDALDatasetUniquePtr source(GDALDataset::Open(folder.file("image.tif").c_str()));
    std::array<const char*, 2> bits = {"NBITS=12", nullptr};
    const GDALDatasetUniquePtr copy(GetGDALDriverManager()->GetDriverByName("GTiff")->CreateCopy(
        twelve.c_str(), source.get(), FALSE, const_cast<char**>(bits.data()), nullptr, nullptr));
    ASSERT_TRUE(copy != nullptr);
  }
  std::vector<std::string> warnings;
  const auto said = ColorImage::open(twelve, {}, warnings);
  ASSERT_TRUE(said.ok()) << said.error().message();
  std::array<CoveredColor, 2> colors;
  ASSERT_TRUE(said.value().read({0, 0, 2, 1}, colors).ok());
  EXPECT_EQ(colors[1].green, 1);
}

TEST(ColorImage, leaves_nodata_without_cover_only_where_all_bands_have_it) {
  const TemporaryDirectory folder;
  TestRaster raster = grey(GDT_Byte, {0, 7});
  raster.bands = 3;
  raster.change = [](GDALDataset& dataset) {
    std::array<std::uint8_t, 2> zeros = {0, 0};
    for (const int band : {2, 3}) {
      ASSERT_EQ(dataset.GetRasterBand(band)->RasterIO(GF_Write, 0, 0, 2, 1, zeros.data(), 2, 1, GDT_Byte, 0,
                                                      0, nullptr),
                CE_None);
    }
  };
  ColorImageOptions options;
  options.nodata = 0;
  const auto colors = pixelsOf(folder, raster, options);
  ASSERT_TRUE(colors.ok()) << colors.error().message();
  EXPECT_EQ(colors.value()[0].cover, 0);
  EXPECT_EQ(colors.value()[1].cover, 1);
}

TEST(ColorImage, refuses_what_it_would_have_to_guess) {
  const TemporaryDirectory folder;
  const auto refused = [&](const TestRaster& raster, const ColorImageOptions& options,
                           const std::string& word, ErrorKind kind) {
    const auto colors = pixelsOf(folder, raster, options);
    ASSERT_FALSE(colors.ok()) << word;
    EXPECT_EQ(colors.error().kind, kind) << colors.error().message();
    EXPECT_NE(colors.error().message().find(word), std::string::npos) << colors.error().message();
    EXPECT_FALSE(colors.error().remedy.empty()) << word;
  };
  refused(grey(GDT_Float32, {0, 1}), {}, "Float32", ErrorKind::kInvalid);
  TestRaster five = grey(GDT_Byte, {0, 1});
  five.bands = 5;
  refused(five, {}, "red, green and blue", ErrorKind::kInvalid);
  TestRaster unsaid = grey(GDT_Byte, {0, 1});
  unsaid.crs.clear();
  refused(unsaid, {}, "--crs", ErrorKind::kUsage);
  TestRaster unplaced = grey(GDT_Byte, {0, 1});
  unplaced.georeferenced = false;
  refused(unplaced, {}, "not georeferenced", ErrorKind::kInvalid);
  ColorImageOptions classes;
  classes.classes = true;
  refused(grey(GDT_Byte, {3, 8}), classes, "3, 8", ErrorKind::kUsage);
  refused(grey(GDT_Float32, {3, 8}), classes, "Float32", ErrorKind::kInvalid);
}

TEST(ColorImage, brings_longitudes_to_the_images_own_turn) {
  const TemporaryDirectory folder;
  TestRaster raster = grey(GDT_Byte, {0, 1});
  raster.transform = {179, 1, 0, 10, 0, -1};
  std::vector<std::string> warnings;
  const auto image = ColorImage::open(makeRaster(folder, raster, "image.tif"), {}, warnings);
  ASSERT_TRUE(image.ok()) << image.error().message();
  std::array<double, 2> x = {-179.5, 179.5}, y = {9.5, 9.5};
  image.value().toPixels(x, y);
  EXPECT_NEAR(x[0], 1.5, 1e-9);
  EXPECT_NEAR(x[1], 0.5, 1e-9);
  EXPECT_NEAR(y[0], 0.5, 1e-9);
  EXPECT_FALSE(image.value().closesRound());
}

}  // namespace
}  // namespace deltaz
