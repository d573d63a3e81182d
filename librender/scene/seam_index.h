// The seams of an area by node: which nodes are under another grid, which must be drawn at full resolution,
// and what a leaf draws instead of the faces a seam replaced.
//
// Cost of making one: proportional to the seams. Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/access/node_position.h"

namespace deltaz {

enum class SeamState : std::uint8_t {
  kFree,     // no seam touches the node
  kTouched,  // some of its faces are replaced or removed, or seams stand on its posts: to be taken at level 0
  kRemoved,  // nothing of it is drawn or needed
};

// A face that a seam replaced.
struct LeafReplacement {
  std::uint32_t seam = 0;  // index into Database::seams()
  ReplacedFace face;
};

// What seams do to one leaf.
struct LeafSeams {
  std::vector<LeafReplacement> replaced;
  std::vector<CellRun> removed;        // parts of runs, global indices
  std::vector<NodePosition> partners;  // leaves whose posts its seam vertices stand on
};

class SeamIndex {
 public:
  explicit SeamIndex(const Database& database);

  bool empty() const { return touched_.empty(); }
  SeamState stateOf(const NodePosition& position) const;
  // None if no seam touches the leaf.
  const LeafSeams* leaf(const NodePosition& position) const;
  // For each face of a leaf's tile, by identity (cell << 1 | top), whether a seam replaced or removed it;
  // empty if none is.
  std::vector<std::uint8_t> replacedFaces(const TerrainTile& tile) const;

  const std::vector<Seam>& seams() const { return *seams_; }

 private:
  // Leaves below a node that a seam touches, and those of them nothing is left of.
  struct Counts {
    std::uint32_t touched = 0, removed = 0;
  };
  const std::vector<Seam>* seams_;
  std::vector<GridGeometry> grids_;
  std::unordered_map<NodePosition, LeafSeams, NodePositionHash> leaves_;
  std::unordered_map<NodePosition, Counts, NodePositionHash> touched_;
};

}  // namespace deltaz
