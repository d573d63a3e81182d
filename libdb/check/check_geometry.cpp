#include "libdb/check/check_geometry.h"

#include <fmt/format.h>

#include "libdb/access/node_position.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

// Where a node and its parent both have LOD ranges, the finer one is for nearer views.
void checkRanges(CheckContext& context) {
  const auto has_range = [](const NodeRecord& record) { return record.lod_near != 0 || record.lod_far != 0; };
  for (std::uint32_t number = 2; number <= context.records.size(); ++number) {
    const NodeRecord& record = context.record(number);
    const NodeRecord& parent = context.record(context.parents[number - 1]);
    if (!has_range(record) || !has_range(parent)) continue;
    if (record.lod_near <= parent.lod_near && record.lod_far <= parent.lod_far) continue;
    context.report.add(
        makeIssue(IssueCode::kTileLod,
                  fmt::format("it is to be drawn from {} m to {} m, its coarser parent from {} m to {} m",
                              record.lod_near, record.lod_far, parent.lod_near, parent.lod_far),
                  context.locate(number)));
  }
}

}  // namespace

std::vector<std::uint32_t> GeometryCheck::nodesOf(int level) const {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t number = 1; number <= context.records.size(); ++number) {
    const NodeRecord& record = context.record(number);
    if (record.type == NodeType::kTerrain && record.grid == grid && (level < 0 || record.level == level))
      numbers.push_back(number);
  }
  return numbers;
}

bool isSampled(const NodeRecord& leaf, double percent) {
  if (percent >= 100) return true;
  constexpr std::size_t kParts = 1u << 20;
  return static_cast<double>(NodePositionHash{}(positionOf(leaf)) % kParts) <
         percent / 100 * static_cast<double>(kParts);
}

void checkGeometry(CheckContext& context) {
  if (!context.records_known || !context.tree_sound || !context.positions_known) {
    addSkipped(context.report,
               "errors, cones and normals, since the tree of nodes or its places are damaged");
    return;
  }
  for (std::uint16_t grid = 0; grid < context.grids.size(); ++grid) checkPatches(context, grid);
  checkRanges(context);
  // Posts that contradict each other would give findings without number that say nothing new. What stands on
  // the ground or colours it changes no post.
  for (const IssueGroup& group : context.report.groups) {
    if (group.severity != Severity::kError || group.code == IssueCode::kTileLod ||
        group.code >= IssueCode::kColorTree)
      continue;
    addSkipped(context.report, "errors, cones and normals, since there are errors already");
    return;
  }
  TileLoader seam_loader(context);
  const SeamFaces seam_faces = checkSeams(context, seam_loader);
  seam_loader.reportRefusedReads(context.report);
  for (std::uint16_t grid = 0; grid < context.grids.size(); ++grid) {
    TileLoader loader(context);
    const std::optional<FullGrid> full = assembleGrid(context, loader, grid);
    loader.reportRefusedReads(context.report);
    if (!full) {
      addSkipped(context.report,
                 fmt::format("errors, cones and normals of grid {}, which could not be read", grid));
      continue;
    }
    GeometryCheck check{context, loader, grid, *full, seam_faces};
    checkCones(check);
    checkErrors(check);
    checkCoverage(check);
    loader.reportRefusedReads(context.report);
  }
}

}  // namespace deltaz
