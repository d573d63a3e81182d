// What leaves draw where two grids meet: on posts that are there, inside the leaves' spheres.
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "libdb/access/seam_geometry.h"
#include "libdb/check/check_geometry.h"
#include "libdb/check/node_spheres.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

class SeamRule {
 public:
  SeamRule(CheckContext& context, TileLoader& loader)
      : context_(context), loader_(loader), spheres_(context) {}

  void add(std::size_t number, SeamFaces& of_leaves) {
    const Seam& seam = context_.seams[number];
    std::vector<std::optional<Vector3>> positions;
    for (std::size_t v = 0; v < seam.vertices.size(); ++v) {
      positions.push_back(positionAt(seam, seam.vertices[v]));
      if (!on_void_) continue;
      context_.report.add(makeIssue(
          IssueCode::kHgtSeam, fmt::format("vertex {} of seam {} stands on a void post", v, number), {}));
    }
    for (const SeamSide side : {SeamSide::kUpper, SeamSide::kLower}) {
      for (const ReplacedFace& replaced : seam.replacedOf(side)) {
        const std::uint32_t leaf = leafOf(gridOf(seam, side), replaced.column, replaced.row);
        if (leaf == 0) continue;
        for (std::uint32_t f = 0; f < replaced.face_count; ++f) {
          const auto& [a, b, c] = seam.faces[replaced.first_face + f];
          if (!positions[a] || !positions[b] || !positions[c]) continue;
          const std::array<Vector3, 3> face = {*positions[a], *positions[b], *positions[c]};
          holdInSpheres(leaf, face);
          of_leaves[leaf].push_back(face);
        }
      }
    }
  }

 private:
  // The leaf with cell or post (column, row); 0 if there is none.
  std::uint32_t leafOf(std::uint16_t grid, std::int64_t column, std::int64_t row) const {
    const GridGeometry& geometry = context_.grids[grid];
    const std::int64_t cells = geometry.header().leaf_cells;
    const auto node = [&](std::int64_t index, PostRange posts) {
      return static_cast<std::int32_t>(floorDivide(std::min(index, posts.end - 2), cells));
    };
    return context_.recordAt({grid, 0, node(column, geometry.columnsAt(0)), node(row, geometry.rowsAt(0))});
  }

  // Nothing if a post it depends on is void, or lies in a leaf that cannot be read (reported elsewhere).
  std::optional<Vector3> positionAt(const Seam& seam, const SeamVertex& vertex) {
    on_void_ = false;
    bool known = true;
    const auto post_at = [&](std::uint16_t grid, std::int64_t column, std::int64_t row) {
      const TilePointer tile = loader_.find(leafOf(grid, column, row));
      if (!tile || !tile->hasPosts()) {
        known = false;
        return Vector3{};
      }
      if (!tile->isValid(column, row)) on_void_ = true;
      const GridGeometry& geometry = context_.grids[grid];
      return geometry.placeAt(column, row).at(geometry.metres(tile->height(column, row)));
    };
    const Vector3 position = seamVertexPosition(seam, vertex, post_at);
    if (!known || on_void_) return std::nullopt;
    return position;
  }

  void holdInSpheres(std::uint32_t leaf, const std::array<Vector3, 3>& face) {
    for (std::uint32_t above = leaf; above != 0; above = context_.parents[above - 1]) {
      double outside = 0;
      for (const Vector3& vertex : face)
        outside = std::max(outside, length(vertex - spheres_.centre(above)) - spheres_.radius(above));
      if (outside <= NodeSpheres::kTolerance) continue;
      addLazily(context_.report, IssueCode::kTileSphere, outside, [&] {
        return makeIssue(IssueCode::kTileSphere,
                         fmt::format("a face of a seam that leaf {} draws lies {:.3f} m outside its sphere",
                                     leaf, outside),
                         context_.locate(above), outside);
      });
    }
  }

  CheckContext& context_;
  TileLoader& loader_;
  const NodeSpheres spheres_;
  bool on_void_ = false;  // what positionAt found last
};

}  // namespace

SeamFaces checkSeams(CheckContext& context, TileLoader& loader) {
  SeamFaces of_leaves;
  if (context.seams.empty()) return of_leaves;
  SeamRule rule(context, loader);
  for (std::size_t number = 0; number < context.seams.size(); ++number) rule.add(number, of_leaves);
  return of_leaves;
}

}  // namespace deltaz
