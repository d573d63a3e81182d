#include "librender/raster/tiler.h"

#include <gtest/gtest.h>
#include <random>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "binned_triangles.h"

namespace deltaz {
namespace {

constexpr int kWidth = 300, kHeight = 200;  // no multiple of the tile side

ViewTransform smallView() {
  Camera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.field_of_view = 60;
  return makeViewTransform(camera, EllipsoidShape{});
}

// Faces across the picture and beyond it, each at one of five depths, so that there are many ties; every one
// of them front-facing.
std::vector<PretiledNode> randomNodes(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-200, 200), y(-150, 150);
  std::vector<PretiledNode> nodes;
  for (std::uint32_t n = 0; n < 20; ++n) {
    TerrainVertices vertices;
    std::vector<TerrainFace> faces;
    for (std::uint32_t t = 0; t < 50; ++t) {
      const double u = 1.0 + static_cast<double>(random() % 5);
      for (int k = 0; k < 3; ++k) vertices.position.push_back({u, x(random) * u, y(random) * u});
      TerrainFace face{{3 * t, 3 * t + 1, 3 * t + 2}, t << 1};
      const Vector3* const p = vertices.position.data() + 3 * t;
      if (isBackFacing(p[0], p[1], p[2])) std::swap(face.vertex[1], face.vertex[2]);
      faces.push_back(face);
    }
    vertices.light.resize(vertices.position.size());
    vertices.appended_texture.resize(vertices.position.size());
    nodes.push_back(PretiledNode::ofTerrain(0, n, vertices, faces));
  }
  return nodes;
}

// Draws the nodes in so many batches, each shared out among `threads` writers in whatever order they come.
const TiledFrame& drawn(Tiler& tiler, std::vector<TileBins>& bins, std::vector<PretiledNode>& nodes,
                        int threads) {
  const ViewTransform view = smallView();
  const Pretiler pretiler(view);
  tiler.begin(kWidth, kHeight);
  for (std::size_t batch = 0; batch < bins.size(); ++batch) {
    bins[batch].reset(kWidth, kHeight, static_cast<std::size_t>(threads));
    const std::size_t begin = nodes.size() * batch / bins.size(),
                      end = nodes.size() * (batch + 1) / bins.size();
    tbb::parallel_for(begin, end, [&](std::size_t n) {
      TileBins::Writer& writer =
          bins[batch].writer(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()));
      writer.begin(static_cast<std::uint32_t>(n));
      pretiler.process(nodes[n], static_cast<std::uint32_t>(n), writer);
    });
    bins[batch].finish();
    tiler.draw(bins[batch]);
  }
  return tiler.settle();
}

constexpr int kThreads[] = {1, 2, 7};
constexpr std::size_t kBatches[] = {1, 3};

// The plain definition: triangle after triangle, the nearer wins and of equals the first.
struct Plain {
  std::vector<std::uint64_t> identity = std::vector<std::uint64_t>(kWidth * kHeight, 0);
  std::vector<double> inverse_u = std::vector<double>(kWidth * kHeight, 0);
};

Plain drawPlainly(const std::vector<PretiledNode>& nodes) {
  Plain plain;
  const ViewTransform view = smallView();
  for (const PretiledNode& node : nodes) {
    for (std::uint32_t f = 0; f < node.faces.size(); ++f) {
      const FacePlanes planes = facePlanes(view, node, f);
      RasterTriangle triangle{};
      const auto& vertex = node.faces[f].vertex;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3& p = node.vertices.position[vertex[k == 0 ? 0 : 3 - k]];
        triangle.vertex[k] = {static_cast<float>(p.y / p.x), static_cast<float>(p.z / p.x), 0, 0};
      }
      const SnappedTriangle snapped = snappedOf(triangle, kWidth, kHeight);
      if (doubledArea(snapped) <= 0) continue;
      forEachSample(snapped, sampleBounds(snapped, kWidth, kHeight), [&](std::int32_t j, std::int32_t i) {
        const auto pixel = static_cast<std::size_t>(i * kWidth + j);
        if (!(planes.inverseDepthAt(j, i) > plain.inverse_u[pixel])) return;
        plain.inverse_u[pixel] = planes.inverseDepthAt(j, i);
        plain.identity[pixel] = planes.identity;
      });
    }
  }
  return plain;
}

TEST(tiler, tiles_threads_batches_and_earlier_frames_change_nothing) {
  Tiler tiler;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const std::vector<PretiledNode> nodes = randomNodes(seed);
    const Plain plain = drawPlainly(nodes);
    for (const int threads : kThreads) {
      for (const std::size_t batches : kBatches) {
        tbb::task_arena(threads).execute([&] {
          std::vector<TileBins> bins(batches);
          std::vector<PretiledNode> own = nodes;
          const TiledFrame& frame = drawn(tiler, bins, own, threads);
          for (int i = 0; i < kHeight; ++i) {
            for (int j = 0; j < kWidth; ++j) {
              const SettledTile& tile =
                  frame.tiles[static_cast<std::size_t>(i / kTileSide * frame.across + j / kTileSide)];
              const std::uint32_t seen = tile.at(j % kTileSide, i % kTileSide);
              const auto pixel = static_cast<std::size_t>(i * kWidth + j);
              ASSERT_EQ(seen != kNoTriangle, plain.inverse_u[pixel] > 0);
              if (seen != kNoTriangle) {
                const SeenFace& face = tile.faces()[seen];
                ASSERT_EQ(facePlanes(smallView(), own[face.node], face.face).identity, plain.identity[pixel]);
              }
            }
          }
        });
      }
    }
  }
}

TEST(tiler, counts_are_the_same_for_any_number_of_threads_and_batches_and_add_up) {
  const std::vector<PretiledNode> nodes = randomNodes(9);
  std::uint64_t faces = 0;
  for (const PretiledNode& node : nodes) faces += node.faces.size();
  std::optional<TilerStatistics> first;
  Tiler tiler;
  for (const int threads : kThreads) {
    for (const std::size_t batches : kBatches) {
      tbb::task_arena(threads).execute([&] {
        std::vector<TileBins> bins(batches);
        std::vector<PretiledNode> own = nodes;
        const TilerStatistics counts = drawn(tiler, bins, own, threads).statistics;
        std::uint64_t left_out = 0;
        for (const PretiledNode& node : own) left_out += node.clipped + node.no_sample;
        EXPECT_EQ(left_out + counts.faces_drawn + counts.no_sample, faces);
        EXPECT_LE(counts.hidden, counts.faces_drawn);
        if (first) {
          EXPECT_EQ(counts.tested, first->tested);
          EXPECT_EQ(counts.written, first->written);
          EXPECT_EQ(counts.hidden, first->hidden);
          EXPECT_EQ(counts.faces_drawn, first->faces_drawn);
        }
        first = counts;
      });
    }
  }
}

}  // namespace
}  // namespace deltaz
