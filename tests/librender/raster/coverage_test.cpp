#include "librender/raster/coverage.h"

#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <random>
#include <rapidcheck.h>
#include <utility>
#include <vector>

namespace deltaz {
namespace {

constexpr int kWidth = 96, kHeight = 64;

SnappedTriangle triangleOf(std::array<std::array<double, 2>, 3> corners) {
  SnappedTriangle t;
  for (std::size_t k = 0; k < 3; ++k) {
    t.x[k] = snap(corners[k][0]);
    t.y[k] = snap(corners[k][1]);
  }
  if (doubledArea(t) < 0) {
    std::swap(t.x[1], t.x[2]);
    std::swap(t.y[1], t.y[2]);
  }
  return t;
}

class Stencil {
 public:
  void draw(const SnappedTriangle& t) {
    if (doubledArea(t) <= 0) return;
    forEachSample(t, sampleBounds(t, kWidth, kHeight), [&](std::int32_t j, std::int32_t i) {
      ++count_[static_cast<std::size_t>(i * kWidth + j)];
    });
  }
  int at(int j, int i) const { return count_[static_cast<std::size_t>(i * kWidth + j)]; }

 private:
  std::vector<int> count_ = std::vector<int>(kWidth * kHeight, 0);
};

TEST(Coverage, positions_are_rounded_to_the_nearest_256th) {
  EXPECT_EQ(snap(1.0), 256);
  EXPECT_EQ(snap(1.0 + 0.4 / 256), 256);
  EXPECT_EQ(snap(1.0 + 0.6 / 256), 257);
  EXPECT_EQ(snap(-1.0 - 0.6 / 256), -257);
  EXPECT_EQ(snap(16384.0), 16384 * 256);
}

// A square whose edges run through pixel centres: left and top edges keep them, right and bottom ones do not.
TEST(Coverage, samples_on_left_and_top_edges_belong_to_the_triangle) {
  Stencil stencil;
  stencil.draw(triangleOf({{{10, 10}, {20, 10}, {20, 20}}}));
  stencil.draw(triangleOf({{{10, 10}, {20, 20}, {10, 20}}}));
  for (int i = 0; i < kHeight; ++i) {
    for (int j = 0; j < kWidth; ++j) {
      EXPECT_EQ(stencil.at(j, i), j >= 10 && j < 20 && i >= 10 && i < 20 ? 1 : 0) << j << " " << i;
    }
  }
}

// Meshes of random triangles over a fixed outline: every sample inside is covered exactly once. Inner
// vertices are moved at random, on sub-pixel positions, on pixel centres and on halves.
TEST(Coverage, a_mesh_covers_every_sample_exactly_once) {
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    constexpr int kCells = 12;
    const double cell_x = 80.0 / kCells, cell_y = 48.0 / kCells;
    const int kind = round % 4;
    std::array<std::array<std::array<double, 2>, kCells + 1>, kCells + 1> mesh{};
    for (int y = 0; y <= kCells; ++y) {
      for (int x = 0; x <= kCells; ++x) {
        double px = 8 + x * cell_x, py = 8 + y * cell_y;
        if (x > 0 && y > 0 && x < kCells && y < kCells) {
          // Moved by less than what could fold a triangle over.
          std::uniform_real_distribution<double> move(-0.24, 0.24);
          px += move(random) * cell_x;
          py += move(random) * cell_y;
          if (kind == 1) px = std::round(px), py = std::round(py);
          if (kind == 2) px = std::round(px * 2) / 2, py = std::round(py * 2) / 2;
          if (kind == 3) px = std::round(px), py = py + move(random) / 64;
        }
        mesh[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] = {px, py};
      }
    }
    Stencil stencil;
    for (std::size_t y = 0; y < kCells; ++y) {
      for (std::size_t x = 0; x < kCells; ++x) {
        const auto a = mesh[y][x], b = mesh[y][x + 1], c = mesh[y + 1][x + 1], d = mesh[y + 1][x];
        if (random() % 2 == 0) {
          stencil.draw(triangleOf({{a, b, c}}));
          stencil.draw(triangleOf({{a, c, d}}));
        } else {
          stencil.draw(triangleOf({{a, b, d}}));
          stencil.draw(triangleOf({{b, c, d}}));
        }
      }
    }
    for (int i = 0; i < kHeight; ++i) {
      for (int j = 0; j < kWidth; ++j) {
        ASSERT_EQ(stencil.at(j, i), j >= 8 && j < 88 && i >= 8 && i < 56 ? 1 : 0)
            << "round " << round << ", " << j << " " << i;
      }
    }
  }
}

// Thin fans around a vertex at a pixel centre or near one: no sample twice, none lost, whatever the slopes.
TEST(Coverage, a_fan_covers_every_sample_exactly_once) {
  EXPECT_TRUE(rc::check([] {
    const int spokes = *rc::gen::inRange(3, 200);
    const double centre_x = *rc::gen::inRange(40 * 256, 56 * 256) / 256.0;
    const double centre_y = *rc::gen::inRange(24 * 256, 40 * 256) / 256.0;
    std::vector<std::array<double, 2>> rim;
    // Points on a rectangle, in order around it.
    for (int k = 0; k < spokes; ++k) {
      const double along = 4.0 * k / spokes;
      const int side = static_cast<int>(along);
      const double t = along - side;
      rim.push_back(side == 0   ? std::array<double, 2>{8 + 80 * t, 8}
                    : side == 1 ? std::array<double, 2>{88, 8 + 48 * t}
                    : side == 2 ? std::array<double, 2>{88 - 80 * t, 56}
                                : std::array<double, 2>{8, 56 - 48 * t});
    }
    for (const std::array<double, 2> corner : {std::array<double, 2>{88, 8}, {88, 56}, {8, 56}}) {
      // Corners must be rim points, so that the outline is the rectangle.
      const double along = corner[1] == 8 ? 1 : corner[0] == 88 ? 2 : 3;
      std::size_t position = 0;
      while (position < rim.size()) {
        const auto& p = rim[position];
        const double at = p[1] == 8 && p[0] < 88 ? (p[0] - 8) / 80
                          : p[0] == 88           ? 1 + (p[1] - 8) / 48
                          : p[1] == 56           ? 2 + (88 - p[0]) / 80
                                                 : 3 + (56 - p[1]) / 48;
        if (at >= along) break;
        ++position;
      }
      if (position == rim.size() || rim[position] != corner)
        rim.insert(rim.begin() + static_cast<std::ptrdiff_t>(position), corner);
    }
    Stencil stencil;
    for (std::size_t k = 0; k < rim.size(); ++k)
      stencil.draw(triangleOf({{{centre_x, centre_y}, rim[k], rim[(k + 1) % rim.size()]}}));
    for (int i = 0; i < kHeight; ++i) {
      for (int j = 0; j < kWidth; ++j) {
        RC_ASSERT(stencil.at(j, i) == (j >= 8 && j < 88 && i >= 8 && i < 56 ? 1 : 0));
      }
    }
  }));
}

// Tiles: cutting the bounds into pieces changes nothing.
TEST(Coverage, bounds_cut_the_samples_and_nothing_else) {
  EXPECT_TRUE(rc::check([] {
    const auto coordinate = [](int limit) {
      return *rc::gen::inRange(-20 * 256, (limit + 20) * 256) / 256.0;
    };
    const SnappedTriangle t = triangleOf({{{coordinate(kWidth), coordinate(kHeight)},
                                           {coordinate(kWidth), coordinate(kHeight)},
                                           {coordinate(kWidth), coordinate(kHeight)}}});
    if (doubledArea(t) <= 0) return;
    Stencil whole;
    whole.draw(t);
    std::vector<int> pieces(kWidth * kHeight, 0);
    for (int top = 0; top < kHeight; top += 16) {
      for (int left = 0; left < kWidth; left += 32) {
        forEachSample(
            t, intersection(sampleBounds(t, kWidth, kHeight), {left, left + 31, top, top + 15}),
            [&](std::int32_t j, std::int32_t i) { ++pieces[static_cast<std::size_t>(i * kWidth + j)]; });
      }
    }
    for (int i = 0; i < kHeight; ++i) {
      for (int j = 0; j < kWidth; ++j)
        RC_ASSERT(pieces[static_cast<std::size_t>(i * kWidth + j)] == whole.at(j, i));
    }
  }));
}

// At the far ends of the guard band the products still fit.
TEST(Coverage, triangles_as_large_as_the_guard_band_are_exact) {
  const double far = 16384;
  Stencil stencil;
  stencil.draw(triangleOf({{{-far, -far}, {2 * far, -far}, {2 * far, 2 * far}}}));
  stencil.draw(triangleOf({{{-far, -far}, {2 * far, 2 * far}, {-far, 2 * far}}}));
  for (int i = 0; i < kHeight; ++i) {
    for (int j = 0; j < kWidth; ++j) EXPECT_EQ(stencil.at(j, i), 1);
  }
}

}  // namespace
}  // namespace deltaz
