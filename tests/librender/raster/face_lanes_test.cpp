#include "librender/raster/face_lanes.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace deltaz {
namespace {

ViewTransform smallView() {
  ViewTransform view;
  view.width = 320;
  view.height = 200;
  view.centre_j = 159.5;
  view.centre_i = 99.5;
  view.pixels = 300;
  return view;
}

// A node of 5 x 4 posts somewhere in front of the eye, some of them behind it, and another with its faces in
// a list.
PretiledNode roughNode(std::mt19937& random, bool listed) {
  std::uniform_real_distribution<double> rough(-1, 1), light(0, 1.3);
  TerrainVertices vertices;
  vertices.columns = 5;
  vertices.rows = 4;
  vertices.first_post = {800, -96};
  vertices.step = 8;
  const double ahead = 5 + 35 * rough(random);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 5; ++i) {
      vertices.position.push_back({ahead + 12 * j + 3 * rough(random), 2000.0 * (i - 2) + 500 * rough(random),
                                   2000 + 900 * rough(random)});
      vertices.light.push_back({static_cast<float>(light(random)), static_cast<float>(light(random)),
                                static_cast<float>(light(random)), static_cast<float>(light(random))});
    }
  }
  GridFaces faces;
  if (!listed) faces.cells.assign(12 + kGridFacePadding, 3);
  PretiledNode node = PretiledNode::ofTerrain(2, 77, vertices, faces);
  if (listed) {
    PretiledNode grid;
    grid.vertices = vertices;
    for (std::uint32_t face = 0; face < 24; ++face) node.faces.push_back(grid.face(face | kGridFace));
  }
  return node;
}

void expectSame(const FaceLanes& a, const FaceLanes& b) {
  for (std::size_t lane = 0; lane < kFaceLanes; ++lane) {
    EXPECT_EQ(a.value[lane], b.value[lane]) << lane;
    EXPECT_EQ(a.per_j[lane], b.per_j[lane]) << lane;
    EXPECT_EQ(a.per_i[lane], b.per_i[lane]) << lane;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(a.color[k][c], b.color[k][c]);
  }
  EXPECT_EQ(a.anchor_j, b.anchor_j);
  EXPECT_EQ(a.anchor_i, b.anchor_i);
  EXPECT_EQ(a.least, b.least);
  EXPECT_EQ(a.greatest, b.greatest);
  EXPECT_EQ(a.column, b.column);
  EXPECT_EQ(a.row, b.row);
  EXPECT_EQ(a.least_column, b.least_column);
  EXPECT_EQ(a.greatest_column, b.greatest_column);
  EXPECT_EQ(a.least_row, b.least_row);
  EXPECT_EQ(a.greatest_row, b.greatest_row);
  EXPECT_EQ(a.identity, b.identity);
  EXPECT_EQ(a.grid, b.grid);
  EXPECT_EQ(a.surface, b.surface);
}

// A face of the grid and the same in a list, which goes the general way, before the hither plane or not.
TEST(FaceLanes, of_the_grid_are_those_of_the_planes_in_general) {
  const ViewTransform view = smallView();
  std::mt19937 random(4);
  int clipped = 0;
  for (int round = 0; round < 200; ++round) {
    const std::mt19937 same = random;
    std::vector<PretiledNode> nodes = {roughNode(random, false)};
    random = same;
    nodes.push_back(roughNode(random, true));
    std::vector<SeenFace> of_grid, of_list;
    for (std::uint32_t face = 0; face < 24; ++face) {
      const auto vertex = nodes[1].faces[face].vertex;
      const std::vector<Vector3>& position = nodes[1].vertices.position;
      const int in_front = (position[vertex[0]].x >= 0.1 ? 1 : 0) + (position[vertex[1]].x >= 0.1 ? 1 : 0) +
                           (position[vertex[2]].x >= 0.1 ? 1 : 0);
      if (in_front == 0) continue;
      clipped += in_front < 3 ? 1 : 0;
      of_grid.push_back({0, face | kGridFace});
      of_list.push_back({1, face});
    }
    std::vector<FaceLanes> grid, list;
    makeFaceLanes(view, nodes, of_grid, grid);
    makeFaceLanes(view, nodes, of_list, list);
    ASSERT_EQ(grid.size(), list.size());
    for (std::size_t n = 0; n < grid.size(); ++n) expectSame(grid[n], list[n]);
  }
  EXPECT_GT(clipped, 10);
}

TEST(face_lanes, places_beside_a_face_move_to_the_nearest_of_its_edges) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-20, 20), thin(-1e-3, 1e-3), part(0, 1);
  for (int n = 0; n < 2000; ++n) {
    // Every other face is a needle: its third corner nearly on the edge of the others.
    FaceLanes face{};
    face.corners = 3;
    face.corner_j[1] = place(random);
    face.corner_i[1] = place(random);
    const double along = part(random);
    face.corner_j[2] = n % 2 == 0 ? place(random) : along * face.corner_j[1] + thin(random);
    face.corner_i[2] = n % 2 == 0 ? place(random) : along * face.corner_i[1] + thin(random);
    const double from_j = place(random), from_i = place(random);
    double j = from_j, i = from_i;
    moveInside(face, j, i);
    const double moved = std::hypot(j - from_j, i - from_i);
    double nearest = std::numeric_limits<double>::infinity(), off_edges = nearest;
    const std::array<std::array<double, 2>, 3> corner = {
        {{0, 0}, {face.corner_j[1], face.corner_i[1]}, {face.corner_j[2], face.corner_i[2]}}};
    for (std::size_t k = 0; k < 3; ++k) {
      for (int step = 0; step <= 4000; ++step) {
        const double t = step / 4000.0;
        const double on_j = corner[k][0] + t * (corner[(k + 1) % 3][0] - corner[k][0]),
                     on_i = corner[k][1] + t * (corner[(k + 1) % 3][1] - corner[k][1]);
        nearest = std::min(nearest, std::hypot(on_j - from_j, on_i - from_i));
        off_edges = std::min(off_edges, std::hypot(on_j - j, on_i - i));
      }
    }
    EXPECT_LE(moved, nearest + 1e-12);
    EXPECT_LT(off_edges, 0.01);
  }
}

TEST(face_lanes, places_beside_a_face_that_is_all_clipped_stay) {
  const FaceLanes face{};
  double j = 3, i = -2;
  moveInside(face, j, i);
  EXPECT_EQ(j, 3);
  EXPECT_EQ(i, -2);
}

}  // namespace
}  // namespace deltaz
