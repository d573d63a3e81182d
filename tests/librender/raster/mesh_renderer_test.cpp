#include "librender/raster/mesh_renderer.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <tbb/task_arena.h>

#include "libdb/access/simd_target.h"

namespace deltaz {
namespace {

ViewTransform viewFrom(const Vector3& eye, double pitch, int width, int height) {
  ViewTransform view;
  view.eye = eye;
  view.forward = {0, std::cos(pitch), std::sin(pitch)};
  view.right = {1, 0, 0};
  view.down = {0, std::sin(pitch), -std::cos(pitch)};
  view.width = width;
  view.height = height;
  view.pixels = width * 0.8;
  view.centre_j = (width - 1) / 2.0;
  view.centre_i = (height - 1) / 2.0;
  return view;
}

// Rough ground of 90 x 70 posts around the origin: some of it lies behind an eye that stands on it.
GridMesh roughGround() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  GridMesh grid;
  grid.columns = 90;
  grid.rows = 70;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i)
      grid.vertices.append(static_cast<float>(i - 45) * 4, static_cast<float>(j - 20) * 4, unit(random) * 6,
                           0xFF000000U | (random() & 0xFFFFFF));
  }
  grid.vertices.pad();
  return grid;
}

IndexedMesh indexedOf(const GridMesh& grid) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto columns = static_cast<std::uint32_t>(grid.columns);
  for (std::uint32_t j = 0; j + 1 < static_cast<std::uint32_t>(grid.rows); ++j) {
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t south_west = j * columns + i, north_west = south_west + columns;
      triangles.push_back({south_west, south_west + 1, north_west + 1});
      triangles.push_back({south_west, north_west + 1, north_west});
    }
  }
  MeshVertices vertices = grid.vertices;
  return {vertices, triangles};
}

struct Result {
  ColorFrame frame;
  MeshCounts counts;
};

Result drawOn(int threads, const ViewTransform& view, std::span<const GridMesh> grids,
              std::span<const IndexedMesh> meshes) {
  Result result;
  result.frame.resize(view.width, view.height);
  MeshRenderer renderer;
  tbb::task_arena arena(threads);
  arena.execute([&] { result.counts = renderer.draw(view, grids, meshes, result.frame); });
  return result;
}

const std::vector<ViewTransform>& views() {
  static const std::vector<ViewTransform> all = {
      viewFrom({0, -120, 60}, -0.4, 301, 203), viewFrom({2, 3, 9}, -0.1, 256, 128),
      viewFrom({0, 40, 150}, -1.5, 130, 190), viewFrom({5, 5, 1}, 0.2, 64, 64)};
  return all;
}

void expectEqual(const Result& a, const Result& b) {
  EXPECT_EQ(a.frame.rgba, b.frame.rgba);
  EXPECT_EQ(a.frame.inverse_u, b.frame.inverse_u);
  EXPECT_EQ(a.counts.in, b.counts.in);
  EXPECT_EQ(a.counts.outside, b.counts.outside);
  EXPECT_EQ(a.counts.back_facing, b.counts.back_facing);
  EXPECT_EQ(a.counts.no_sample, b.counts.no_sample);
  EXPECT_EQ(a.counts.drawn, b.counts.drawn);
  EXPECT_EQ(a.counts.hidden, b.counts.hidden);
  EXPECT_EQ(a.counts.samples_tested, b.counts.samples_tested);
  EXPECT_EQ(a.counts.samples_written, b.counts.samples_written);
}

TEST(mesh_renderer, pictures_and_counts_do_not_depend_on_threads_or_vector_width) {
  const std::vector<GridMesh> grids = {roughGround()};
  const std::vector<IndexedMesh> meshes = {indexedOf(grids[0])};
  for (const ViewTransform& view : views()) {
    const Result first = drawOn(1, view, grids, meshes);
    for (const int threads : {2, 7}) expectEqual(first, drawOn(threads, view, grids, meshes));
    for (const SimdTarget target : simdTargets()) {
      ASSERT_TRUE(limitSimdTarget(target));
      expectEqual(first, drawOn(2, view, grids, meshes));
    }
    limitSimdTarget(std::nullopt);
  }
}

TEST(mesh_renderer, every_triangle_has_one_fate) {
  const std::vector<GridMesh> grids = {roughGround()};
  for (const ViewTransform& view : views()) {
    const MeshCounts counts = drawOn(2, view, grids, {}).counts;
    EXPECT_EQ(counts.in, 2U * 89 * 69);
    EXPECT_EQ(counts.in, counts.outside + counts.back_facing + counts.no_sample + counts.drawn);
    EXPECT_LE(counts.hidden, counts.drawn);
    EXPECT_LE(counts.samples_written, counts.samples_tested);
  }
}

TEST(mesh_renderer, a_grid_and_the_same_triangles_by_index_give_the_same_picture) {
  const std::vector<GridMesh> grids = {roughGround()};
  const std::vector<IndexedMesh> meshes = {indexedOf(grids[0])};
  for (const ViewTransform& view : views()) {
    const Result by_grid = drawOn(2, view, grids, {}), by_index = drawOn(2, view, {}, meshes);
    EXPECT_EQ(by_grid.frame.inverse_u, by_index.frame.inverse_u);
    EXPECT_EQ(by_grid.counts.in, by_index.counts.in);
    EXPECT_EQ(by_grid.counts.outside, by_index.counts.outside);
    EXPECT_EQ(by_grid.counts.back_facing, by_index.counts.back_facing);
    // Where a vertical edge is seen from its end both triangles are equally near, and the order decides.
    std::size_t different = 0;
    for (std::size_t n = 0; n < by_grid.frame.rgba.size(); ++n)
      different += by_grid.frame.rgba[n] != by_index.frame.rgba[n];
    EXPECT_LE(different, by_grid.frame.rgba.size() / 1000);
  }
}

TEST(mesh_renderer, ground_that_reaches_behind_the_eye_is_cut_and_leaves_no_hole) {
  // A plane 2 m below the eye fills all that lies below the horizon.
  GridMesh plane;
  plane.columns = plane.rows = 41;
  for (int j = 0; j < plane.rows; ++j) {
    for (int i = 0; i < plane.columns; ++i)
      plane.vertices.append(static_cast<float>(i - 20) * 500, static_cast<float>(j - 20) * 500, 0,
                            0xFF804020U);
  }
  plane.vertices.pad();
  const ViewTransform view = viewFrom({3, 7, 2}, 0, 200, 101);
  const Result drawn = drawOn(1, view, std::span(&plane, 1), {});
  for (int i = 0; i < view.height; ++i) {
    const double drop = (i - view.centre_i) / view.pixels;
    for (int j = 0; j < view.width; ++j) {
      const auto n = static_cast<std::size_t>(i * view.width + j);
      // The plane ends 10 km away.
      if (drop > 2.0 / 9000) {
        ASSERT_NEAR(static_cast<double>(drawn.frame.inverse_u[n]), drop / 2, 1e-6 + drop * 1e-5)
            << j << ' ' << i;
        ASSERT_EQ(drawn.frame.rgba[n], 0xFF804020U);
      } else if (drop <= 0) {
        ASSERT_EQ(drawn.frame.inverse_u[n], 0);
      }
    }
  }
}

}  // namespace
}  // namespace deltaz
