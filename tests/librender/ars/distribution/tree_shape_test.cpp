#include "librender/ars/distribution/tree_shape.h"

#include <gtest/gtest.h>

namespace deltaz::ars {
namespace {

// Where a pixel of a tiler for a memory ends: level by level to the output its routing bit chooses.
int followed(const TreeShape& shape, int tiler, int memory) {
  int wire = shape.tiler_leads_to[static_cast<std::size_t>(tiler)];
  for (const TreeLevel& level : shape.levels) {
    const int cell = level.kind == CellKind::kSplit ? wire : wire / 2;
    const int output = level.kind == CellKind::kMerge ? cell : 2 * cell + (memory >> level.routing_shift & 1);
    wire = level.leads_to[static_cast<std::size_t>(output)];
  }
  return wire;
}

// Digest 7: A0, A1 -> B10 (msb 0), B11 (msb 1); A2, A3 -> B12, B13; B10, B12 -> B20, B21; B11, B13 -> B22,
// B23.
TEST(TreeShape, wires_four_tilers_to_eight_memories_as_the_report_does) {
  const TreeShape shape = treeShape(4, 8);
  ASSERT_EQ(shape.levels.size(), 3U);
  EXPECT_EQ(shape.levels[0].kind, CellKind::kSplit);
  EXPECT_EQ(shape.levels[0].routing_shift, 2);  // the most significant bit, 4.3.5.2
  for (const std::size_t l : {std::size_t{1}, std::size_t{2}}) {
    EXPECT_EQ(shape.levels[l].kind, CellKind::kSwitch);
    EXPECT_EQ(shape.levels[l].cells, 4);
  }
  EXPECT_EQ(shape.levels[0].leads_to, (std::vector{0, 2, 1, 3, 4, 6, 5, 7}));  // 2 x cell + side
  // B10's outputs are the left inputs of B20 and B21, B12's their right ones.
  EXPECT_EQ(shape.levels[1].leads_to, (std::vector{0, 2, 4, 6, 1, 3, 5, 7}));
  EXPECT_EQ(shape.levels[2].leads_to, (std::vector{0, 1, 2, 3, 4, 5, 6, 7}));
}

// Fig 26.
TEST(TreeShape, sorts_one_tiler_with_seven_splitting_cells) {
  const TreeShape shape = treeShape(1, 8);
  int cells = 0;
  for (const TreeLevel& level : shape.levels) {
    EXPECT_EQ(level.kind, CellKind::kSplit);
    cells += level.cells;
  }
  EXPECT_EQ(cells, 7);
}

TEST(TreeShape, leads_every_tiler_to_every_memory) {
  for (int tilers = 1; tilers <= 64; tilers *= 2) {
    for (int memories = 1; memories <= 64; memories *= 2) {
      const TreeShape shape = treeShape(tilers, memories);
      for (int tiler = 0; tiler < tilers; ++tiler)
        for (int memory = 0; memory < memories; ++memory)
          ASSERT_EQ(followed(shape, tiler, memory), memory) << tilers << " x " << memories << ", " << tiler;
    }
  }
}

TEST(TreeShape, lets_no_two_wires_end_at_one_input) {
  for (int tilers = 1; tilers <= 64; tilers *= 2) {
    for (int memories = 1; memories <= 64; memories *= 2) {
      const TreeShape shape = treeShape(tilers, memories);
      std::vector<int> wires = shape.tiler_leads_to;
      for (std::size_t l = 0; l <= shape.levels.size(); ++l) {
        const int inputs = l < shape.levels.size() ? shape.levels[l].inputs() : memories;
        std::vector<int> times(static_cast<std::size_t>(inputs));
        for (const int input : wires) ++times.at(static_cast<std::size_t>(input));
        for (const int count : times) ASSERT_EQ(count, 1) << tilers << " x " << memories << ", level " << l;
        if (l < shape.levels.size()) wires = shape.levels[l].leads_to;
      }
    }
  }
}

}  // namespace
}  // namespace deltaz::ars
