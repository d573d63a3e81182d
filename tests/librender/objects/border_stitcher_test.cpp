#include "librender/objects/border_stitcher.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <optional>

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

}  // namespace
}  // namespace deltaz
