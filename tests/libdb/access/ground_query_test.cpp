#include "libdb/access/ground_query.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

constexpr double kMicrometre = 1e-6;

// A database of `grid`, kept together with the file system it is read from.
class GroundQuery : public testing::Test {
 protected:
  void build(const SyntheticGridOptions& options) {
    grid_ = syntheticGrid(options);
    BuildOptions build_options;
    build_options.leaf_cells = 16;
    files_ = std::make_unique<MemoryFileSystem>(buildInMemory(grid_, build_options));
    database_ = std::make_unique<Database>(Database::open(*files_, kMemoryDatabasePath).value());
  }
  std::optional<double> ground(double latitude, double longitude) const {
    return groundHeight(*database_, latitude, longitude).value();
  }
  double metres(std::int64_t column, std::int64_t row) const {
    return grid_.header.quantum.value() * grid_.height(column, row);
  }

  RawGrid grid_;
  std::unique_ptr<MemoryFileSystem> files_;
  std::unique_ptr<Database> database_;
};

SyntheticGridOptions smallGrid() {
  SyntheticGridOptions options;
  options.columns = 50;
  options.rows = 40;
  return options;
}

TEST_F(GroundQuery, at_a_post_it_is_the_height_of_the_post) {
  build(smallGrid());
  const GridGeometry& geometry = database_->grid(0);
  for (std::int64_t row = 0; row < 40; row += 3) {
    for (std::int64_t column = 0; column < 50; column += 7) {
      const auto height = ground(geometry.latitude(grid_.header.y_axis.first + row),
                                 geometry.longitude(grid_.header.x_axis.first + column));
      ASSERT_TRUE(height) << column << " " << row;
      EXPECT_NEAR(*height, metres(column, row), kMicrometre);
    }
  }
}

TEST_F(GroundQuery, between_posts_it_lies_on_the_facet_and_below_its_chord) {
  build(smallGrid());
  const GridGeometry& geometry = database_->grid(0);
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const std::int64_t column = random() % 49, row = random() % 39;
    const double x = static_cast<double>(random() % 1000) / 1000,
                 y = static_cast<double>(random() % 1000) / 1000;
    const auto between = [](double a, double b, double t) { return a + (b - a) * t; };
    const double longitude = between(geometry.longitude(grid_.header.x_axis.first + column),
                                     geometry.longitude(grid_.header.x_axis.first + column + 1), x);
    const double latitude = between(geometry.latitude(grid_.header.y_axis.first + row),
                                    geometry.latitude(grid_.header.y_axis.first + row + 1), y);
    const double linear = x >= y ? metres(column, row) + x * (metres(column + 1, row) - metres(column, row)) +
                                       y * (metres(column + 1, row + 1) - metres(column + 1, row))
                                 : metres(column, row) + y * (metres(column, row + 1) - metres(column, row)) +
                                       x * (metres(column + 1, row + 1) - metres(column, row + 1));
    const auto height = ground(latitude, longitude);
    ASSERT_TRUE(height);
    // 30 arc-seconds are 930 m: a chord sags by up to 930^2 / (8 x 6.37e6) m = 17 mm on a side, 34 on the
    // diagonal; and where the facet is steep, the normal meets it a little beside its place in degrees.
    EXPECT_NEAR(*height, linear, 0.06 + 1e-4 * std::abs(metres(column + 1, row + 1) - metres(column, row)));
  }
}

TEST_F(GroundQuery, there_is_no_ground_outside_and_at_voids) {
  SyntheticGridOptions options = smallGrid();
  options.voids = VoidPattern::kWestHalf;
  build(options);
  const AreaHeader& area = database_->area();
  const double middle = (area.south + area.north) / 2;
  EXPECT_FALSE(ground(middle, area.west + 0.01));
  EXPECT_TRUE(ground(middle, area.east - 0.01));
  EXPECT_FALSE(ground(area.north + 0.01, area.east - 0.01));
  EXPECT_FALSE(ground(middle, area.east + 0.01));
  EXPECT_FALSE(ground(std::nan(""), middle));
}

TEST_F(GroundQuery, the_outermost_posts_belong_to_the_area) {
  build(smallGrid());
  const AreaHeader& area = database_->area();
  for (const double latitude : {area.south, area.north}) {
    for (const double longitude : {area.west, area.east}) EXPECT_TRUE(ground(latitude, longitude));
  }
}

TEST_F(GroundQuery, a_full_turn_of_longitude_changes_nothing) {
  SyntheticGridOptions options = smallGrid();
  options.west = 179.8;
  build(options);
  const double latitude = (database_->area().south + database_->area().north) / 2;
  const auto east_of_it = ground(latitude, 180.05);
  ASSERT_TRUE(east_of_it);
  EXPECT_NEAR(*ground(latitude, -179.95), *east_of_it, kMicrometre);
}

}  // namespace
}  // namespace deltaz
