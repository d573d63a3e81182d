#include "libdb/build/mesh_decimation.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "libdb/build/mesh_detail.h"
#include "tests/support/sampled_distance.h"

namespace deltaz {
namespace {

struct Soup {
  std::vector<Vector3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  TriangleView view() const { return {positions, triangles}; }
};

// A closed ball of `rings` rings of twice as many vertices.
Soup ball(std::uint32_t rings) {
  Soup soup;
  const std::uint32_t around = 2 * rings;
  soup.positions.push_back({0, 0, -1});
  for (std::uint32_t r = 1; r < rings; ++r) {
    for (std::uint32_t k = 0; k < around; ++k) {
      const double latitude = std::numbers::pi * (static_cast<double>(r) / rings - 0.5);
      const double longitude = 2 * std::numbers::pi * k / around;
      soup.positions.push_back({std::cos(latitude) * std::cos(longitude),
                                std::cos(latitude) * std::sin(longitude), std::sin(latitude)});
    }
  }
  soup.positions.push_back({0, 0, 1});
  const auto top = static_cast<std::uint32_t>(soup.positions.size() - 1);
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t next = (k + 1) % around;
    soup.triangles.push_back({0, 1 + next, 1 + k});
    const std::uint32_t last = 1 + (rings - 2) * around;
    soup.triangles.push_back({top, last + k, last + next});
    for (std::uint32_t r = 0; r + 2 < rings; ++r) {
      const std::uint32_t a = 1 + r * around;
      soup.triangles.push_back({a + k, a + next, a + around + next});
      soup.triangles.push_back({a + k, a + around + next, a + around + k});
    }
  }
  return soup;
}

double volumeOf(const Soup& soup, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  double volume = 0;
  for (const auto& [a, b, c] : triangles)
    volume += dot(soup.positions[a], cross(soup.positions[b], soup.positions[c])) / 6;
  return volume;
}

TEST(MeshDecimation, reaches_every_target_of_a_closed_mesh) {
  const Soup fine = ball(24);
  const std::vector<std::size_t> targets = {1000, 400, 100};
  const std::vector<DecimatedMesh> levels = decimateMesh(fine.view(), targets);
  ASSERT_EQ(levels.size(), targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    EXPECT_LE(levels[k].triangles.size(), targets[k]);
    EXPECT_GE(levels[k].triangles.size() + 2, targets[k]);
    // Still a ball, and still the right way round: 100 triangles spread evenly inside a ball lose a tenth.
    EXPECT_GE(volumeOf(fine, levels[k].triangles), 0.85 * volumeOf(fine, fine.triangles));
    EXPECT_LE(volumeOf(fine, levels[k].triangles), volumeOf(fine, fine.triangles));
  }
}

TEST(MeshDecimation, a_flat_plate_keeps_its_outline) {
  Soup plate;
  constexpr std::uint32_t kSteps = 20;
  for (std::uint32_t j = 0; j <= kSteps; ++j) {
    for (std::uint32_t i = 0; i <= kSteps; ++i)
      plate.positions.push_back({static_cast<double>(i), static_cast<double>(j), 0});
  }
  for (std::uint32_t j = 0; j < kSteps; ++j) {
    for (std::uint32_t i = 0; i < kSteps; ++i) {
      const std::uint32_t a = j * (kSteps + 1) + i, c = a + kSteps + 1;
      plate.triangles.push_back({a, a + 1, c + 1});
      plate.triangles.push_back({a, c + 1, c});
    }
  }
  const std::vector<std::size_t> targets = {40};
  const std::vector<DecimatedMesh> levels = decimateMesh(plate.view(), targets);
  ASSERT_EQ(levels.size(), 1u);
  EXPECT_LE(levels.front().triangles.size(), 40u);
  double area = 0;
  for (const auto& [a, b, c] : levels.front().triangles) {
    area +=
        length(cross(plate.positions[b] - plate.positions[a], plate.positions[c] - plate.positions[a])) / 2;
  }
  EXPECT_NEAR(area, kSteps * kSteps, 1e-9);
}

TEST(MeshDecimation, edges_of_three_triangles_lose_none_of_them) {
  // Three sheets that meet in one edge.
  Soup soup;
  soup.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
  soup.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  const std::vector<std::size_t> targets = {3};
  const std::vector<DecimatedMesh> levels = decimateMesh(soup.view(), targets);
  ASSERT_EQ(levels.size(), 1u);
  EXPECT_EQ(levels.front().triangles.size(), 3u);
}

ImportedMesh imported(const Soup& soup, const std::array<SrgbColor, 2>& halves) {
  ImportedMesh mesh;
  for (const Vector3& p : soup.positions)
    mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  mesh.triangles = soup.triangles;
  for (const auto& [a, b, c] : soup.triangles) {
    const double z = soup.positions[a].z + soup.positions[b].z + soup.positions[c].z;
    const SrgbColor color = halves[z > 0 ? 1 : 0];
    mesh.colors.push_back({color, color, color});
    mesh.normals.emplace_back();
    const std::array<std::uint32_t, 3> corners = {a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& p = mesh.positions[corners[k]];
      mesh.normals.back()[k] = p;
    }
  }
  return mesh;
}

TEST(DetailLevels, coarser_ones_have_fewer_triangles_and_larger_errors_that_hold) {
  const std::vector<FinishedLod> lods =
      makeDetailLevels(imported(ball(12), {SrgbColor{200, 0, 0}, SrgbColor{0, 0, 200}}), 16);
  ASSERT_GE(lods.size(), 3u);
  const auto soupOf = [](const ModelMesh& mesh) {
    Soup soup;
    for (const auto& [x, y, z] : mesh.vertices)
      soup.positions.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
    soup.triangles = mesh.triangles;
    return soup;
  };
  const Soup finest = soupOf(lods.front().mesh);
  EXPECT_EQ(lods.front().error, 0);
  for (std::size_t k = 1; k < lods.size(); ++k) {
    EXPECT_LT(lods[k].mesh.triangles.size(), lods[k - 1].mesh.triangles.size());
    EXPECT_GT(lods[k].error, lods[k - 1].error);
    const Soup coarse = soupOf(lods[k].mesh);
    const double sampled = std::max(sampledDistance(finest.view(), coarse.view(), 6),
                                    sampledDistance(coarse.view(), finest.view(), 12));
    EXPECT_GE(static_cast<double>(lods[k].error), sampled);
    EXPECT_LE(static_cast<double>(lods[k].error), 1.2 * sampled);
  }
}

TEST(DetailLevels, coarser_ones_are_colored_and_shaded_as_the_finest) {
  const std::vector<FinishedLod> lods =
      makeDetailLevels(imported(ball(12), {SrgbColor{200, 0, 0}, SrgbColor{0, 0, 200}}), 16);
  for (const FinishedLod& lod : lods) {
    ASSERT_TRUE(lod.mesh.curveShaded());
    for (std::size_t v = 0; v < lod.mesh.vertices.size(); ++v) {
      // On a ball around the origin normals point as positions do.
      double along = 0;
      for (std::size_t i = 0; i < 3; ++i)
        along += static_cast<double>(lod.mesh.vertices[v][i]) * lod.mesh.normals[v][i] / kModelNormalScale;
      EXPECT_GT(along, 0.95);
    }
    for (std::size_t t = 0; t < lod.mesh.triangles.size(); ++t) {
      double lowest = 1, highest = -1;
      for (const std::uint32_t v : lod.mesh.triangles[t]) {
        lowest = std::min(lowest, static_cast<double>(lod.mesh.vertices[v][2]));
        highest = std::max(highest, static_cast<double>(lod.mesh.vertices[v][2]));
      }
      const auto& color =
          lod.mesh.colored_by_vertex ? lod.mesh.colors[lod.mesh.triangles[t][0]] : lod.mesh.colors[t];
      if (lowest > 0.2) {
        EXPECT_GT(color[2], 180);
      }
      if (highest < -0.2) {
        EXPECT_GT(color[0], 180);
      }
    }
  }
}

TEST(DetailLevels, one_level_is_the_finest_alone) {
  EXPECT_EQ(makeDetailLevels(imported(ball(12), {SrgbColor{1, 2, 3}, SrgbColor{3, 2, 1}}), 1).size(), 1u);
}

}  // namespace
}  // namespace deltaz
