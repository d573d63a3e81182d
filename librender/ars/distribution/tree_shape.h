// How cells are put together to a distribution tree for any power of two of tilers and memories (report
// 4.3.3.2: "a tree of any size could be constructed").
//
// Every level of A-cells and of B-cells looks at one bit of the memory's number, the most significant first
// (4.3.5.2). A B-cell also joins what comes from two groups of tilers. So there are
//   more memories than tilers   A-cells (1 x 2) first, one level for each bit that joins nothing;
//   more tilers than memories   B-cells with one output (2 x 1) first, one level for each halving;
//   then B-cells (2 x 2) down to the memories.
// Four tilers and eight memories make the report's tree: A0..A3; B10..B13; B20..B23.
//
// Inputs of a level's cells are numbered by cell: a cell with two inputs c has 2c (upper left) and 2c + 1
// (upper right). Outputs are numbered by cell too: 2c (left) and 2c + 1 (right), or c where there is only
// one. Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <vector>

namespace deltaz::ars {

enum class CellKind : std::uint8_t {
  kSplit,   // A-cell: one input, two outputs
  kSwitch,  // B-cell: two inputs, two outputs
  kMerge,   // B-cell of which one output is used
};

struct TreeLevel {
  CellKind kind = CellKind::kSwitch;
  int cells = 0;
  int routing_shift = 0;  // the routing bit of a pixel: bit routing_shift of its memory's number
  // By output: the input of the level below, or the memory, that it leads to.
  std::vector<int> leads_to;

  int inputs() const { return kind == CellKind::kSplit ? cells : 2 * cells; }
  int outputs() const { return kind == CellKind::kMerge ? cells : 2 * cells; }
};

struct TreeShape {
  int tilers = 1, memories = 1;
  std::vector<TreeLevel> levels;    // from the tilers down; none for one tiler and one memory
  std::vector<int> tiler_leads_to;  // by tiler: the first level's input, or the memory
};

// Powers of two, 1..kMaximumTilers and 1..kMaximumMemories.
TreeShape treeShape(int tilers, int memories);

}  // namespace deltaz::ars
