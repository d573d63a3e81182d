#include "librender/raster/tiler.h"

#include <gtest/gtest.h>
#include <random>
#include <tbb/task_arena.h>

namespace deltaz {
namespace {

constexpr int kWidth = 300, kHeight = 200;  // no multiple of the tile side

std::vector<PretiledNode> randomNodes(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<PretiledNode> nodes(20);
  for (PretiledNode& node : nodes) {
    for (std::uint32_t t = 0; t < 50; ++t) {
      SnappedTriangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.x[k] = static_cast<std::int32_t>(random() % (400 * 256)) - 50 * 256;
        triangle.y[k] = static_cast<std::int32_t>(random() % (300 * 256)) - 50 * 256;
      }
      if (doubledArea(triangle) < 0)
        std::swap(triangle.x[1], triangle.x[2]), std::swap(triangle.y[1], triangle.y[2]);
      if (doubledArea(triangle) <= 0 || sampleBounds(triangle, kWidth, kHeight).empty()) continue;
      triangle.face = static_cast<std::uint32_t>(node.faces.size());
      node.triangles.push_back(triangle);
      FacePlanes face;
      // Few distinct depths, so that there are many ties.
      face.inverse_u.value = face.least = face.greatest = 1.0 + static_cast<double>(random() % 5);
      node.faces.push_back(face);
    }
  }
  return nodes;
}

// The plain definition: triangle after triangle over the whole picture.
DepthFrameBuffer drawInOrder(const std::vector<PretiledNode>& nodes, TilerStatistics& counts) {
  DepthFrameBuffer buffer(kWidth, kHeight);
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    for (const SnappedTriangle& t : nodes[n].triangles) {
      bool covers = false;
      forEachSample(t, sampleBounds(t, kWidth, kHeight), [&](std::int32_t j, std::int32_t i) {
        covers = true;
        ++counts.tested;
        const auto inverse_u = static_cast<float>(nodes[n].faces[t.face].inverseDepthAt(j, i));
        if (buffer.write(j, i, inverse_u, n, t.face)) ++counts.written;
      });
      ++(covers ? counts.faces_drawn : counts.no_sample);
    }
  }
  return buffer;
}

TEST(Tiler, tiles_and_threads_change_nothing) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const std::vector<PretiledNode> nodes = randomNodes(seed);
    TilerStatistics expected;
    const DepthFrameBuffer reference = drawInOrder(nodes, expected);
    for (const int threads : {1, 2, 7}) {
      DepthFrameBuffer buffer(kWidth, kHeight);
      TilerStatistics counts;
      tbb::task_arena(threads).execute([&] { counts = tile(nodes, buffer); });
      EXPECT_EQ(counts.tested, expected.tested);
      EXPECT_EQ(counts.written, expected.written);
      EXPECT_EQ(counts.faces_drawn, expected.faces_drawn);
      EXPECT_EQ(counts.no_sample, expected.no_sample);
      for (int i = 0; i < kHeight; ++i) {
        for (int j = 0; j < kWidth; ++j) {
          const auto &a = buffer.at(j, i), &b = reference.at(j, i);
          ASSERT_EQ(a.inverse_u, b.inverse_u);
          ASSERT_EQ(a.node, b.node);
          ASSERT_EQ(a.face, b.face);
        }
      }
    }
  }
}

TEST(DepthFrameBuffer, nearer_wins_and_of_equals_the_first) {
  DepthFrameBuffer buffer(2, 1);
  EXPECT_TRUE(buffer.at(0, 0).empty());
  EXPECT_TRUE(buffer.write(0, 0, 0.5f, 1, 10));
  EXPECT_FALSE(buffer.write(0, 0, 0.5f, 2, 20));
  EXPECT_FALSE(buffer.write(0, 0, 0.25f, 3, 30));
  EXPECT_EQ(buffer.at(0, 0).face, 10u);
  EXPECT_TRUE(buffer.write(0, 0, 0.75f, 4, 40));
  EXPECT_EQ(buffer.at(0, 0).node, 4u);
  EXPECT_TRUE(buffer.at(1, 0).empty());
}

}  // namespace
}  // namespace deltaz
