#include "libdb/access/synthetic_color.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "libdb/access/vector_lists.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

LinearColor at(double height, double upness, double latitude = 46.85) {
  return naturalColor({height, upness, 0, snowLine(latitude)});
}

TEST(SyntheticColor, snow_line_is_high_in_the_tropics_and_at_sea_level_at_the_poles) {
  EXPECT_NEAR(snowLine(0), 4800, 1);
  EXPECT_NEAR(snowLine(46.85), 2400, 60);
  EXPECT_NEAR(snowLine(28), 5600, 1);
  EXPECT_NEAR(snowLine(90), 0, 1);
  EXPECT_EQ(snowLine(-46.85), snowLine(46.85));
  for (double latitude = 0; latitude < 90; latitude += 0.01) {
    EXPECT_NEAR(snowLine(latitude), snowLine(latitude + 0.01), 3) << latitude;
  }
}

TEST(SyntheticColor, summit_is_white_valley_is_green_cliff_is_grey) {
  const LinearColor summit = at(4000, 0.95), valley = at(900, 0.93), cliff = at(2000, 0.4);
  EXPECT_GT(summit.red, 0.65);
  EXPECT_GT(valley.green, 1.5 * valley.red);
  EXPECT_GT(valley.green, 2 * valley.blue);
  EXPECT_LT(std::abs(cliff.red - cliff.blue), 0.06);
}

TEST(SyntheticColor, has_no_steps) {
  for (const double upness : {0.5, 0.8, 0.99}) {
    for (double height = 10; height < 5000; height += 1) {
      EXPECT_NEAR(at(height, upness).green, at(height + 1, upness).green, 0.01) << height << " " << upness;
    }
  }
  for (const double height : {500.0, 1800.0, 2600.0, 4000.0}) {
    for (double upness = 0; upness < 0.999; upness += 0.001) {
      EXPECT_NEAR(at(height, upness).green, at(height, upness + 0.001).green, 0.03)
          << height << " " << upness;
    }
  }
}

TEST(SyntheticColor, winter_brings_snow_down_frosts_forest_and_freezes_water) {
  const auto winter = [](double height, double upness, double latitude) {
    return winterColor({height, upness, 0, snowLine(latitude)});
  };
  const double north = 46.85;
  // A mountain meadow is white, forest lighter than in summer and darker than open snow, a cliff stays bare.
  EXPECT_GT(winter(1900, 0.95, north).red, 0.6);
  EXPECT_GT(winter(1100, 0.93, north).red, 3 * at(1100, 0.93).red);
  EXPECT_LT(winter(1100, 0.93, north).red, 0.5);
  EXPECT_NEAR(winter(1900, 0.3, north).red, at(1900, 0.3).red, 1e-12);
  EXPECT_GT(winter(0, 1, 60).red, 0.3);
  // In the tropics only the peaks change.
  EXPECT_NEAR(winter(0, 1, 10).red, at(0, 1, 10).red, 1e-12);
  EXPECT_NEAR(winter(1500, 0.9, 10).green, at(1500, 0.9, 10).green, 1e-12);
}

TEST(SyntheticColor, winter_has_no_steps) {
  for (const double upness : {0.5, 0.8, 0.99}) {
    for (double height = 10; height < 5000; height += 1) {
      const SurfacePoint low{height, upness, 0, snowLine(46.85)},
          high{height + 1, upness, 0, snowLine(46.85)};
      EXPECT_NEAR(winterColor(low).green, winterColor(high).green, 0.01) << height << " " << upness;
    }
  }
}

TEST(SyntheticColor, lists_have_the_bits_of_single_points_on_every_instruction_set) {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967295.0);
  };
  constexpr std::size_t kMost = 5000;
  std::vector<double> height(kMost + kVectorPadding), upness(height), poleward(height), snow_line(height);
  for (std::size_t k = 0; k < kMost; ++k) {
    height[k] = random() % 8 == 0 ? between(-3, 3) : between(-400, 8800);
    upness[k] = random() % 4 == 0 ? between(0.9998, 1) : between(0, 1);
    poleward[k] = between(-1, 1);
    snow_line[k] = random() % 16 == 0 ? 0 : snowLine(between(-90, 90));
  }
  onEverySimdTarget([&] {
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{17}, kMost}) {
      std::vector<double> red(count + kVectorPadding), green(red), blue(red);
      naturalColors({height.data(), upness.data(), poleward.data(), snow_line.data()}, count,
                    {red.data(), green.data(), blue.data()});
      std::size_t different = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const LinearColor expected = naturalColor({height[k], upness[k], poleward[k], snow_line[k]});
        different += red[k] == expected.red && green[k] == expected.green && blue[k] == expected.blue ? 0 : 1;
      }
      EXPECT_EQ(different, 0U) << count;
    }
  });
}

}  // namespace
}  // namespace deltaz
