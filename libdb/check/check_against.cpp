// The full-resolution posts against the sources they came from, post for post and void for void: each grid of
// the sources against the grid of the database that has its posts.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "libdb/check/check_context.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"
#include "libdb/check/tile_loader.h"
#include "libdb/source/grid_placement.h"
#include "libdb/source/grid_surface.h"

namespace deltaz {
namespace {

// Posts of two grids are the same ones if they lie within this fraction of their spacing: far below a
// millimetre of any DEM, far above the rounding of a geotransform written as text.
constexpr double kSamePostFraction = 1e-6;

// Heights told in different quanta agree if they are this close beyond what rounding explains.
constexpr double kSameHeight = 1e-7;  // metres

struct Origins {
  AxisOrigin x, y;
};
Origins originsOf(const GridHeader& header) {
  if (header.kind == "geodetic") return {kLongitudeOrigin, kLatitudeOrigin};
  return {kProjectedOrigin, kProjectedOrigin};
}

std::string optionOf(const AreaHeader& area, std::string_view name) {
  for (const auto& [option, value] : area.options) {
    if (option == name) return value;
  }
  return {};
}

// Where the source's first post lies on the database's axes; nothing if its posts are not posts of theirs.
struct Offset {
  std::int64_t column = 0, row = 0;
};

std::optional<std::int64_t> indexOn(const GridAxis& ours, const GridAxis& theirs, const AxisOrigin& origin) {
  return indexOnAxis(ours, theirs, origin, kSamePostFraction * ours.spacing);
}

std::optional<Offset> offsetOf(const GridHeader& ours, const GridHeader& theirs) {
  if (ours.kind != theirs.kind) return std::nullopt;
  const Origins origins = originsOf(ours);
  auto column = indexOn(ours.x_axis, theirs.x_axis, origins.x);
  const auto row = indexOn(ours.y_axis, theirs.y_axis, origins.y);
  if (!column || !row) return std::nullopt;
  const double turn = 360 / ours.x_axis.spacing;
  if (ours.kind == "geodetic" && std::abs(turn - std::round(turn)) < 1e-6) {
    // The same meridian may have been named once from the west and once from the east.
    const std::int64_t posts = std::llround(turn);
    while (*column - ours.x_axis.first > posts / 2) *column -= posts;
    while (ours.x_axis.first - *column > posts / 2) *column += posts;
  }
  return Offset{*column, *row};
}

class SourceRule {
 public:
  SourceRule(CheckContext& context, const RawGrid& source, std::uint16_t grid)
      : context_(context),
        source_(source),
        grid_(grid),
        geometry_(context.grids[grid]),
        loader_(context),
        cut_(!optionOf(context.area, "bounds").empty()),
        filled_(optionOf(context.area, "void") == "fill") {}

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
      if (record.type == NodeType::kTerrain && record.grid == grid_ && record.level == 0)
        leaves.push_back(number);
    }
    const std::uint64_t before = context_.report.posts_compared;
    parallelReport(context_.report, leaves.size(), 16,
                   [&](std::size_t item, Report& report) { compareLeaf(leaves[item], report); });
    loader_.reportRefusedReads(context_.report);
    const std::int64_t columns = std::min(columnsEnd(), geometry_.columnsAt(0).end) -
                                 std::max(at_.column, geometry_.columnsAt(0).begin);
    const std::int64_t rows =
        std::min(rowsEnd(), geometry_.rowsAt(0).end) - std::max(at_.row, geometry_.rowsAt(0).begin);
    const std::uint64_t expected =
        columns > 0 && rows > 0 ? static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) : 0;
    const std::uint64_t compared = context_.report.posts_compared - before;
    if (compared < expected) {
      addSkipped(context_.report,
                 fmt::format("{} of {} posts against {}, since their nodes could not be read",
                             expected - compared, expected, context_.options.against_name));
    }
  }

 private:
  std::int64_t columnsEnd() const { return at_.column + source_.header.x_axis.count; }
  std::int64_t rowsEnd() const { return at_.row + source_.header.y_axis.count; }

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
    if (ours.kind != theirs.kind) return false;
    const Origins origins = originsOf(ours);
    if (!indexOn(ours.x_axis, theirs.x_axis, origins.x)) differ("columns are not where the source's are");
    if (!indexOn(ours.y_axis, theirs.y_axis, origins.y)) differ("rows are not where the source's are");
    if (same && !checkPatches()) {
      differ("posts of one projection lie at different places on the Earth");
    }
    if (same) at_ = *offsetOf(ours, theirs);
    return same;
  }

  // Equal coordinates mean equal places: another projection with like axes lies elsewhere.
  bool checkPatches() const {
    if (geometry_.isGeodetic() || source_.patches == nullptr || !context_.positions_known) return true;
    const GridGeometry theirs(source_.header, source_.patches);
    const GridAxis& x = source_.header.x_axis;
    const GridAxis& y = source_.header.y_axis;
    const Offset offset = *offsetOf(geometry_.header(), source_.header);
    for (const std::int64_t column : {std::int64_t{0}, x.count / 2, x.count - 1}) {
      for (const std::int64_t row : {std::int64_t{0}, y.count / 2, y.count - 1}) {
        const std::int64_t our_column = offset.column + column, our_row = offset.row + row;
        const PostRange columns = geometry_.columnsAt(0), rows = geometry_.rowsAt(0);
        if (our_column < columns.begin || our_column >= columns.end || our_row < rows.begin ||
            our_row >= rows.end)
          continue;
        const Vector3 difference = geometry_.placeAt(our_column, our_row).foot -
                                   theirs.placeAt(x.first + column, y.first + row).foot;
        if (length(difference) > kSamePlace) return false;
      }
    }
    return true;
  }
  static constexpr double kSamePlace = 1e-2;  // metres

  void checkExtent() {
    const auto check = [&](const GridAxis& ours, std::int64_t first, std::int64_t count, const char* what) {
      if (ours.first == first && ours.count == count) return;
      // An area that was cut on purpose may be smaller than its sources.
      if (cut_ && ours.first >= first && ours.first + ours.count <= first + count) return;
      complain(IssueCode::kSrcExtent,
               fmt::format("the database has {} {} from {} on, the source {} from {} on", ours.count, what,
                           ours.first, count, first));
    };
    check(geometry_.header().x_axis, at_.column, source_.header.x_axis.count, "columns");
    check(geometry_.header().y_axis, at_.row, source_.header.y_axis.count, "rows");
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
    for (std::int64_t row = std::max(tile.rows.begin, at_.row); row < std::min(tile.rows.end, rowsEnd());
         ++row) {
      if (ownerOf(row, leaf, rows) != record.y) continue;
      for (std::int64_t column = std::max(tile.columns.begin, at_.column);
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
    const std::int64_t source_column = column - at_.column;
    const std::int64_t source_row = row - at_.row;
    const bool valid = tile.isValid(column, row), source_valid = source_.isValid(source_column, source_row);
    if (!valid && !source_valid) return;
    if (filled_ && !source_valid) return;
    const auto where = [&] {
      IssueLocation location = context_.locate(number);
      location.file = context_.segments.at(context_.record(number).segment)->reference.name;
      location.block = context_.record(number).block;
      if (geometry_.isGeodetic() || context_.positions_known) {
        const GeodeticPoint point = geometry_.geodeticAt(column, row);
        location.longitude = point.longitude;
        location.latitude = point.latitude;
      }
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
    const bool same_quantum = geometry_.header().quantum == source_.header.quantum;
    if (same_quantum && height == source_height) return;
    const double ours = geometry_.metres(height);
    const double theirs = static_cast<double>(source_height) * source_.header.quantum.value();
    const double metres = std::abs(ours - theirs);
    if (!same_quantum &&
        metres <= geometry_.header().height_error + source_.header.height_error + kSameHeight)
      return;
    addLazily(report, IssueCode::kSrcHeight, metres, [&] {
      return makeIssue(IssueCode::kSrcHeight,
                       fmt::format("height {} m, in the source {} m ({} m apart)", ours, theirs, metres),
                       where(), metres);
    });
  }

  CheckContext& context_;
  const RawGrid& source_;
  const std::uint16_t grid_;
  const GridGeometry& geometry_;
  TileLoader loader_;
  const bool cut_, filled_;
  Offset at_;
};

// A resampled grid has no source's posts: its surface may lie as far from them as it says, and no farther.
void checkResampled(CheckContext& context, std::uint16_t grid) {
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

bool sameFiles(const GridHeader& a, const GridHeader& b) {
  return std::equal(a.sources.begin(), a.sources.end(), b.sources.begin(), b.sources.end(),
                    [](const auto& one, const auto& other) { return one.content == other.content; });
}

// The grid that has the source's posts, and names its files if several have such posts; if there is none, the
// one in its place, so that the differences can be told.
std::uint16_t gridFor(const CheckContext& context, const RawGrid& source, std::size_t place) {
  std::size_t best = std::min(place, context.grids.size() - 1);
  std::int64_t most_shared = 0;
  bool names_files = false;
  for (std::size_t grid = 0; grid < context.grids.size(); ++grid) {
    const GridHeader& ours = context.grids[grid].header();
    const std::optional<Offset> at = offsetOf(ours, source.header);
    if (!at || ours.resampling) continue;
    const auto shared = [](const GridAxis& axis, std::int64_t first, std::int64_t count) {
      return std::max<std::int64_t>(
          0, std::min(axis.first + axis.count, first + count) - std::max(axis.first, first));
    };
    const std::int64_t posts = shared(ours.x_axis, at->column, source.header.x_axis.count) *
                               shared(ours.y_axis, at->row, source.header.y_axis.count);
    const bool names = posts > 0 && sameFiles(ours, source.header);
    if (names != names_files ? names_files : posts <= most_shared) continue;
    most_shared = posts;
    names_files = names;
    best = grid;
  }
  return static_cast<std::uint16_t>(best);
}

}  // namespace

void checkAgainstSource(CheckContext& context) {
  if (!context.tree_sound) {
    addSkipped(context.report, fmt::format("heights against {}, since the tree of nodes is damaged",
                                           context.options.against_name));
    return;
  }
  // Resampling makes one grid of all sources.
  if (context.grids.size() == 1 && context.grids[0].header().resampling) {
    checkResampled(context, 0);
    return;
  }
  for (std::size_t k = 0; k < context.options.against_count; ++k) {
    const RawGrid& source = context.options.against[k];
    SourceRule(context, source, gridFor(context, source, k)).run();
  }
}

}  // namespace deltaz
