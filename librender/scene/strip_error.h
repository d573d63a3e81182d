// How far the strip along a node's border, where it follows coarser neighbours, may lie from the
// full-resolution surface.
//
// A border post that a coarser node's edge passes is moved onto that edge. The edge's point over the post is
// part of the coarser node's surface, so the post moves by at most that node's geometric error along the
// ellipsoid normal, plus the displacement of the edge's ends where still coarser nodes move those; and
// sideways by the bow of the edge, a chord in space, against the line of posts under it. Inside the strip the
// surface is the node's own plus the interpolated displacement, hence the sum. Nodes that are not drawn move
// nothing.
//
// Thread-safety: one thread at a time.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "libdb/access/plan_shape.h"
#include "librender/scene/cut.h"

namespace deltaz {

class StripErrors {
 public:
  StripErrors(const Database& database, const std::vector<CutNode>& nodes, const CutIndex& index);

  // Metres along the ellipsoid normal that are to be added to the node's own geometric error; 0 if none of
  // its neighbours is coarser. `worst` becomes the coarser neighbour that contributes most. Infinity if
  // unknown. `touched`, if given, becomes the other nodes of the cut that were looked at, some of them more
  // than once: while these stay in the cut, the result stays.
  double strip(std::uint32_t node, std::uint32_t& worst, std::vector<std::uint32_t>* touched = nullptr) const;

 private:
  // Largest displacement of post (column, row), which node `owner` has, by coarser nodes that touch it.
  double displacement(std::uint16_t grid, std::int64_t column, std::int64_t row, int depth,
                      std::vector<std::uint32_t>* touched) const;
  // Of the node's edges, metres.
  double bow(const NodeRecord& record) const;

  const Database& database_;
  const std::vector<CutNode>& nodes_;
  const CutIndex& index_;
  mutable std::map<std::uint16_t, SidewaysBow> bows_;  // by grid
};

}  // namespace deltaz
