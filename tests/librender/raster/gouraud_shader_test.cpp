#include "librender/raster/gouraud_shader.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "librender/raster/triangle_placement.h"
#include "tests/support/every_simd_target.h"

namespace deltaz {
namespace {

constexpr std::uint32_t kBehindAll = 0xFF102030;

// Triangles of so many pixels a side, clockwise on the screen, in a picture of one tile.
std::vector<RasterTriangle> shadedTriangles(std::size_t count, float side, int width, int height) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<RasterTriangle> triangles;
  while (triangles.size() < count) {
    RasterTriangle triangle{};
    const float x = (unit(random) - 0.5F) * static_cast<float>(width),
                y = (unit(random) - 0.5F) * static_cast<float>(height);
    std::array<std::int32_t, 3> snapped_x{}, snapped_y{};
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = {x + side * unit(random), y + side * unit(random), 0.001F + 0.02F * unit(random),
                            static_cast<std::uint32_t>(random())};
      snapped_x[k] = snappedCoordinate(triangle.vertex[k].x, width);
      snapped_y[k] = snappedCoordinate(triangle.vertex[k].y, height);
    }
    if (placeTriangle(snapped_x, snapped_y, width, height).fate == TriangleFate::kKept)
      triangles.push_back(triangle);
  }
  return triangles;
}

// The colour of pixel (j, i) in double, a channel; slivers, whose weights the last bits decide, have none.
std::optional<std::array<double, 3>> exactlyShaded(const RasterTriangle& t, double x, double y) {
  const auto& [a, b, c] = t.vertex;
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double area = bx * cy - cx * by;
  if (area < 0.5) return std::nullopt;
  const double dx = x - a.x, dy = y - a.y;
  const double of_b = (dx * cy - cx * dy) / area, of_c = (bx * dy - dx * by) / area;
  const double inverse_u =
      a.inverse_u + of_b * (b.inverse_u - a.inverse_u) + of_c * (c.inverse_u - a.inverse_u);
  const double second = std::clamp(of_b * b.inverse_u / inverse_u, 0.0, 1.0);
  const double third = std::clamp(of_c * c.inverse_u / inverse_u, 0.0, 1.0 - second);
  std::array<double, 3> color{};
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const auto of = [&](const RasterVertex& vertex) {
      return static_cast<double>(vertex.payload >> (8 * channel) & 0xFF);
    };
    color[channel] = of(a) * (1 - second - third) + of(b) * second + of(c) * third;
  }
  return color;
}

// Blocks of one, of two and of many triangles; pictures whose rows are whole cache lines, and others.
TEST(gouraud_shader, every_pixel_has_its_triangles_colour_in_perspective) {
  for (const auto& [width, height] : {std::pair{64, 64}, std::pair{61, 50}}) {
    for (const float side : {3.0F, 9.0F, 40.0F}) {
      const std::vector<RasterTriangle> triangles = shadedTriangles(1500, side, width, height);
      std::vector<const RasterTriangle*> pointers;
      for (const RasterTriangle& triangle : triangles) pointers.push_back(&triangle);
      onEverySimdTarget([&, width = width, height = height] {
        const Tile tile{0, 0, width, height};
        const auto buffer = std::make_unique<TileBuffer>();
        buffer->clear();
        TileCounts counts;
        rasterizeTile(tile, pointers, 0, {}, *buffer, counts);
        ColorFrame frame;
        frame.background = kBehindAll;
        frame.resize(width, height);
        GouraudScratch scratch;
        const auto settled = std::make_unique<TileBuffer>(*buffer);
        shadeTileGouraud(tile, pointers, *buffer, scratch, frame);
        std::size_t compared = 0;
        for (int i = 0; i < height; ++i) {
          for (int j = 0; j < width; ++j) {
            const auto pixel = static_cast<std::size_t>(i * width + j);
            const std::uint32_t owner = settled->triangle[tileIndex(j, i)];
            EXPECT_EQ(frame.inverse_u[pixel], settled->inverse_u[tileIndex(j, i)]);
            if (owner == kNoTriangle) {
              ASSERT_EQ(frame.rgba[pixel], kBehindAll) << j << ' ' << i;
              continue;
            }
            ASSERT_EQ(frame.rgba[pixel] >> 24, 0xFFU);
            for (std::size_t channel = 0; channel < 3; ++channel) {
              const auto of = [&](std::uint32_t rgba) { return rgba >> (8 * channel) & 0xFF; };
              const auto& corner = triangles[owner].vertex;
              const auto [least, greatest] =
                  std::minmax({of(corner[0].payload), of(corner[1].payload), of(corner[2].payload)});
              ASSERT_GE(of(frame.rgba[pixel]), least) << j << ' ' << i;
              ASSERT_LE(of(frame.rgba[pixel]), greatest) << j << ' ' << i;
            }
            const auto color = exactlyShaded(triangles[owner], j - (width - 1) * 0.5, i - (height - 1) * 0.5);
            if (!color) continue;
            ++compared;
            for (std::size_t channel = 0; channel < 3; ++channel)
              ASSERT_NEAR(static_cast<double>(frame.rgba[pixel] >> (8 * channel) & 0xFF), (*color)[channel],
                          1.0)
                  << j << ' ' << i;
          }
        }
        EXPECT_GT(compared, 300U);
        const auto cleared = std::make_unique<TileBuffer>();
        cleared->clear();
        EXPECT_EQ(buffer->inverse_u, cleared->inverse_u);
        EXPECT_EQ(buffer->triangle, cleared->triangle);
        EXPECT_EQ(buffer->least, cleared->least);
        EXPECT_EQ(buffer->wrote, cleared->wrote);
      });
    }
  }
}

}  // namespace
}  // namespace deltaz
