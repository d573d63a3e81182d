#include "librender/objects/grid_faces.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <random>
#include <set>

#include "libdb/access/simd_target.h"

namespace deltaz {
namespace {

// A tile with rough ground seen at a slant, some of it void.
struct Ground {
  TerrainTile tile;
  std::vector<Vector3> position;
};

Ground makeGround(int columns, int rows, double voids, std::mt19937& random) {
  Ground ground;
  ground.tile.columns = columns;
  ground.tile.rows = rows;
  const auto places = static_cast<std::size_t>(columns + 2) * static_cast<std::size_t>(rows + 2);
  ground.tile.heights.resize(places);
  ground.tile.valid.resize(places);
  std::bernoulli_distribution is_void(voids);
  for (std::uint8_t& valid : ground.tile.valid) valid = is_void(random) ? 0 : 1;
  std::uniform_real_distribution<double> rough(-40, 40);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i)
      ground.position.push_back({100.0 + 20 * j, 20.0 * (i - columns / 2), 30 + rough(random)});
  }
  return ground;
}

// Points on some of the border edges, behind the posts.
TerrainSplits splitSome(Ground& ground, std::mt19937& random) {
  TerrainSplits splits;
  std::uniform_int_distribution<int> count(0, 2);
  const auto split = [&](std::vector<std::vector<std::uint32_t>>& side, int edges) {
    side.resize(static_cast<std::size_t>(edges));
    for (std::vector<std::uint32_t>& edge : side) {
      for (int n = count(random); n > 0; --n) {
        edge.push_back(static_cast<std::uint32_t>(ground.position.size()));
        const Vector3 somewhere = ground.position[random() % ground.position.size()];
        ground.position.push_back(somewhere + Vector3{3, 1, 2});
      }
    }
  };
  split(splits.south, ground.tile.columns - 1);
  if (count(random) > 0) split(splits.east, ground.tile.rows - 1);
  if (count(random) > 0) split(splits.north, ground.tile.columns - 1);
  split(splits.west, ground.tile.rows - 1);
  return splits;
}

using Name = std::array<std::uint32_t, 4>;

std::multiset<Name> namesOf(const std::vector<TerrainFace>& faces) {
  std::multiset<Name> names;
  for (const TerrainFace& face : faces)
    names.insert({face.vertex[0], face.vertex[1], face.vertex[2], face.identity});
  return names;
}

std::multiset<Name> namesOf(const GridFaces& faces, int columns) {
  std::multiset<Name> names = namesOf(faces.listed.front);
  const auto across = static_cast<std::uint32_t>(columns);
  for (std::uint32_t cell = 0; cell < faces.cells.size(); ++cell) {
    const std::uint32_t west = cell / (across - 1) * across + cell % (across - 1), north = west + across;
    if ((faces.cells[cell] & 1) != 0) names.insert({west, west + 1, north + 1, cell << 1});
    if ((faces.cells[cell] & 2) != 0) names.insert({west, north + 1, north, cell << 1 | 1});
  }
  return names;
}

TEST(GridFaces, are_those_of_the_list_on_every_vector_width) {
  for (const SimdTarget target : simdTargets()) {
    SCOPED_TRACE(simdTargetName(target));
    ASSERT_TRUE(limitSimdTarget(target));
    std::mt19937 random(7);
    std::uint64_t front = 0, back = 0, split = 0;
    for (int round = 0; round < 60; ++round) {
      std::uniform_int_distribution<int> size(2, 21);
      Ground ground = makeGround(size(random), size(random), round % 3 == 0 ? 0.1 : 0, random);
      const TerrainSplits splits = round % 2 == 0 ? splitSome(ground, random) : TerrainSplits{};
      std::vector<std::uint8_t> left_out;
      if (round % 5 == 0) {
        left_out.resize(static_cast<std::size_t>(ground.tile.columns - 1) *
                        static_cast<std::size_t>(ground.tile.rows - 1) * 2);
        for (std::uint8_t& out : left_out) out = random() % 4 == 0 ? 1 : 0;
      }
      const TerrainFaces expected = terrainFaces(ground.tile, ground.position, splits, left_out);
      const GridFaces faces = gridFaces(ground.tile, ground.position, splits, left_out);
      EXPECT_EQ(namesOf(faces, ground.tile.columns), namesOf(expected.front));
      EXPECT_EQ(faces.in(), expected.in);
      EXPECT_EQ(faces.backFacing(), expected.back_facing);
      front += expected.front.size();
      back += expected.back_facing;
      split += faces.listed.in;
    }
    EXPECT_GT(front, 1000u);
    EXPECT_GT(back, 1000u);
    EXPECT_GT(split, 100u);
  }
  limitSimdTarget(std::nullopt);
}

TEST(GridFaces, of_a_tile_without_cells_are_none) {
  std::mt19937 random(1);
  const Ground row = makeGround(5, 1, 0, random);
  EXPECT_TRUE(gridFaces(row.tile, row.position).cells.empty());
  EXPECT_EQ(gridFaces(row.tile, row.position).in(), 0u);
}

// Edge-on faces and those of no extent are back faces.
TEST(GridFaces, that_are_not_turned_to_the_eye_are_back_faces) {
  std::mt19937 random(1);
  Ground ground = makeGround(9, 9, 0, random);
  for (Vector3& position : ground.position) position.z = 0;
  EXPECT_EQ(gridFaces(ground.tile, ground.position).backFacing(), 128u);
  for (Vector3& position : ground.position) position = {50, 1, 2};
  EXPECT_EQ(gridFaces(ground.tile, ground.position).backFacing(), 128u);
}

}  // namespace
}  // namespace deltaz
