// A resampled grid has no source's posts: its surface may lie as far from them as it says, and no farther.
#include <cstddef>
#include <fmt/format.h>
#include <vector>

#include "libdb/check/check_context.h"
#include "libdb/check/report_detail.h"
#include "libdb/check/source_matching.h"
#include "libdb/check/tile_loader.h"
#include "libdb/source/grid_surface.h"

namespace deltaz {
namespace {

constexpr double kSameHeight = 1e-7;  // metres

}  // namespace

void checkResampled(CheckContext& context, std::uint16_t grid) {
  const std::vector<std::string> absent = sourcesNotGiven(context, grid);
  if (!absent.empty()) {
    addSkipped(
        context.report,
        fmt::format("{} posts of grid {}, which was resampled from {} too, and that is not given",
                    postsOf(rectangleOf(context.grids[grid].header())), grid, fmt::join(absent, ", ")));
    return;
  }
  const GridGeometry& geometry = context.grids[grid];
  const GridHeader& header = geometry.header();
  const std::string& name = context.options.against_name;
  TileLoader loader(context);
  RawGrid made;
  made.header = header;
  const auto posts = static_cast<std::size_t>(header.x_axis.count * header.y_axis.count);
  made.heights.assign(posts, 0);
  made.valid.assign(posts, 0);
  for (std::uint32_t number = 1; number <= context.records.size(); ++number) {
    const NodeRecord& record = context.record(number);
    if (record.type != NodeType::kTerrain || record.grid != grid || record.level != 0) continue;
    const auto loaded = loader.load(number);
    if (!loaded.ok()) {
      addSkipped(context.report, fmt::format("heights against {}, since not all nodes could be read", name));
      loader.reportRefusedReads(context.report);
      return;
    }
    const LoadedTile& tile = *loaded.value();
    for (std::int64_t row = tile.rows.begin; row < tile.rows.end; ++row) {
      for (std::int64_t column = tile.columns.begin; column < tile.columns.end; ++column) {
        const auto at = static_cast<std::size_t>((row - header.y_axis.first) * header.x_axis.count + column -
                                                 header.x_axis.first);
        made.heights[at] = tile.height(column, row);
        made.valid[at] = tile.isValid(column, row) ? 1 : 0;
      }
    }
  }
  const auto systemOf = [](const GridHeader& of) {
    return parseReferenceSystem(of.crs_wkt, "area.json", of.coordinate_epoch);
  };
  const Result<ReferenceSystem> system = systemOf(header);
  std::vector<PlacedGrid> placed;
  for (std::size_t k = 0; k < context.options.against_count && system.ok(); ++k) {
    const Result<ReferenceSystem> theirs = systemOf(context.options.against[k].header);
    if (theirs.ok()) placed.push_back({&context.options.against[k], theirs.value(), name});
  }
  const Result<SurfaceDifference> difference = system.ok()
                                                   ? differenceFrom(made, system.value(), placed, true)
                                                   : Result<SurfaceDifference>(system.error());
  if (!difference.ok() || difference.value().posts == 0) {
    addSkipped(context.report,
               fmt::format("heights against {}: {}", name,
                           difference.ok() ? "it has no posts there" : difference.error().message()));
    return;
  }
  context.report.posts_compared += difference.value().posts;
  const double largest = difference.value().largest, stated = header.resampling->largest_error;
  if (largest <= stated * (1 + 1e-9) + kSameHeight) return;
  IssueLocation where;
  where.file = std::string(kAreaFileName);
  context.report.add(
      makeIssue(IssueCode::kSrcHeight,
                fmt::format("the resampled grid {} lies {} m from a post of its sources, and states {} m",
                            grid, largest, stated),
                where, largest));
}

}  // namespace deltaz
