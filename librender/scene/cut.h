// A cut through the quadtrees of an area: nodes of any levels that together cover everything once. A picture
// draws the part of its cut that can be seen and stitches its nodes to each other; the rest stands for all
// that need not be opened.
//
// Indices are global ones of level 0: node (x, y) of level k spans posts x * leaf * 2^k .. (x + 1) * leaf *
// 2^k. Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/access/node_position.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

// Why a node is not drawn.
enum class Unseen : std::uint8_t { kNot, kOutOfView, kBeyondHorizon, kFacingAway, kOccluded };

struct CutNode {
  Node node;
  bool in_view = false;          // drawn; nothing of the others can be seen
  bool waiting = false;          // while the cut is made: not in view yet, since nobody has looked that far
  Unseen unseen = Unseen::kNot;  // the first reason that was found
  bool occluded = false;         // in view, but hidden by what lies before it
  bool drawn = false;            // while the cut is made
  bool frozen = false;           // while the cut is made: drawn, or beside what is drawn
  double distance = 0;           // from the eye; nothing of it is nearer, metres
  bool seamed = false;           // a seam touches it (SeamState::kTouched)
  NodeVolume volume = {};        // of terrain nodes
};

enum class Side : std::uint8_t { kSouth, kEast, kNorth, kWest };
inline constexpr Side kSides[] = {Side::kSouth, Side::kEast, Side::kNorth, Side::kWest};

// Finds the nodes of a cut by place. Refers to the vector it was made of, which must not change meanwhile.
class CutIndex {
 public:
  CutIndex(const Database& database, const std::vector<CutNode>& nodes);

  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  // The node at exactly this position, kNone if the cut has none there.
  std::uint32_t at(const NodePosition& position) const;
  // The node that holds level-0 cell (column, row) of a grid.
  std::uint32_t holding(std::uint16_t grid, std::int64_t column, std::int64_t row) const;
  // The node of the same or a coarser level that borders all of a side; kNone if there are finer ones or
  // none.
  std::uint32_t acrossWhole(const NodePosition& position, Side side) const;
  // Appends the nodes that share a border or a corner with the one at `position`, some of them more than
  // once.
  void appendTouching(const NodePosition& position, std::vector<std::uint32_t>& nodes) const;
  // Posts of the finer nodes across a side that lie strictly between two posts of it, ascending: indices
  // along the side.
  void postsAcross(const NodePosition& position, Side side, std::int64_t from, std::int64_t to,
                   std::vector<std::int64_t>& posts) const;

 private:
  void addPosts(const NodePosition& position, Side facing, std::int64_t from, std::int64_t to,
                std::vector<std::int64_t>& posts) const;
  void appendFiner(const NodePosition& position, Side facing, std::vector<std::uint32_t>& nodes) const;
  struct Grid {
    int levels = 1;
    std::int64_t leaf_cells = 1;
  };
  std::vector<Grid> grids_;
  // Open addressing with linear probing, at most half full: looked into for every post of every border.
  struct Place {
    NodePosition position;
    std::uint32_t node = kNone;
  };
  std::vector<Place> places_;  // a power of two of them
};

// The position of the node of the same level beyond a side.
NodePosition beyond(const NodePosition& position, Side side);

}  // namespace deltaz
