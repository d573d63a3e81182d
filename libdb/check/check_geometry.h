// The rules of level "geometry": what a database says of its own accuracy, recomputed from the
// full-resolution posts in other ways than the builder's. Internal to libdb/check.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "libdb/access/between_posts.h"
#include "libdb/check/check_context.h"
#include "libdb/check/full_grid.h"
#include "libdb/check/tile_loader.h"

namespace deltaz {

// What leaves draw where grids meet, by record number: corners in Earth-centred metres.
using SeamFaces = std::unordered_map<std::uint32_t, std::vector<std::array<Vector3, 3>>>;

// What the rules of one grid share.
struct GeometryCheck {
  CheckContext& context;
  TileLoader& loader;
  std::uint16_t grid = 0;
  const FullGrid& full;
  const SeamFaces& seam_faces;
  // Found by checkCones: the steepest facet of each node, and by record number whether a node draws any facet
  // itself.
  BetweenPosts between_posts = BetweenPosts(context.grids[grid]);
  std::vector<std::uint8_t> has_facets = {};

  const GridGeometry& geometry() const { return context.grids[grid]; }
  // Record numbers of the grid's terrain nodes of one level; of all levels if it is negative.
  std::vector<std::uint32_t> nodesOf(int level) const;
  // Where a finding about a node's record stands.
  IssueLocation whereRecord(std::uint32_t number) const { return context.locate(number); }
};

// HGT_SEAM, TILE_SPHERE: the faces of seams stand on posts and inside the spheres of the leaves that draw
// them. Before the grids, whose cones hold these faces too.
SeamFaces checkSeams(CheckContext& context, TileLoader& loader);
// TILE_CONE, TILE_NORMAL. First, since the others need what it finds.
void checkCones(GeometryCheck& check);
// ERR_GEOMETRIC, ERR_RMS, ERR_ANCESTOR; honours CheckOptions::sample_percent.
void checkErrors(GeometryCheck& check);
// ERR_COVERAGE.
void checkCoverage(GeometryCheck& check);
// HGT_PATCHES: control points on the ellipsoid, and smooth.
void checkPatches(CheckContext& context, std::uint16_t grid);

// Whether a leaf belongs to a sample of `percent` of all: the same ones every time.
bool isSampled(const NodeRecord& leaf, double percent);

}  // namespace deltaz
