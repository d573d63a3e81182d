#include "librender/raster/texture_sampler.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "tests/librender/textured_area.h"

namespace deltaz {
namespace {

constexpr int kLeafCells = 16;

ColorTree treeOfLevels(int finest, int coarsest) {
  ColorTree tree;
  tree.finest_level = static_cast<std::int8_t>(finest);
  tree.coarsest_level = static_cast<std::int8_t>(coarsest);
  return tree;
}

TEST(MipLevels, are_the_two_around_the_pixels_size_and_linear_in_it) {
  const double texel = colorTexelCells(kLeafCells, 0);
  struct Case {
    double size;  // in texels of level 0
    int level;
    double t;
  };
  // The report's example: a size of 3.5 lies three quarters of the way from the maps of 2 to those of 4.
  for (const Case& expected : {Case{1, 0, 0}, Case{1.5, 0, 0.5}, Case{2, 1, 0}, Case{3.5, 1, 0.75},
                               Case{0.75, -1, 0.5}, Case{0.25, -2, 0}, Case{6, 2, 0.5}}) {
    const MipLevels levels = mipLevels(expected.size * texel, kLeafCells, treeOfLevels(-2, 4));
    EXPECT_EQ(levels.level, expected.level) << expected.size;
    EXPECT_DOUBLE_EQ(levels.t, expected.t) << expected.size;
  }
}

TEST(MipLevels, stay_within_the_map) {
  const double texel = colorTexelCells(kLeafCells, 0);
  const ColorTree tree = treeOfLevels(-1, 2);
  for (const double size : {0.0, 1e-300, 0.1, 0.4999}) {
    EXPECT_EQ(mipLevels(size * texel, kLeafCells, tree).level, -1) << size;
    EXPECT_EQ(mipLevels(size * texel, kLeafCells, tree).t, 0) << size;
  }
  for (const double size : {4.0, 7.5, 1e300, HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(mipLevels(size * texel, kLeafCells, tree).level, 2) << size;
    EXPECT_EQ(mipLevels(size * texel, kLeafCells, tree).t, 0) << size;
  }
}

TextureTile tileOf(const std::function<std::array<std::uint8_t, 4>(int, int)>& texel) {
  TextureTile tile;
  tile.square = {0, 1, 3, -2};
  tile.leaf_cells = kLeafCells;
  for (int j = -1; j <= kColorTileTexels; ++j) {
    for (int i = -1; i <= kColorTileTexels; ++i) {
      for (const std::uint8_t code : texel(i, j)) tile.texels.push_back(code);
    }
  }
  return tile;
}

// The place of a position in texels of that tile.
GridCoordinates placeIn(const TextureTile& tile, double x, double y) {
  const double texel = colorTexelCells(kLeafCells, tile.square.level);
  return {(tile.square.x * kColorTileTexels + x) * texel, (tile.square.y * kColorTileTexels + y) * texel};
}

TEST(BilinearSample, gives_texels_at_their_centres_border_included) {
  const TextureTile tile = tileOf([](int i, int j) {
    return std::array<std::uint8_t, 4>{static_cast<std::uint8_t>(i + 1), static_cast<std::uint8_t>(j + 1), 9,
                                       255};
  });
  for (const int i : {0, 1, 64, kColorTileTexels - 1}) {
    for (const int j : {0, 77, kColorTileTexels - 1}) {
      const TextureSample sample = bilinearSample(tile, placeIn(tile, i + 0.5, j + 0.5));
      EXPECT_DOUBLE_EQ(sample.color.red, decodeSrgb(static_cast<std::uint8_t>(i + 1)));
      EXPECT_DOUBLE_EQ(sample.color.green, decodeSrgb(static_cast<std::uint8_t>(j + 1)));
      EXPECT_DOUBLE_EQ(sample.color.blue, decodeSrgb(9));
      EXPECT_DOUBLE_EQ(sample.cover, 1);
    }
  }
  // On the node's own west border half of the neighbour's texel is seen.
  const TextureSample west = bilinearSample(tile, placeIn(tile, 0, 10.5));
  EXPECT_DOUBLE_EQ(west.color.red, (decodeSrgb(0) + decodeSrgb(1)) / 2);
  const TextureSample north_east = bilinearSample(tile, placeIn(tile, kColorTileTexels, kColorTileTexels));
  EXPECT_DOUBLE_EQ(north_east.color.red,
                   (decodeSrgb(kColorTileTexels) + decodeSrgb(kColorTileTexels + 1)) / 2);
}

// Cover is linear in its code, so a ramp of it must come back exactly anywhere.
TEST(BilinearSample, reproduces_a_linear_ramp_without_an_offset) {
  const TextureTile tile = tileOf([](int i, int) {
    return std::array<std::uint8_t, 4>{0, 0, 0, static_cast<std::uint8_t>(i + 1)};
  });
  for (double x = 0; x <= kColorTileTexels; x += 0.37)
    EXPECT_NEAR(bilinearSample(tile, placeIn(tile, x, 40)).cover, (x + 0.5) / 255.0, 1e-14);
}

TEST(BilinearSample, mixes_linear_light_in_proportion_to_cover) {
  const TextureTile tile = tileOf([](int i, int) {
    return i % 2 == 0 ? std::array<std::uint8_t, 4>{200, 100, 50, 255}
                      : std::array<std::uint8_t, 4>{255, 255, 255, 0};
  });
  const TextureSample sample = bilinearSample(tile, placeIn(tile, 11, 20));
  EXPECT_DOUBLE_EQ(sample.cover, 0.5);
  EXPECT_DOUBLE_EQ(sample.color.red / sample.cover, decodeSrgb(200));
  EXPECT_DOUBLE_EQ(sample.color.blue / sample.cover, decodeSrgb(50));
}

class TexturedSquares : public ::testing::Test {
 protected:
  TextureFootprint at(double column, double row, double texels) const {
    const double size = texels * colorTexelCells(kLeafCells, kFinest);
    return {{column, row}, {size, 0}, {0, size / 2}};
  }
  TextureSample sample(const ColorMap& map, const TextureFootprint& footprint) {
    const std::optional<TextureRequest> request = textureRequest(map, 0, footprint);
    EXPECT_TRUE(request.has_value());
    TextureStore store(&map);
    TextureReader reader(store);
    const TextureSample sample = trilinearSample(reader, *request);
    EXPECT_TRUE(store.status().ok());
    return sample;
  }
  static constexpr int kFinest = 1;
};

TEST_F(TexturedSquares, are_mixed_linearly_in_the_pixels_size) {
  // A board of white and black texels: every coarser texel is half as bright.
  const double texel = colorTexelCells(kLeafCells, kFinest);
  const MemoryDatabase area =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, kFinest, [&](auto, double c, double r) {
        const bool white =
            (static_cast<std::int64_t>(c / texel) + static_cast<std::int64_t>(r / texel)) % 2 == 0;
        const auto code = static_cast<std::uint8_t>(white ? 255 : 0);
        return std::array<std::uint8_t, 4>{code, code, code, 255};
      });
  const ColorMap& map = area.database.colorMaps().front();
  const GridHeader& header = area.database.grid(0).header();
  // The middle of a white texel in the middle of the area.
  const double column =
      (std::floor(static_cast<double>(header.x_axis.first + 60) / texel / 2) * 2 + 0.5) * texel;
  const double row =
      (std::floor(static_cast<double>(header.y_axis.first + 60) / texel / 2) * 2 + 0.5) * texel;
  const double grey = decodeSrgb(encodeSrgb(0.5));
  for (const double size : {0.1, 1.0, 1.25, 1.5, 1.75}) {
    const double t = std::max(0.0, size - 1);
    EXPECT_NEAR(sample(map, at(column, row, size)).color.green, 1 - t + t * grey, 1e-12) << size;
  }
  EXPECT_NEAR(sample(map, at(column, row, 2.7)).color.green, grey, 0.01);
}

TEST_F(TexturedSquares, without_a_tile_of_their_own_are_served_by_a_coarser_one) {
  const GridHeader header = syntheticGrid(smallArea()).header;
  // Colours in the west only.
  const double middle = static_cast<double>(header.x_axis.first) + 40;
  const MemoryDatabase area =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, kFinest, [&](auto, double c, double) {
        return c < middle ? std::array<std::uint8_t, 4>{10, 200, 30, 255} : std::array<std::uint8_t, 4>{};
      });
  const ColorMap& map = area.database.colorMaps().front();
  const double row = static_cast<double>(header.y_axis.first) + 60.3;
  const TextureSample west = sample(map, at(middle - 20, row, 0.7));
  EXPECT_NEAR(west.color.green, decodeSrgb(200), 1e-12);
  EXPECT_NEAR(west.cover, 1, 1e-12);
  for (const double size : {0.7, 1.4, 3.3})
    EXPECT_EQ(sample(map, at(middle + 60, row, size)).cover, 0) << size;
  // Whatever level is asked for, the tile that is found holds the place.
  for (int level = -6; level <= 6; ++level) {
    const TextureSquare square{0, static_cast<std::int8_t>(level),
                               colorNodeAt(middle - 20, kLeafCells, level),
                               colorNodeAt(row, kLeafCells, level)};
    TextureStore store(&map);
    const TextureTile* const tile = store.find(square);
    ASSERT_TRUE(store.status().ok());
    ASSERT_NE(tile, nullptr);
    const int found = tile->square.level;
    EXPECT_GE(found, std::min<int>(level, map.treeOf(0)->coarsest_level));
    EXPECT_EQ(tile->square.x, colorNodeAt(middle - 20, kLeafCells, found));
    EXPECT_EQ(tile->square.y, colorNodeAt(row, kLeafCells, found));
  }
}

TEST_F(TexturedSquares, are_read_once_whatever_the_order_they_are_asked_in) {
  const MemoryDatabase area =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, kFinest, [](auto, double, double) {
        return std::array<std::uint8_t, 4>{90, 90, 90, 255};
      });
  const ColorMap& map = area.database.colorMaps().front();
  const GridHeader& header = area.database.grid(0).header();
  std::vector<TextureSquare> squares;
  for (int n = 0; n < 400; ++n) {
    const double column = static_cast<double>(header.x_axis.first) + (n * 37) % 120;
    const double row = static_cast<double>(header.y_axis.first) + (n * 11) % 120;
    squares.push_back(
        {0, kFinest, colorNodeAt(column, kLeafCells, kFinest), colorNodeAt(row, kLeafCells, kFinest)});
  }
  const std::uint64_t before = area.database.bytesRead();
  TextureStore store(&map);
  for (const TextureSquare& square : squares) EXPECT_NE(store.find(square), nullptr);
  ASSERT_TRUE(store.status().ok());
  std::vector<TextureSquare> unique = squares;
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  EXPECT_EQ(store.tileCount(), unique.size());
  EXPECT_LT(unique.size(), squares.size());
  EXPECT_GT(area.database.bytesRead(), before);
  EXPECT_EQ(store.find({0, kFinest, unique.front().x - 100, 0}), nullptr);
}

TEST_F(TexturedSquares, are_not_asked_for_where_the_place_is_not_known) {
  const MemoryDatabase area =
      makeTexturedDatabase({syntheticGrid(smallArea())}, kLeafCells, kFinest, [](auto, double, double) {
        return std::array<std::uint8_t, 4>{90, 90, 90, 255};
      });
  const ColorMap& map = area.database.colorMaps().front();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(textureRequest(map, 0, at(unknown, 5, 1)).has_value());
  EXPECT_FALSE(textureRequest(map, 0, at(5, unknown, 1)).has_value());
  EXPECT_TRUE(textureRequest(map, 0, at(5, 5, unknown)).has_value());
}

}  // namespace
}  // namespace deltaz
