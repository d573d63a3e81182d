#include "librender/raster/tile_rasterizer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <random>

#include "libdb/access/simd_target.h"
#include "librender/antialias/sample_pattern.h"
#include "librender/raster/coverage.h"
#include "librender/raster/triangle_placement.h"

namespace deltaz {
namespace {

constexpr int kSide = kTileSide;  // of the picture: one tile

// DELTAZ_SOAK_TRIANGLES asks for another number of triangles a vector width.
std::size_t wantedTriangles() {
  const char* const text = std::getenv("DELTAZ_SOAK_TRIANGLES");
  return text != nullptr ? static_cast<std::size_t>(std::atoll(text)) : 150'000;
}

// Sets one vector width after the other, and lifts the limit.
template <typename Test>
void onEveryTarget(Test&& test) {
  for (const SimdTarget target : simdTargets()) {
    SCOPED_TRACE(simdTargetName(target));
    ASSERT_TRUE(limitSimdTarget(target));
    test();
  }
  limitSimdTarget(std::nullopt);
}

SnappedTriangle snapped(const RasterTriangle& triangle) {
  SnappedTriangle result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.x[k] = snappedCoordinate(triangle.vertex[k].x, kSide);
    result.y[k] = snappedCoordinate(triangle.vertex[k].y, kSide);
  }
  return result;
}

RasterTriangle triangleOf(const RasterVertex& a, const RasterVertex& b, const RasterVertex& c) {
  RasterTriangle triangle{};
  triangle.vertex[0] = a;
  triangle.vertex[1] = b;
  triangle.vertex[2] = c;
  return triangle;
}

std::vector<const RasterTriangle*> pointersTo(const std::vector<RasterTriangle>& triangles) {
  std::vector<const RasterTriangle*> pointers;
  for (const RasterTriangle& triangle : triangles) pointers.push_back(&triangle);
  return pointers;
}

// A turned grid of shaken vertices that covers the whole tile, split along whichever diagonal lies inside.
// Each triangle is nearer than those before it, so that none is found hidden.
std::vector<RasterTriangle> shakenMesh(double cell, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double angle = unit(random) * 6.283185307179586, cosine = std::cos(angle), sine = std::sin(angle);
  const double reach = kSide * 0.75 + 2 * cell;
  const int cells = static_cast<int>(std::ceil(2 * reach / cell));
  std::vector<RasterVertex> vertices;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = (j + 0.98 * (unit(random) - 0.5)) * cell - reach;
      const double y = (i + 0.98 * (unit(random) - 0.5)) * cell - reach;
      vertices.push_back(
          {static_cast<float>(x * cosine - y * sine), static_cast<float>(x * sine + y * cosine), 1, 0});
    }
  }
  std::vector<RasterTriangle> triangles;
  const auto add = [&](const RasterVertex& a, const RasterVertex& b, const RasterVertex& c) {
    triangles.push_back(triangleOf(a, b, c));
  };
  const auto across = static_cast<std::size_t>(cells) + 1;
  for (std::size_t i = 0; i + 1 < across; ++i) {
    for (std::size_t j = 0; j + 1 < across; ++j) {
      const RasterVertex &a = vertices[i * across + j], &b = vertices[i * across + j + 1];
      const RasterVertex &c = vertices[(i + 1) * across + j + 1], &d = vertices[(i + 1) * across + j];
      const auto area = [&](const RasterVertex& p, const RasterVertex& q, const RasterVertex& r) {
        return doubledArea(snapped(triangleOf(p, q, r)));
      };
      if (area(a, b, c) >= 0 && area(a, c, d) >= 0) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
  }
  float nearness = 1;
  for (RasterTriangle& triangle : triangles) {
    nearness = std::nextafter(nearness, 2.0F);
    for (RasterVertex& vertex : triangle.vertex) vertex.inverse_u = nearness;
  }
  return triangles;
}

struct Drawn {
  std::unique_ptr<TileBuffer> buffer = std::make_unique<TileBuffer>();
  TileCounts counts;
};

// Samples at the pixels' centres, and moved from there in two ways.
const std::array<const SampleOffsets*, 3> kOffsets = {nullptr, sampleOffsets(4, SamplePattern::kRotated),
                                                      sampleOffsets(16, SamplePattern::kRotated)};

// Where a sample lies from its pixel's centre, 1/256 pixel.
SamplePlace placeOf(const SampleOffsets* offsets, int j, int i) {
  if (offsets == nullptr) return {0, 0};
  const auto k = static_cast<std::size_t>(i % kBlockSide * kBlockSide + j % kBlockSide);
  return {offsets->x[k], offsets->y[k]};
}

// Triangles without area are not handed to the tiler.
Drawn draw(const std::vector<RasterTriangle>& triangles, const SampleOffsets* offsets = nullptr) {
  std::vector<const RasterTriangle*> kept;
  for (const RasterTriangle& triangle : triangles) {
    if (doubledArea(snapped(triangle)) > 0) kept.push_back(&triangle);
  }
  Drawn drawn;
  drawn.buffer->clear();
  rasterizeTile({0, 0, kSide, kSide, offsets}, kept, 0, {}, *drawn.buffer, drawn.counts);
  return drawn;
}

TEST(tile_rasterizer, meshes_with_shared_edges_cover_every_sample_exactly_once) {
  onEveryTarget([] {
    std::mt19937 random(7);
    std::size_t triangles = 0, meshes = 0;
    while (triangles < wantedTriangles()) {
      const double cell =
          std::exp(std::uniform_real_distribution<double>(std::log(0.3), std::log(60.0))(random));
      const std::vector<RasterTriangle> mesh = shakenMesh(cell, random);
      triangles += mesh.size();
      const Drawn drawn = draw(mesh, kOffsets[meshes++ % kOffsets.size()]);
      ASSERT_EQ(drawn.counts.hidden, 0U);
      // As many samples as there are, and none left out: each once.
      ASSERT_EQ(drawn.counts.tested, static_cast<std::uint64_t>(kSide * kSide)) << "cell " << cell;
      ASSERT_EQ(std::count(drawn.buffer->inverse_u.begin(), drawn.buffer->inverse_u.end(), 0.0F), 0)
          << "cell " << cell;
    }
  });
}

// Of any size and place within the guard band, many of them needles.
std::vector<RasterTriangle> randomTriangles(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<RasterTriangle> triangles;
  while (triangles.size() < count) {
    const double size =
        std::exp(std::uniform_real_distribution<double>(std::log(0.2), std::log(9000.0))(random));
    const double x = unit(random) * kSide, y = unit(random) * kSide, flat = std::abs(unit(random));
    RasterVertex vertex[3];
    for (RasterVertex& v : vertex) {
      const auto limited = [](double p) {
        return static_cast<float>(std::clamp(p, -double{kGuardBand}, double{kGuardBand}));
      };
      v = {limited(x + unit(random) * size), limited(y + unit(random) * size * flat),
           static_cast<float>(1 + 0.5 * unit(random)), 0};
    }
    RasterTriangle triangle = triangleOf(vertex[0], vertex[1], vertex[2]);
    if (doubledArea(snapped(triangle)) < 0) std::swap(triangle.vertex[1], triangle.vertex[2]);
    if (doubledArea(snapped(triangle)) > 0) triangles.push_back(triangle);
  }
  return triangles;
}

TEST(tile_rasterizer, covers_what_exact_integers_say_one_triangle_at_a_time) {
  onEveryTarget([] {
    std::mt19937 random(11);
    std::size_t count = 0;
    for (const RasterTriangle& triangle : randomTriangles(6000, random)) {
      const SampleOffsets* const offsets = kOffsets[count++ % kOffsets.size()];
      const Drawn drawn = draw({triangle}, offsets);
      const SnappedTriangle exact = snapped(triangle);
      // A moved sample sees the triangle where a centre sees it moved the other way.
      std::vector<std::uint8_t> covered(kSide * kSide, 0);
      for (int place = 0; place < (offsets == nullptr ? 1 : kBlockPixels); ++place) {
        const SamplePlace moved = placeOf(offsets, place % kBlockSide, place / kBlockSide);
        SnappedTriangle seen = exact;
        for (std::size_t k = 0; k < 3; ++k) {
          seen.x[k] -= moved.x;
          seen.y[k] -= moved.y;
        }
        forEachSample(seen, sampleBounds(seen, kSide, kSide), [&](std::int32_t j, std::int32_t i) {
          if (offsets == nullptr || i % kBlockSide * kBlockSide + j % kBlockSide == place)
            covered[static_cast<std::size_t>(i * kSide + j)] = 1;
        });
      }
      for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
          ASSERT_EQ(drawn.buffer->inverse_u[tileIndex(j, i)] > 0,
                    covered[static_cast<std::size_t>(i * kSide + j)] == 1)
              << j << ' ' << i;
        }
      }
    }
  });
}

TEST(tile_rasterizer, depth_is_the_plane_of_the_vertices_and_stays_in_their_range) {
  std::mt19937 random(13);
  std::size_t count = 0;
  for (const RasterTriangle& triangle : randomTriangles(4000, random)) {
    const SampleOffsets* const offsets = kOffsets[count++ % kOffsets.size()];
    const Drawn drawn = draw({triangle}, offsets);
    const auto& [a, b, c] = triangle.vertex;
    const double bx = double{b.x} - double{a.x}, by = double{b.y} - double{a.y},
                 cx = double{c.x} - double{a.x}, cy = double{c.y} - double{a.y};
    const double determinant = bx * cy - cx * by;
    const float least = std::min({a.inverse_u, b.inverse_u, c.inverse_u}),
                greatest = std::max({a.inverse_u, b.inverse_u, c.inverse_u});
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        const float there = drawn.buffer->inverse_u[tileIndex(j, i)];
        if (there == 0) continue;
        ASSERT_GE(there, least);
        ASSERT_LE(there, greatest);
        const SamplePlace moved = placeOf(offsets, j, i);
        const double dx = j + moved.x / 256.0 - (kSide - 1) / 2.0 - double{a.x},
                     dy = i + moved.y / 256.0 - (kSide - 1) / 2.0 - double{a.y};
        const double u1 = (dx * cy - dy * cx) / determinant, u2 = (bx * dy - by * dx) / determinant;
        const double plane = double{a.inverse_u} + u1 * (double{b.inverse_u} - double{a.inverse_u}) +
                             u2 * (double{c.inverse_u} - double{a.inverse_u});
        // Single precision of the plane's terms, whose size across a block is its slope's.
        const double steepness =
            (std::abs(cy) + std::abs(by) + std::abs(cx) + std::abs(bx)) / std::abs(determinant) * kTileSide;
        ASSERT_NEAR(double{there}, std::clamp(plane, double{least}, double{greatest}),
                    1e-6 * (1 + steepness));
      }
    }
  }
}

TEST(tile_rasterizer, every_vector_width_gives_the_same_buffer_and_counts) {
  std::mt19937 random(17);
  const std::vector<RasterTriangle> triangles = randomTriangles(4000, random);
  for (const SampleOffsets* const offsets : kOffsets) {
    std::optional<Drawn> first;
    onEveryTarget([&] {
      Drawn drawn = draw(triangles, offsets);
      if (!first) {
        first = std::move(drawn);
        return;
      }
      EXPECT_EQ(drawn.buffer->inverse_u, first->buffer->inverse_u);
      EXPECT_EQ(drawn.buffer->least, first->buffer->least);
      EXPECT_EQ(drawn.buffer->triangle, first->buffer->triangle);
      EXPECT_EQ(drawn.buffer->wrote, first->buffer->wrote);
      EXPECT_EQ(drawn.counts.tested, first->counts.tested);
      EXPECT_EQ(drawn.counts.written, first->counts.written);
      EXPECT_EQ(drawn.counts.hidden, first->counts.hidden);
      EXPECT_EQ(drawn.counts.drawn, first->counts.drawn);
      EXPECT_EQ(drawn.counts.no_sample, first->counts.no_sample);
    });
  }
}

TEST(tile_rasterizer, the_nearest_triangle_owns_each_pixel_and_of_equals_the_first) {
  std::mt19937 random(19);
  std::vector<RasterTriangle> triangles = randomTriangles(300, random);
  // Every tenth lies exactly where the one before it does.
  for (std::size_t n = 10; n < triangles.size(); n += 10) triangles[n] = triangles[n - 1];
  const std::vector<const RasterTriangle*> pointers = pointersTo(triangles);
  const Drawn together = draw(triangles);
  std::vector<Drawn> alone;
  for (const RasterTriangle& triangle : triangles) alone.push_back(draw({triangle}));
  for (std::size_t pixel = 0; pixel < together.buffer->inverse_u.size(); ++pixel) {
    std::uint32_t nearest = kNoTriangle;
    float best = 0;
    for (std::size_t n = 0; n < alone.size(); ++n) {
      if (alone[n].buffer->inverse_u[pixel] > best) {
        best = alone[n].buffer->inverse_u[pixel];
        nearest = static_cast<std::uint32_t>(n);
      }
    }
    ASSERT_EQ(together.buffer->inverse_u[pixel], best);
    ASSERT_EQ(together.buffer->triangle[pixel], nearest) << pixel;
    if (nearest != kNoTriangle) {
      ASSERT_EQ(together.buffer->wrote[nearest], 1) << pixel;
    }
  }
}

TEST(tile_rasterizer, counts_marks_and_least_depths_are_those_of_one_triangle_after_the_other) {
  onEveryTarget([] {
    std::mt19937 random(23);
    // Large ones fill lists of blocks; neighbours in a mesh share blocks.
    std::vector<RasterTriangle> triangles = randomTriangles(400, random);
    for (const RasterTriangle& triangle : shakenMesh(3, random)) triangles.push_back(triangle);
    std::erase_if(triangles, [](const RasterTriangle& t) { return doubledArea(snapped(t)) <= 0; });
    for (const bool nearer : {true, false}) {
      for (std::size_t n = 0; n < triangles.size(); ++n) {
        for (RasterVertex& vertex : triangles[n].vertex)
          vertex.inverse_u = static_cast<float>(nearer ? n + 1 : triangles.size() - n);
      }
      const Drawn together = draw(triangles);
      std::vector<float> picture(kSide * kSide, 0.0F);  // of TileBuffer's order
      std::uint64_t tested = 0, written = 0, no_sample = 0;
      for (std::size_t n = 0; n < triangles.size(); ++n) {
        const Drawn alone = draw({triangles[n]});
        std::uint64_t covered = 0, seen = 0;
        for (std::size_t pixel = 0; pixel < picture.size(); ++pixel) {
          const float there = alone.buffer->inverse_u[pixel];
          covered += there > 0 ? 1 : 0;
          seen += there > picture[pixel] ? 1 : 0;
          picture[pixel] = std::max(picture[pixel], there);
        }
        ASSERT_EQ(alone.counts.tested, covered) << n;
        ASSERT_EQ(alone.counts.written, covered) << n;
        ASSERT_EQ(together.buffer->wrote[n], seen > 0 ? 1 : 0) << n;
        tested += covered;
        written += seen;
        no_sample += covered == 0 ? 1 : 0;
      }
      EXPECT_EQ(together.counts.written, written);
      if (nearer) {
        EXPECT_EQ(together.counts.tested, tested);
        EXPECT_EQ(together.counts.drawn, triangles.size() - no_sample);
        EXPECT_EQ(together.counts.no_sample, no_sample);
        EXPECT_EQ(together.counts.hidden, 0U);
      } else {
        EXPECT_LT(together.counts.tested, tested);
        EXPECT_GT(together.counts.hidden, 0U);
      }
      for (std::size_t block = 0; block < kBlocksAcross * kBlocksAcross; ++block) {
        const auto first =
            together.buffer->inverse_u.begin() + static_cast<std::ptrdiff_t>(block * kBlockPixels);
        ASSERT_EQ(together.buffer->least[block], *std::min_element(first, first + kBlockPixels)) << block;
      }
    }
  });
}

TEST(tile_rasterizer, pixels_beyond_the_picture_are_left_alone) {
  onEveryTarget([] {
    // A picture of 70 x 67 ends inside blocks of the tile (1, 1).
    constexpr int kWidth = 70, kHeight = 67;
    const RasterTriangle triangle = triangleOf({-200, -200, 1, 0}, {400, -200, 1, 0}, {-200, 400, 1, 0});
    const std::vector<const RasterTriangle*> triangles = {&triangle};
    TileBuffer buffer;
    buffer.clear();
    TileCounts counts;
    rasterizeTile({1, 1, kWidth, kHeight}, triangles, 0, {}, buffer, counts);
    EXPECT_EQ(counts.tested, 6U * 3U);
    for (int i = 0; i < kTileSide; ++i) {
      for (int j = 0; j < kTileSide; ++j)
        ASSERT_EQ(buffer.inverse_u[tileIndex(j, i)] > 0, j < kWidth - kTileSide && i < kHeight - kTileSide);
    }
  });
}

}  // namespace
}  // namespace deltaz
