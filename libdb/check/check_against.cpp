// The full-resolution posts of grid 0 against the source they came from, post for post and void for void.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "libdb/check/check_context.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"
#include "libdb/check/tile_loader.h"

namespace deltaz {
namespace {

// Posts of two grids are the same ones if they lie within this fraction of their spacing: far below a
// millimetre of any DEM, far above the rounding of a geotransform written as text.
constexpr double kSamePostFraction = 1e-6;

class SourceRule {
 public:
  SourceRule(CheckContext& context, const RawGrid& source)
      : context_(context), source_(source), geometry_(context.grids[0]), loader_(context) {}

  void run() {
    if (!sameGeoreference()) {
      addSkipped(context_.report,
                 fmt::format("heights against {}, whose posts are elsewhere", context_.options.against_name));
      return;
    }
    checkExtent();
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t number = 1; number <= context_.records.size(); ++number) {
      const NodeRecord& record = context_.record(number);
      if (record.type == NodeType::kTerrain && record.grid == 0 && record.level == 0)
        leaves.push_back(number);
    }
    parallelReport(context_.report, leaves.size(), 16,
                   [&](std::size_t item, Report& report) { compareLeaf(leaves[item], report); });
    loader_.reportRefusedReads(context_.report);
    const std::int64_t columns = std::min(columnsEnd(), geometry_.columnsAt(0).end) -
                                 std::max(source_.header.x_axis.first, geometry_.columnsAt(0).begin);
    const std::int64_t rows = std::min(rowsEnd(), geometry_.rowsAt(0).end) -
                              std::max(source_.header.y_axis.first, geometry_.rowsAt(0).begin);
    const std::uint64_t expected =
        columns > 0 && rows > 0 ? static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) : 0;
    if (context_.report.posts_compared < expected) {
      addSkipped(
          context_.report,
          fmt::format("{} of {} posts against {}, since their nodes could not be read",
                      expected - context_.report.posts_compared, expected, context_.options.against_name));
    }
  }

 private:
  std::int64_t columnsEnd() const { return source_.header.x_axis.first + source_.header.x_axis.count; }
  std::int64_t rowsEnd() const { return source_.header.y_axis.first + source_.header.y_axis.count; }

  void complain(IssueCode code, std::string message) {
    IssueLocation where;
    where.file = std::string(kAreaFileName);
    context_.report.add(makeIssue(code, std::move(message), where));
  }

  bool sameGeoreference() {
    const GridHeader& ours = geometry_.header();
    const GridHeader& theirs = source_.header;
    bool same = true;
    const auto differ = [&](std::string message) {
      complain(IssueCode::kSrcGeoreference, std::move(message));
      same = false;
    };
    if (ours.kind != theirs.kind)
      differ(fmt::format("the grid is {}, the source {}", ours.kind, theirs.kind));
    if (ours.ellipsoid != theirs.ellipsoid) {
      differ(fmt::format("the ellipsoid is {} m, 1/{}, the source's {} m, 1/{}",
                         ours.ellipsoid.semi_major_axis, ours.ellipsoid.inverse_flattening,
                         theirs.ellipsoid.semi_major_axis, theirs.ellipsoid.inverse_flattening));
    }
    if (ours.horizontal_datum != theirs.horizontal_datum) {
      differ(fmt::format("the datum is {}, the source's {}", ours.horizontal_datum, theirs.horizontal_datum));
    }
    if (ours.quantum != theirs.quantum) {
      differ(fmt::format("a height step is {} m, the source's {} m", ours.quantum.value(),
                         theirs.quantum.value()));
    }
    if (!samePosts(ours.x_axis, theirs.x_axis, kLongitudeOrigin))
      differ("columns are not at the source's longitudes");
    if (!samePosts(ours.y_axis, theirs.y_axis, kLatitudeOrigin)) differ("rows are not at the source's latitudes");
    return same;
  }

  // Whether posts with the same index lie at the same place all along both axes.
  static bool samePosts(const GridAxis& ours, const GridAxis& theirs, const AxisOrigin& origin) {
    const auto differ = [&](std::int64_t post) {
      return std::abs(postCoordinate(ours, origin, post) - postCoordinate(theirs, origin, post)) >
             kSamePostFraction * ours.spacing;
    };
    return !differ(std::min(ours.first, theirs.first)) &&
           !differ(std::max(ours.first + ours.count, theirs.first + theirs.count) - 1);
  }

  void checkExtent() {
    const auto check = [&](const GridAxis& ours, const GridAxis& theirs, const char* what) {
      if (ours.first == theirs.first && ours.count == theirs.count) return;
      complain(IssueCode::kSrcExtent,
               fmt::format("the database has {} {} from {} on, the source {} from {} on", ours.count, what,
                           ours.first, theirs.count, theirs.first));
    };
    check(geometry_.header().x_axis, source_.header.x_axis, "columns");
    check(geometry_.header().y_axis, source_.header.y_axis, "rows");
  }

  void compareLeaf(std::uint32_t number, Report& report) {
    const NodeRecord& record = context_.record(number);
    const auto loaded = loader_.load(number);
    if (!loaded.ok()) {
      // The levels above this one report what cannot be read.
      if (context_.options.level < CheckLevel::kDecode) reportUnreadable(number, loaded.error(), report);
      return;
    }
    const LoadedTile& tile = *loaded.value();
    const std::int64_t leaf = geometry_.header().leaf_cells;
    const PostRange columns = geometry_.nodeColumnsAt(0), rows = geometry_.nodeRowsAt(0);
    // A post on a shared border belongs to one leaf only, so that it is compared and counted once.
    for (std::int64_t row = std::max(tile.rows.begin, source_.header.y_axis.first);
         row < std::min(tile.rows.end, rowsEnd()); ++row) {
      if (ownerOf(row, leaf, rows) != record.y) continue;
      for (std::int64_t column = std::max(tile.columns.begin, source_.header.x_axis.first);
           column < std::min(tile.columns.end, columnsEnd()); ++column) {
        if (ownerOf(column, leaf, columns) == record.x) comparePost(number, tile, column, row, report);
      }
    }
  }

  void reportUnreadable(std::uint32_t number, const Error& error, Report& report) {
    const NodeRecord& record = context_.record(number);
    const auto segment = context_.segments.find(record.segment);
    if (segment == context_.segments.end() || !segment->second->container) return;
    const auto& damaged = segment->second->damaged_blocks;
    if (record.block < damaged.size() && damaged[record.block] != 0) return;
    IssueLocation where = context_.locate(number);
    where.file = segment->second->reference.name;
    where.block = record.block;
    if (error.code != IssueCode::kRefData) addError(report, error, where);
  }

  void comparePost(std::uint32_t number, const LoadedTile& tile, std::int64_t column, std::int64_t row,
                   Report& report) {
    ++report.posts_compared;
    const std::int64_t source_column = column - source_.header.x_axis.first;
    const std::int64_t source_row = row - source_.header.y_axis.first;
    const bool valid = tile.isValid(column, row), source_valid = source_.isValid(source_column, source_row);
    if (!valid && !source_valid) return;
    const auto where = [&] {
      IssueLocation location = context_.locate(number);
      location.file = context_.segments.at(context_.record(number).segment)->reference.name;
      location.block = context_.record(number).block;
      location.longitude = geometry_.longitude(column);
      location.latitude = geometry_.latitude(row);
      return location;
    };
    if (valid != source_valid) {
      addLazily(report, IssueCode::kSrcVoid, 0.0, [&] {
        return makeIssue(
            IssueCode::kSrcVoid,
            valid ? "a height here, a void in the source" : "a void here, a height in the source", where(),
            0.0);
      });
      return;
    }
    const std::int32_t height = tile.height(column, row),
                       source_height = source_.height(source_column, source_row);
    if (height == source_height) return;
    const double ours = geometry_.metres(height), theirs = geometry_.metres(source_height);
    const double metres = std::abs(ours - theirs);
    addLazily(report, IssueCode::kSrcHeight, metres, [&] {
      return makeIssue(IssueCode::kSrcHeight,
                       fmt::format("height {} m, in the source {} m ({} m apart)", ours, theirs, metres),
                       where(), metres);
    });
  }

  CheckContext& context_;
  const RawGrid& source_;
  const GridGeometry& geometry_;
  TileLoader loader_;
};

}  // namespace

void checkAgainstSource(CheckContext& context) {
  if (!context.tree_sound) {
    addSkipped(context.report, fmt::format("heights against {}, since the tree of nodes is damaged",
                                           context.options.against_name));
    return;
  }
  SourceRule(context, *context.options.against).run();
}

}  // namespace deltaz
