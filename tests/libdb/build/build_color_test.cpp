#include "libdb/build/build_color.h"

#include <cmath>
#include <fstream>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <set>

#include "libdb/access/color.h"
#include "libdb/access/database.h"
#include "libdb/access/synthetic_color.h"
#include "tests/support/projected_grid.h"
#include "tests/support/synthetic_grid.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

using Code = std::array<std::uint8_t, 4>;

struct TestImage {
  int columns = 200, rows = 200;
  std::array<double, 6> transform{};  // GDAL's
  std::string crs = "EPSG:4326";
  int bands = 3;
  std::function<Code(int column, int row)> color;
  std::function<void(GDALDataset&)> prepare;
};

std::string makeImage(const TemporaryDirectory& folder, const TestImage& image, const std::string& name) {
  GDALAllRegister();
  const std::string path = folder.file(name);
  GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), image.columns, image.rows, image.bands, GDT_Byte, nullptr));
  std::array<double, 6> transform = image.transform;
  dataset->SetGeoTransform(transform.data());
  OGRSpatialReference reference;
  reference.SetFromUserInput(image.crs.c_str());
  dataset->SetSpatialRef(&reference);
  if (image.bands == 4) dataset->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  if (image.prepare) image.prepare(*dataset);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(image.columns));
  for (int band = 0; band < image.bands; ++band) {
    for (int r = 0; r < image.rows; ++r) {
      for (int c = 0; c < image.columns; ++c)
        row[static_cast<std::size_t>(c)] = image.color(c, r)[static_cast<std::size_t>(band)];
      EXPECT_EQ(dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, r, image.columns, 1, row.data(),
                                                           image.columns, 1, GDT_Byte, 0, 0, nullptr),
                CE_None);
    }
  }
  return path;
}

// The small synthetic grid: 121 x 121 posts of 30 arc-seconds from 43 N, 80 W.
constexpr double kWest = -80, kSouth = 43, kSpacing = 30.0 / 3600;

// An image with `per_cell` pixels a cell whose pixels fill the grid's cells exactly.
TestImage overGrid(int per_cell, std::function<Code(int, int)> color) {
  TestImage image;
  image.columns = image.rows = 120 * per_cell;
  const double pixel = kSpacing / per_cell;
  image.transform = {kWest, pixel, 0, kSouth + 120 * kSpacing, 0, -pixel};
  image.color = std::move(color);
  return image;
}

MemoryFileSystem withMap(const ColorBuildOptions& options, const RawGrid& grid = syntheticGrid(),
                         std::vector<std::string>* warnings = nullptr) {
  MemoryFileSystem files = buildInMemory(grid);
  const auto built = buildColor(files, kMemoryDatabasePath, options);
  EXPECT_TRUE(built.ok()) << built.error().message();
  if (built.ok() && warnings != nullptr) *warnings = built.value().warnings;
  return files;
}

Database opened(const MemoryFileSystem& files) {
  auto database = Database::open(files, kMemoryDatabasePath);
  EXPECT_TRUE(database.ok()) << database.error().message();
  return std::move(database).value();
}

// The finest texel that holds a place, in level-0 posts.
Code texelAt(const ColorMap& map, double column, double row) {
  const auto node = map.nodeAt(0, column, row, kLowestColorLevel).value();
  if (!node) return {};
  const double texel = colorTexelCells(64, node->level);
  const auto tile = map.tile(*node).value();
  const auto i = static_cast<std::size_t>(std::floor(column / texel) - 128.0 * node->x) + 1,
             j = static_cast<std::size_t>(std::floor(row / texel) - 128.0 * node->y) + 1;
  const std::size_t k = 4 * (j * kColorTileSide + i);
  return {tile[k], tile[k + 1], tile[k + 2], tile[k + 3]};
}

const ColorMap& mapOf(const Database& database) {
  return database.colorMaps().front();
}

ColorBuildOptions ofImages(std::vector<std::string> images) {
  ColorBuildOptions options;
  options.name = "summer";
  options.images = std::move(images);
  return options;
}

Code patterned(int column, int row) {
  return {static_cast<std::uint8_t>(7 * column), static_cast<std::uint8_t>(5 * row),
          static_cast<std::uint8_t>(column * row), 255};
}

TEST(BuildColor, pixels_on_texels_come_back_code_for_code) {
  const TemporaryDirectory folder;
  const MemoryFileSystem files = withMap(ofImages({makeImage(folder, overGrid(2, patterned), "image.tif")}));
  const Database database = opened(files);
  EXPECT_EQ(mapOf(database).treeOf(0)->finest_level, 0);
  const GridHeader& grid = database.area().grids[0];
  for (int c = 0; c < 240; c += 3) {
    for (int r = 0; r < 240; r += 3) {
      const double column = static_cast<double>(grid.x_axis.first) + (c + 0.5) / 2,
                   row = static_cast<double>(grid.y_axis.first) + (240 - r - 0.5) / 2;
      ASSERT_EQ(texelAt(mapOf(database), column, row), patterned(c, r)) << c << " " << r;
    }
  }
}

TEST(BuildColor, a_map_is_as_deep_as_its_image_is_fine) {
  const TemporaryDirectory folder;
  const auto grey = [](int, int) { return Code{90, 90, 90, 255}; };
  for (const auto& [per_cell, level] :
       {std::pair(1, 1), std::pair(2, 0), std::pair(3, -1), std::pair(4, -1)}) {
    const std::string path =
        makeImage(folder, overGrid(per_cell, grey), "grey" + std::to_string(per_cell) + ".tif");
    const MemoryFileSystem files = withMap(ofImages({path}));
    EXPECT_EQ(mapOf(opened(files)).treeOf(0)->finest_level, level) << per_cell;
  }
}

TEST(BuildColor, detail_stays_where_the_fine_image_is) {
  const TemporaryDirectory folder;
  TestImage inset = overGrid(8, patterned);
  inset.columns = inset.rows = 80;  // 10 x 10 cells in the north-west
  const std::string fine = makeImage(folder, inset, "fine.tif"),
                    coarse = makeImage(folder, overGrid(1, patterned), "coarse.tif");
  const MemoryFileSystem files = withMap(ofImages({fine, coarse}));
  const Database database = opened(files);
  const GridHeader& grid = database.area().grids[0];
  const auto level_at = [&](double column, double row) {
    return int{mapOf(database)
                   .nodeAt(0, static_cast<double>(grid.x_axis.first) + column,
                           static_cast<double>(grid.y_axis.first) + row, kLowestColorLevel)
                   .value()
                   ->level};
  };
  EXPECT_EQ(level_at(5, 115), -2);
  EXPECT_EQ(level_at(100, 20), 1);
  // The earlier image lies on top.
  const double column = static_cast<double>(grid.x_axis.first) + 4.5 / 8,
               row = static_cast<double>(grid.y_axis.first) + 120 - 6.5 / 8;
  EXPECT_EQ(texelAt(mapOf(database), column, row), patterned(4, 6));
}

TEST(BuildColor, a_texel_size_overrides_the_images) {
  const TemporaryDirectory folder;
  ColorBuildOptions options = ofImages({makeImage(folder, overGrid(4, patterned), "image.tif")});
  options.texel = PostSpacing{30, true};
  EXPECT_EQ(mapOf(opened(withMap(options))).treeOf(0)->finest_level, 1);
  options.texel = PostSpacing{20, true};
  EXPECT_EQ(mapOf(opened(withMap(options))).treeOf(0)->finest_level, 0);
  // A cell is 925 m from south to north.
  options.texel = PostSpacing{460, false};
  EXPECT_EQ(mapOf(opened(withMap(options))).treeOf(0)->finest_level, -1);
}

// Draws a disc of light, in the image's own coordinates, and finds it again among the texels.
struct Disc {
  std::string crs;
  double pixel = 0, east = 0, north = 0;  // units of `crs`
  double angle = 0;                       // by which the image is turned
};

std::array<double, 2> centroidOfDisc(const Disc& disc, const RawGrid& grid, double& texel) {
  const TemporaryDirectory folder;
  TestImage image;
  image.crs = disc.crs;
  image.columns = image.rows = 400;
  const double c = std::cos(disc.angle) * disc.pixel, s = std::sin(disc.angle) * disc.pixel;
  // Pixel (203.3, 190.6) lies on the place.
  constexpr double kColumn = 203.3, kRow = 190.6;
  image.transform = {disc.east - kColumn * c - kRow * s, c, s, disc.north - kColumn * s + kRow * c, s, -c};
  image.color = [](int column, int row) {
    const double x = column + 0.5 - kColumn, y = row + 0.5 - kRow;
    const double light = std::exp(-(x * x + y * y) / 8);
    const std::uint8_t code = encodeSrgb(light);
    return Code{code, code, code, 255};
  };
  const MemoryFileSystem files = withMap(ofImages({makeImage(folder, image, "disc.tif")}), grid);
  const Database database = opened(files);
  const ColorTree& tree = *mapOf(database).treeOf(0);
  texel = colorTexelCells(grid.header.leaf_cells, tree.finest_level);
  double sum = 0, x = 0, y = 0;
  for (std::uint32_t number = 1; number <= mapOf(database).directory().node_count; ++number) {
    const ColorNode node = mapOf(database).record(number).value();
    if (node.level != tree.finest_level) continue;
    const auto tile = mapOf(database).tile(node).value();
    for (int j = 0; j < 128; ++j) {
      for (int i = 0; i < 128; ++i) {
        const auto k = static_cast<std::size_t>((j + 1) * kColorTileSide + i + 1) * 4;
        const double light = decodeSrgb(tile[k]);
        sum += light;
        x += light * (128.0 * node.x + i + 0.5) * texel;
        y += light * (128.0 * node.y + j + 0.5) * texel;
      }
    }
  }
  return {x / sum, y / sum};
}

TEST(BuildColor, a_place_in_an_image_is_found_there_whatever_its_system) {
  const RawGrid grid = syntheticGrid();
  const double longitude = -79.5123, latitude = 43.4567;
  const double column = static_cast<double>(grid.header.x_axis.first) + (longitude - kWest) / kSpacing,
               row = static_cast<double>(grid.header.y_axis.first) + (latitude - kSouth) / kSpacing;
  OGRSpatialReference geographic;
  geographic.SetFromUserInput("EPSG:4326");
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  for (const std::string crs : {"EPSG:4326", "EPSG:32617", "EPSG:3857", "EPSG:3978"}) {
    for (const double angle : {0.0, 0.5}) {
      OGRSpatialReference reference;
      reference.SetFromUserInput(crs.c_str());
      reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      const std::unique_ptr<OGRCoordinateTransformation> change(
          OGRCreateCoordinateTransformation(&geographic, &reference));
      Disc disc{crs, crs == "EPSG:4326" ? 0.0012 : 130, longitude, latitude, angle};
      ASSERT_TRUE(change->Transform(1, &disc.east, &disc.north));
      double texel = 0;
      const auto found = centroidOfDisc(disc, grid, texel);
      EXPECT_NEAR(found[0], column, 0.25 * texel) << crs << " " << angle;
      EXPECT_NEAR(found[1], row, 0.25 * texel) << crs << " " << angle;
    }
  }
}

TEST(BuildColor, a_place_is_found_on_a_projected_grid) {
  RawGrid grid = projectedGrid();
  // A place of the grid in UTM, looked for in an image in degrees.
  OGRSpatialReference utm, geographic;
  utm.SetFromUserInput("EPSG:32617");
  char* wkt = nullptr;
  utm.exportToWkt(&wkt);
  grid.header.crs_wkt = wkt;
  CPLFree(wkt);
  geographic.SetFromUserInput("EPSG:4326");
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const double easting = 501234.5, northing = 4801987.25;
  Disc disc{"EPSG:4326", 0.00006, easting, northing, 0};
  const std::unique_ptr<OGRCoordinateTransformation> change(
      OGRCreateCoordinateTransformation(&utm, &geographic));
  ASSERT_TRUE(change->Transform(1, &disc.east, &disc.north));
  double texel = 0;
  const auto found = centroidOfDisc(disc, grid, texel);
  const GridAxis &x = grid.header.x_axis, &y = grid.header.y_axis;
  EXPECT_NEAR((found[0] + x.phase) * x.spacing, easting, 0.25 * texel * x.spacing);
  EXPECT_NEAR((found[1] + y.phase) * y.spacing, northing, 0.25 * texel * y.spacing);
}

std::string wktOf(const std::string& crs) {
  OGRSpatialReference reference;
  reference.SetFromUserInput(crs.c_str());
  char* wkt = nullptr;
  reference.exportToWkt(&wkt);
  std::string text = wkt;
  CPLFree(wkt);
  return text;
}

TEST(BuildColor, an_image_in_degrees_ends_where_all_its_meridians_meet) {
  const TemporaryDirectory folder;
  // 121 x 121 posts of 1 km around the pole.
  RawGrid grid = projectedGrid({.easting = -60000, .northing = -60000, .spacing = 1000});
  grid.header.crs_wkt = wktOf("EPSG:3413");
  TestImage image;
  image.columns = 720;
  image.rows = 30;
  image.transform = {-180, 0.5, 0, 90, 0, -0.5};
  image.color = [](int column, int) { return Code{static_cast<std::uint8_t>(column / 4), 90, 30, 255}; };
  const Database database = opened(withMap(ofImages({makeImage(folder, image, "pole.tif")}), grid));
  // A 16th of half a degree of latitude is 3.5 km.
  EXPECT_EQ(mapOf(database).treeOf(0)->finest_level, 2);
  for (const double column : {-50.0, -3.0, 0.5, 40.0}) {
    for (const double row : {-50.0, -3.0, 0.5, 40.0})
      EXPECT_EQ(texelAt(mapOf(database), column, row)[3], 255) << column << " " << row;
  }
}

TEST(BuildColor, a_place_is_found_on_both_sides_of_the_antimeridian_in_an_image_across_it) {
  SyntheticGridOptions options;
  options.south = -16;
  options.west = 179.5;
  const RawGrid grid = syntheticGrid(options);
  constexpr double kEquatorialRadius = 6378137, kRadians = 3.14159265358979323846 / 180;
  const double latitude = -15.52;
  for (const double longitude : {179.99, 180.01, 180.2}) {
    Disc disc{"EPSG:3857", 130, kEquatorialRadius * longitude * kRadians,
              kEquatorialRadius * std::asinh(std::tan(latitude * kRadians)), 0};
    double texel = 0;
    const auto found = centroidOfDisc(disc, grid, texel);
    EXPECT_LE(texel, 0.5);
    EXPECT_NEAR(found[0],
                static_cast<double>(grid.header.x_axis.first) + (longitude - options.west) / kSpacing,
                0.25 * texel)
        << longitude;
    EXPECT_NEAR(found[1],
                static_cast<double>(grid.header.y_axis.first) + (latitude - options.south) / kSpacing,
                0.25 * texel)
        << longitude;
  }
}

TEST(BuildColor, mercators_image_is_no_finer_beyond_its_end_at_the_pole) {
  const TemporaryDirectory folder;
  SyntheticGridOptions options;
  options.south = 80;
  options.spacing_latitude = options.spacing_longitude = {300, 1};
  const RawGrid grid = syntheticGrid(options);  // to the pole
  TestImage image;
  constexpr double kHalfTurn = 20037508.342789244;
  image.crs = "EPSG:3857";
  image.columns = image.rows = 400;
  image.transform = {-kHalfTurn, kHalfTurn / 200, 0, kHalfTurn, 0, -kHalfTurn / 200};
  image.color = [](int, int) { return Code{10, 200, 30, 255}; };
  const Database database = opened(withMap(ofImages({makeImage(folder, image, "world.tif")}), grid));
  // At its end, 85.05 degrees, a pixel is 0.0777 degrees from south to north, 0.93 cells: a texel of level 0
  // is half a cell.
  EXPECT_GE(mapOf(database).treeOf(0)->finest_level, 0);
  const GridAxis &x = grid.header.x_axis, &y = grid.header.y_axis;
  EXPECT_EQ(texelAt(mapOf(database), static_cast<double>(x.first) + 50, static_cast<double>(y.first) + 55)[3],
            255);
  EXPECT_EQ(texelAt(mapOf(database), static_cast<double>(x.first) + 50, static_cast<double>(y.first) + 70)[3],
            0);
}

TEST(BuildColor, a_datum_nobody_knows_is_refused_until_a_guess_is_allowed) {
  const TemporaryDirectory folder;
  TestImage image = overGrid(1, patterned);
  image.crs = "+proj=longlat +ellps=bessel +type=crs";
  ColorBuildOptions options = ofImages({makeImage(folder, image, "image.tif")});
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  const auto refused = buildColor(files, kMemoryDatabasePath, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message().find("--allow-ballpark"), std::string::npos);
  EXPECT_LT(refused.error().message().size(), 400u) << refused.error().message();
  options.allow_ballpark = true;
  std::vector<std::string> warnings;
  (void)withMap(options, syntheticGrid(), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("guess"), std::string::npos) << warnings[0];
}

TEST(BuildColor, absurdly_small_texels_are_refused_and_needlessly_small_ones_told) {
  const TemporaryDirectory folder;
  ColorBuildOptions options = ofImages({makeImage(folder, overGrid(1, patterned), "image.tif")});
  for (const double arc_seconds : {0.001, 1e-9}) {
    options.texel = PostSpacing{arc_seconds, true};
    MemoryFileSystem files = buildInMemory(syntheticGrid());
    const auto refused = buildColor(files, kMemoryDatabasePath, options);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
    EXPECT_NE(refused.error().message().find("a sixteenth"), std::string::npos) << refused.error().message();
  }
  for (const auto& [arc_seconds, told] : {std::pair(15.0, 0u), std::pair(7.5, 1u), std::pair(60.0, 0u)}) {
    options.texel = PostSpacing{arc_seconds, true};
    std::vector<std::string> warnings;
    (void)withMap(options, syntheticGrid(), &warnings);
    EXPECT_EQ(warnings.size(), told) << arc_seconds;
  }
}

TEST(BuildColor, a_size_in_metres_is_met_whatever_the_projections_scale) {
  RawGrid grid = projectedGrid();  // cells of 30 m, of 30.012 m on the ground
  ColorBuildOptions options;
  options.name = "natural";
  options.synthetic = "natural";
  for (const auto& [metres, level] :
       {std::pair(30.0, 1), std::pair(15.0, 0), std::pair(29.0, 0), std::pair(61.0, 2)}) {
    options.texel = PostSpacing{metres, false};
    EXPECT_EQ(mapOf(opened(withMap(options, grid))).treeOf(0)->finest_level, level) << metres;
  }
}

TEST(BuildColor, opacity_nodata_and_the_images_edge_bound_the_cover) {
  const TemporaryDirectory folder;
  TestImage image = overGrid(2, [](int column, int row) {
    const auto alpha = static_cast<std::uint8_t>(column < 80 ? 0 : column < 160 ? 100 : 255);
    return Code{static_cast<std::uint8_t>(row < 120 ? 0 : 60), 80, 200, alpha};
  });
  image.bands = 4;
  image.columns = 200;  // the easternmost 20 cells have no image
  const MemoryFileSystem files = withMap(ofImages({makeImage(folder, image, "image.tif")}));
  const Database database = opened(files);
  const GridHeader& grid = database.area().grids[0];
  const auto at = [&](double column, double row) {
    return texelAt(mapOf(database), static_cast<double>(grid.x_axis.first) + column,
                   static_cast<double>(grid.y_axis.first) + row);
  };
  EXPECT_EQ(at(20.2, 30.2), (Code{0, 0, 0, 0}));
  EXPECT_EQ(at(60.2, 30.2), (Code{60, 80, 200, 100}));
  EXPECT_EQ(at(60.2, 100.2), (Code{0, 80, 200, 100}));
  EXPECT_EQ(at(90.2, 30.2), (Code{60, 80, 200, 255}));
  EXPECT_EQ(at(99.9, 30.2)[3], 255);
  EXPECT_EQ(at(100.1, 30.2)[3], 0);
}

TEST(BuildColor, classes_are_never_blended) {
  const TemporaryDirectory folder;
  TestImage image = overGrid(3, [](int column, int row) {
    return Code{static_cast<std::uint8_t>(((column * 7 + row * 13) % 5) * 40), 0, 0, 0};
  });
  image.bands = 1;
  const std::string legend = folder.file("legend.txt");
  std::ofstream(legend)
      << "# five\n0 10 20 30 water\n40, 40, 50, 60, 255, forest\n80\t70 80 90\n160 100 110 120\n";
  ColorBuildOptions options;
  options.name = "land";
  options.classes = makeImage(folder, image, "classes.tif");
  options.legend = legend;
  std::vector<std::string> warnings;
  const MemoryFileSystem files = withMap(options, syntheticGrid(), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings.front().find("classes 120;"), std::string::npos) << warnings.front();
  const Database database = opened(files);
  const GridHeader& grid = database.area().grids[0];
  const std::vector<Code> known = {
      {10, 20, 30, 255}, {40, 50, 60, 255}, {70, 80, 90, 255}, {100, 110, 120, 255}, {}};
  std::set<Code> seen;
  for (double column = 0.3; column < 120; column += 1.7) {
    for (double row = 0.3; row < 120; row += 1.7) {
      const Code code = texelAt(mapOf(database), static_cast<double>(grid.x_axis.first) + column,
                                static_cast<double>(grid.y_axis.first) + row);
      ASSERT_NE(std::find(known.begin(), known.end(), code), known.end()) << column << " " << row;
      seen.insert(code);
    }
  }
  EXPECT_EQ(seen.size(), known.size());
}

TEST(BuildColor, a_ramp_colours_by_height) {
  const TemporaryDirectory folder;
  ColorBuildOptions options;
  options.name = "ramp";
  options.ramp = folder.file("ramp.txt");
  std::ofstream(options.ramp) << "0% 0 0 0\n100% 255 255 255\nnv 9 9 9 0\n";
  const RawGrid grid = syntheticGrid();
  const Database database = opened(withMap(options, grid));
  EXPECT_EQ(mapOf(database).treeOf(0)->finest_level, 1);
  const double low = database.area().lowest_height, high = database.area().highest_height;
  for (std::int64_t c = 0; c < 120; c += 3) {
    for (std::int64_t r = 0; r < 120; r += 3) {
      const double mean = 0.25 * (grid.height(c, r) + grid.height(c + 1, r) + grid.height(c, r + 1) +
                                  grid.height(c + 1, r + 1));
      const Code code = texelAt(mapOf(database), static_cast<double>(grid.header.x_axis.first + c) + 0.5,
                                static_cast<double>(grid.header.y_axis.first + r) + 0.5);
      ASSERT_NEAR(code[0], 255 * (mean - low) / (high - low), 0.51) << c << " " << r;
      ASSERT_EQ(code[3], 255);
    }
  }
}

TEST(BuildColor, rules_leave_voids_without_cover) {
  SyntheticGridOptions hole;
  hole.voids = VoidPattern::kHole;
  ColorBuildOptions options;
  options.name = "winter";
  options.synthetic = "winter";
  const Database database = opened(withMap(options, syntheticGrid(hole)));
  const GridHeader& grid = database.area().grids[0];
  EXPECT_EQ(texelAt(mapOf(database), static_cast<double>(grid.x_axis.first) + 60.5,
                    static_cast<double>(grid.y_axis.first) + 60.5),
            Code{});
  EXPECT_EQ(texelAt(mapOf(database), static_cast<double>(grid.x_axis.first) + 5.5,
                    static_cast<double>(grid.y_axis.first) + 5.5)[3],
            255);
}

TEST(BuildColor, the_bytes_do_not_depend_on_threads) {
  const TemporaryDirectory folder;
  ColorBuildOptions options = ofImages({makeImage(folder, overGrid(8, patterned), "image.tif")});
  options.threads = 1;
  const MemoryFileSystem one = withMap(options);
  options.threads = 0;
  const MemoryFileSystem all = withMap(options);
  ASSERT_EQ(one.paths(), all.paths());
  for (const std::string& path : one.paths()) EXPECT_EQ(one.bytes(path), all.bytes(path)) << path;
}

}  // namespace
}  // namespace deltaz
