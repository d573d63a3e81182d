#include "librender/ars/distribution/tree_shape.h"

#include <bit>
#include <cassert>
#include <cstddef>

#include "librender/ars/distribution/memory_map.h"

namespace deltaz::ars {

namespace {

// A wire carries the pixels of one group of tilers whose memory numbers begin with the same bits. Wires are
// numbered group by group. This is the input of `kind`-cells that wire `wire` leads to, of `prefixes` to a
// group.
int inputOf(CellKind kind, int wire, int prefixes) {
  if (kind == CellKind::kSplit) return wire;
  const int group = wire / prefixes, prefix = wire % prefixes;
  const int cell = group / 2 * prefixes + prefix;
  return 2 * cell + group % 2;
}

}  // namespace

TreeShape treeShape(int tilers, int memories) {
  assert(tilers >= 1 && tilers <= kMaximumTilers && std::has_single_bit(static_cast<unsigned>(tilers)));
  assert(memories >= 1 && memories <= kMaximumMemories &&
         std::has_single_bit(static_cast<unsigned>(memories)));
  TreeShape shape{.tilers = tilers, .memories = memories, .levels = {}, .tiler_leads_to = {}};

  int groups = tilers, prefixes = 1;
  std::vector<int> prefixes_before;
  while (groups > 1 || prefixes < memories) {
    const int bits_left = std::countr_zero(static_cast<unsigned>(memories / prefixes));
    const int halvings_left = std::countr_zero(static_cast<unsigned>(groups));
    TreeLevel level;
    level.kind = bits_left > halvings_left   ? CellKind::kSplit
                 : bits_left < halvings_left ? CellKind::kMerge
                                             : CellKind::kSwitch;
    prefixes_before.push_back(prefixes);
    if (level.kind != CellKind::kSplit) groups /= 2;
    level.cells = groups * prefixes;
    if (level.kind != CellKind::kMerge) {
      level.routing_shift = bits_left - 1;
      prefixes *= 2;
    }
    shape.levels.push_back(level);
  }

  for (int tiler = 0; tiler < tilers; ++tiler)
    shape.tiler_leads_to.push_back(shape.levels.empty() ? tiler : inputOf(shape.levels[0].kind, tiler, 1));
  for (std::size_t l = 0; l < shape.levels.size(); ++l) {
    // Outputs 2c and 2c + 1 of cell (group, prefix) are the wires of twice the prefix, and that plus one.
    const bool last = l + 1 == shape.levels.size();
    for (int wire = 0; wire < shape.levels[l].outputs(); ++wire)
      shape.levels[l].leads_to.push_back(
          last ? wire : inputOf(shape.levels[l + 1].kind, wire, prefixes_before[l + 1]));
  }
  return shape;
}

}  // namespace deltaz::ars
