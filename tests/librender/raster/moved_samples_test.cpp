// The tests before set-up, where samples are moved from the pixels' centres: nothing that covers one may go.
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "librender/antialias/sample_pattern.h"
#include "librender/raster/coverage.h"
#include "librender/raster/grid_culler.h"
#include "librender/raster/triangle_placement.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

constexpr int kWidth = 130, kHeight = 70;  // of the sample grid: no multiples of tiles or blocks

// Calls visit(j, i) for every moved sample of the picture that the triangle covers.
template <typename Visit>
void forEachMovedSample(const SnappedTriangle& triangle, const SampleOffsets& offsets, Visit&& visit) {
  for (int cell = 0; cell < 16; ++cell) {
    SnappedTriangle seen = triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      seen.x[k] -= offsets.x[cell];
      seen.y[k] -= offsets.y[cell];
    }
    forEachSample(seen, sampleBounds(seen, kWidth, kHeight), [&](std::int32_t j, std::int32_t i) {
      if (i % 4 * 4 + j % 4 == cell) visit(j, i);
    });
  }
}

// Small ones, many of them at the borders of the picture and of tiles.
std::vector<SnappedTriangle> smallTriangles(std::size_t count) {
  std::mt19937 random(23);
  std::uniform_int_distribution<std::int32_t> size(-400, 400), x(-600, (kWidth + 2) * 256),
      y(-600, (kHeight + 2) * 256), near(-300, 300), border(0, 3);
  constexpr std::array<std::int32_t, 4> kBorders = {0, 64 * 256, 128 * 256, (kWidth - 1) * 256};
  std::vector<SnappedTriangle> triangles;
  while (triangles.size() < count) {
    SnappedTriangle triangle;
    const bool at_border = random() % 2 == 0;
    const std::int32_t at_x =
        at_border ? kBorders[static_cast<std::size_t>(border(random))] + near(random) : x(random);
    const std::int32_t at_y = y(random);
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.x[k] = at_x + size(random);
      triangle.y[k] = at_y + size(random);
    }
    if (doubledArea(triangle) < 0) {
      std::swap(triangle.x[1], triangle.x[2]);
      std::swap(triangle.y[1], triangle.y[2]);
    }
    if (doubledArea(triangle) > 0) triangles.push_back(triangle);
  }
  return triangles;
}

TEST(MovedSamples, keep_every_triangle_that_covers_one_in_the_tiles_it_covers) {
  const std::vector<SnappedTriangle> triangles = smallTriangles(20000);
  std::vector<std::int32_t> x, y;
  std::vector<std::uint32_t> words;
  for (const SnappedTriangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(x.size());
    // Counter-clockwise seen from the front.
    words.insert(words.end(), {first, first + 2, first + 1, 0});
    x.insert(x.end(), triangle.x.begin(), triangle.x.end());
    y.insert(y.end(), triangle.y.begin(), triangle.y.end());
  }
  for (const int count : {4, 16}) {
    const SampleOffsets& offsets = *sampleOffsets(count, SamplePattern::kRotated);
    onEverySimdTarget([&] {
      std::vector<std::uint32_t> face(triangles.size() + kRowPadding), tiles(face.size());
      CulledFaces kept{face.data(), tiles.data(), 0};
      CullCounts counts;
      cullCornerFaces({words.data(), triangles.size(), x.data(), y.data()}, kWidth, kHeight, kept, counts,
                      offsets.reach);
      std::vector<std::uint32_t> range(triangles.size(), kExceptional);
      for (std::size_t n = 0; n < kept.count; ++n) range[face[n]] = tiles[n];
      std::size_t covering = 0, without = 0;
      for (std::size_t n = 0; n < triangles.size(); ++n) {
        const TrianglePlacement placed =
            placeTriangle(triangles[n].x, triangles[n].y, kWidth, kHeight, offsets.reach);
        const bool is_kept = range[n] != kExceptional;
        ASSERT_EQ(placed.fate == TriangleFate::kKept, is_kept);
        bool covers = false;
        forEachMovedSample(triangles[n], offsets, [&](std::int32_t j, std::int32_t i) {
          covers = true;
          ASSERT_TRUE(is_kept);
          const std::uint32_t tile_j = static_cast<std::uint32_t>(j) >> 6,
                              tile_i = static_cast<std::uint32_t>(i) >> 6;
          EXPECT_LE(range[n] & 0xFF, tile_j);
          EXPECT_LE(range[n] >> 8 & 0xFF, tile_i);
          EXPECT_GE(range[n] >> 16 & 0xFF, tile_j);
          EXPECT_GE(range[n] >> 24, tile_i);
          EXPECT_LE(placed.tiles.first_j, j / 64);
          EXPECT_GE(placed.tiles.last_i, i / 64);
        });
        covering += covers ? 1 : 0;
        without += is_kept && !covers ? 1 : 0;
      }
      EXPECT_GT(covering, triangles.size() / 4);
      EXPECT_GT(kept.count, covering);
      // What is kept in vain is little.
      EXPECT_LT(without, triangles.size() / 2);
      EXPECT_EQ(counts.in, triangles.size());
      EXPECT_EQ(counts.in, counts.outside + counts.back_facing + counts.no_sample + kept.count);
    });
  }
}

}  // namespace
}  // namespace deltaz
