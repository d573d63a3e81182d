#include "librender/objects/border_stitcher.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <optional>
#include <random>

#include "librender/scene/scheduler.h"
#include "tests/librender/textured_area.h"

namespace deltaz {
namespace {

constexpr int kLeafCells = 16;

// How far, in plan, a vertex stands from the place its texture coordinates name; metres.
double offPlace(const GridGeometry& geometry, const ViewTransform& view, const TerrainVertex& vertex) {
  const double column = std::floor(vertex.texture.column), row = std::floor(vertex.texture.row);
  const double x = vertex.texture.column - column, y = vertex.texture.row - row;
  const auto corner = [&](int di, int dj) {
    return geometry.placeAt(static_cast<std::int64_t>(column) + di, static_cast<std::int64_t>(row) + dj);
  };
  const Vector3 place = (corner(0, 0).foot * (1 - x) + corner(1, 0).foot * x) * (1 - y) +
                        (corner(0, 1).foot * (1 - x) + corner(1, 1).foot * x) * y;
  const Vector3& p = vertex.position;
  const Vector3 earth =
      view.eye + view.forward * p.x + view.right * (p.y / view.pixels) + view.down * (p.z / view.pixels);
  const Vector3 up = corner(x < 0.5 ? 0 : 1, y < 0.5 ? 0 : 1).up, offset = earth - place;
  return length(offset - up * dot(offset, up));
}

struct Placement {
  double worst_post = 0, worst_seam = 0;  // metres
  std::size_t foreign = 0;                // vertices that seams brought
  std::size_t levels = 0;                 // nodes that are not at full resolution
};

Placement placementOf(const Database& database, double tolerance, bool textured) {
  const ViewTransform view =
      makeViewTransform(wholeAreaCamera(database.area(), 320, 200, 60), EllipsoidShape{});
  const SeamIndex seams(database);
  FrameStatistics::Nodes counts;
  const Schedule schedule = scheduleNodes(database, seams, view, {tolerance}, counts).value();
  const CutIndex index(database, schedule.nodes);
  std::vector<std::optional<TerrainTile>> tiles(schedule.nodes.size());
  std::vector<TerrainVertices> vertices(schedule.nodes.size());
  std::vector<ProcessedNode> processed(schedule.nodes.size());
  for (std::size_t n = 0; n < schedule.nodes.size(); ++n) {
    tiles[n] = database.terrain(schedule.nodes[n].node).value();
    vertices[n] = terrainVertices(*tiles[n], database.grid(tiles[n]->grid), view, Light{});
    processed[n] = {&*tiles[n], &vertices[n]};
  }
  const BorderStitcher stitcher(database, schedule.nodes, index, seams, processed, textured);
  Placement placement;
  for (std::uint32_t n = 0; n < schedule.nodes.size(); ++n) {
    const GridGeometry& geometry = database.grid(tiles[n]->grid);
    placement.levels += tiles[n]->level > 0 ? 1 : 0;
    TerrainSplits splits;
    TerrainVertices stitched = stitcher.vertices(n, splits);
    const std::size_t posts = stitched.position.size();
    (void)stitcher.seamFaces(n, stitched);
    for (std::size_t k = 0; k < stitched.position.size(); ++k) {
      const TerrainVertex vertex = stitched.at(k);
      if (std::isnan(vertex.texture.column)) {
        EXPECT_FALSE(textured);
        continue;
      }
      const double off = offPlace(geometry, view, vertex);
      (k < posts ? placement.worst_post : placement.worst_seam) =
          std::max(k < posts ? placement.worst_post : placement.worst_seam, off);
      placement.foreign += k < posts ? 0 : 1;
    }
  }
  return placement;
}

// Posts, points that split faces and points that seams bring from the other grid alike.
TEST(BorderStitcher, gives_vertices_texture_coordinates_of_where_they_stand) {
  struct Area {
    const char* name;
    std::vector<RawGrid> grids;
  };
  for (const Area& area :
       {Area{"inset between the posts", insetBetweenPosts()}, Area{"projected inset", projectedInset()}}) {
    const MemoryDatabase memory = makeTexturedDatabase(area.grids, kLeafCells, 4, [](auto, double, double) {
      return std::array<std::uint8_t, 4>{1, 2, 3, 255};
    });
    const Placement full = placementOf(memory.database, 0, true);
    const Placement coarse = placementOf(memory.database, 8, true);
    std::printf(
        "%s: posts off by %.4f m, %zu vertices of seams by %.4f m; with %zu coarser nodes %.4f m, %.4f m\n",
        area.name, full.worst_post, full.foreign, full.worst_seam, coarse.levels, coarse.worst_post,
        coarse.worst_seam);
    EXPECT_GT(full.foreign, 100u);
    EXPECT_LT(full.worst_post, 0.001);
    // Between posts, straight edges in space and in a grid part by a hair.
    EXPECT_LT(full.worst_seam, 0.05);
    EXPECT_GT(coarse.levels, 0u);
    EXPECT_LT(coarse.worst_post, 0.5);
    EXPECT_LT(coarse.worst_seam, 0.5);
    EXPECT_LT(placementOf(memory.database, 0, false).foreign, full.foreign);
  }
}

// Nodes as a picture processes them, `wanted` and no others.
class Processing {
 public:
  Processing(const Database& database, const Schedule& schedule, const ViewTransform& view,
             const std::vector<std::uint32_t>& wanted)
      : tiles_(schedule.nodes.size()), vertices_(schedule.nodes.size()), processed(schedule.nodes.size()) {
    for (const std::uint32_t n : wanted) {
      tiles_[n] = database.terrain(schedule.nodes[n].node).value();
      vertices_[n] = terrainVertices(*tiles_[n], database.grid(tiles_[n]->grid), view, Light{});
      processed[n] = {&*tiles_[n], &vertices_[n]};
    }
  }

 private:
  std::vector<std::optional<TerrainTile>> tiles_;
  std::vector<TerrainVertices> vertices_;

 public:
  std::vector<ProcessedNode> processed;
};

TEST(BorderStitcher, draws_a_part_as_it_draws_the_whole) {
  SyntheticGridOptions rough = smallArea();
  rough.columns = rough.rows = 193;
  std::mt19937 random(2);
  std::uint64_t borrowed = 0, drawn = 0;
  for (const std::vector<RawGrid>& grids :
       {std::vector<RawGrid>{syntheticGrid(rough)}, insetBetweenPosts()}) {
    const MemoryDatabase memory = makeTexturedDatabase(grids, 8, 4, [](auto, double, double) {
      return std::array<std::uint8_t, 4>{1, 2, 3, 255};
    });
    const Database& database = memory.database;
    const SeamIndex seams(database);
    for (int n = 0; n < 6; ++n) {
      const ViewTransform view = makeViewTransform(
          cameraOver(database, 0.3, 0.1 + 0.1 * n, 300, 20.0 * n, -15, 320, 200), EllipsoidShape{});
      FrameStatistics::Nodes counts;
      const Schedule schedule = scheduleNodes(database, seams, view, {2.0}, counts).value();
      const CutIndex index(database, schedule.nodes);
      const std::vector<std::uint8_t> flags = nodesToProcess(schedule.nodes, index, seams);
      std::vector<std::uint32_t> all;
      for (std::uint32_t k = 0; k < flags.size(); ++k) {
        if (flags[k] != 0) all.push_back(k);
      }
      EXPECT_EQ(nodesToProcess(database, schedule.nodes, index, seams, schedule.front_to_back), all);
      const Processing whole(database, schedule, view, all);
      const BorderStitcher of_whole(database, schedule.nodes, index, seams, whole.processed);
      std::vector<std::uint32_t> part;
      for (const std::uint32_t k : schedule.front_to_back) {
        if (random() % 4 == 0) part.push_back(k);
      }
      const std::vector<std::uint32_t> wanted = nodesToProcess(database, schedule.nodes, index, seams, part);
      borrowed += wanted.size() - part.size();
      const Processing some(database, schedule, view, wanted);
      const BorderStitcher of_part(database, schedule.nodes, index, seams, some.processed);
      for (const std::uint32_t k : part) {
        TerrainSplits splits, splits_of_part;
        TerrainVertices expected = of_whole.vertices(k, splits), got = of_part.vertices(k, splits_of_part);
        const std::vector<TerrainFace> faces = of_whole.seamFaces(k, expected);
        EXPECT_EQ(of_part.seamFaces(k, got).size(), faces.size());
        EXPECT_EQ(got.position, expected.position);
        EXPECT_EQ(got.light, expected.light);
        EXPECT_EQ(splits_of_part.north, splits.north);
        EXPECT_EQ(splits_of_part.west, splits.west);
        ++drawn;
      }
    }
  }
  EXPECT_GT(drawn, 100u);
  EXPECT_GT(borrowed, 20u);
}

}  // namespace
}  // namespace deltaz
