// Closes the borders between nodes of different levels, so that in a cut every edge inside the ground is
// shared by exactly two faces with identical vertices.
//
// A post of the finer node that lies inside an edge of a coarser one is moved onto that edge, in space
// (moving its height alone would leave a gap, since chords of a curved Earth bow in plan too); the coarser
// node's face on that edge is split into a fan through the same points. No skirts, nothing drawn twice. The
// result depends on the processed nodes of the cut alone.
//
//                coarse  A-----------B        the face under A-B becomes (A,m,C), (m,n,C), (n,B,C);
//                        |\         /|        m and n, posts of the finer node above, get the
//                        | \   C   / |        positions on the chord A-B, from the same expression
//                                             on both sides, A and B in the order of their indices.
//
// An edge moves posts only where the coarser node draws a face on it; voids and area ends keep the finer
// node's own border. At a post that several nodes have, colour (and so the normal) is the coarsest node's.
//
// Only processed nodes are there for the stitcher: a node that is not drawn moves nothing, since its border
// cannot be seen. So a picture needs the nodes it draws and no others beside them.
// Cost: proportional to the border. Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libdb/access/terrain_tile.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/scene/cut.h"
#include "librender/scene/seam_index.h"

namespace deltaz {

// A node of the cut with what the object processor made of it. Nodes that no one needs have neither.
struct ProcessedNode {
  const TerrainTile* tile = nullptr;
  const TerrainVertices* vertices = nullptr;
};

// The nodes of a cut that must be processed to draw what is in view: those in view, and the leaves their
// seams stand on. One flag a node.
std::vector<std::uint8_t> nodesToProcess(const std::vector<CutNode>& cut, const CutIndex& index,
                                         const SeamIndex& seams);

// The same to draw some of those in view, by their indices, with the vertices they have if all are drawn:
// also the coarser nodes in view that touch them, whose edges their borders follow. Indices, ascending. So a
// picture may be drawn in parts, nearest first, and leave out what they hide.
std::vector<std::uint32_t> nodesToProcess(const Database& database, const std::vector<CutNode>& cut,
                                          const CutIndex& index, const SeamIndex& seams,
                                          std::span<const std::uint32_t> part);

class BorderStitcher {
 public:
  // All arguments are referred to and must live as long. `processed` has one entry for each node of the cut.
  // `textured`: vertices that seams bring from another grid are given their texture coordinates, too.
  BorderStitcher(const Database& database, const std::vector<CutNode>& cut, const CutIndex& index,
                 const SeamIndex& seams, const std::vector<ProcessedNode>& processed, bool textured = false);

  // The vertices of node `n` with its border resolved, and behind its posts the points that split its faces.
  // `posts`, if given, becomes the level-0 index (column, row) of each vertex, which a split point has, too.
  TerrainVertices vertices(std::uint32_t n, TerrainSplits& splits,
                           std::vector<std::array<std::int64_t, 2>>* posts = nullptr) const;

  // The faces seams put in the place of leaf `n`'s own, back faces included, and their vertices, which are
  // appended to `vertices`. `names`, if given, gets one entry for each vertex appended.
  struct SeamVertexName {
    std::uint32_t seam = 0, vertex = 0;
  };
  std::vector<TerrainFace> seamFaces(std::uint32_t n, TerrainVertices& vertices,
                                     std::vector<SeamVertexName>* names = nullptr) const;

 private:
  // Nothing if no processed node has the post.
  std::optional<TerrainVertex> resolve(std::uint16_t grid, std::int64_t column, std::int64_t row) const;
  // With texture coordinates in grid `drawing`.
  std::optional<TerrainVertex> seamVertex(const Seam& seam, const SeamVertex& vertex,
                                          std::uint16_t drawing) const;
  // A post as the object processor placed it.
  std::optional<TerrainVertex> ownPost(std::uint16_t grid, std::int64_t column, std::int64_t row) const;
  // Where a post of grid `grid` lies in grid `drawing`.
  GridCoordinates textureIn(std::uint16_t drawing, std::uint16_t grid, std::int64_t column,
                            std::int64_t row) const;
  bool drawsFaceOnEdge(std::uint32_t node, std::int64_t column, std::int64_t row) const;

  const Database& database_;
  const std::vector<CutNode>& cut_;
  const CutIndex& index_;
  const SeamIndex& seams_;
  const std::vector<ProcessedNode>& processed_;
  bool textured_;
};

}  // namespace deltaz
