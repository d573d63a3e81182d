// The full-resolution posts against the sources they came from, post for post and void for void: each grid of
// the database against all sources it was made from, the earlier named first.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "libdb/check/check_context.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"
#include "libdb/check/source_matching.h"
#include "libdb/check/tile_loader.h"

namespace deltaz {
namespace {

// Heights told in different quanta agree if they are this close beyond what rounding explains.
constexpr double kSameHeight = 1e-7;  // metres

// What is known of a source of a grid: its posts, or only where they stand.
struct PlacedSource {
  const RawGrid* posts = nullptr;
  PostRectangle at;
  std::size_t rank = 0;  // among the grid's sources
};

class GridRule {
 public:
  // `matched` are the given sources of `grid`; `listed` of area.json's are the ones that count.
  GridRule(CheckContext& context, std::uint16_t grid, std::span<const MatchedSource> matched,
           std::span<const std::size_t> listed)
      : context_(context),
        grid_(grid),
        geometry_(context.grids[grid]),
        places_(geometry_.header()),
        loader_(context),
        cut_(!optionOf(context.area, "bounds").empty()),
        filled_(optionOf(context.area, "void") == "fill") {
    std::vector<std::size_t> absent(listed.begin(), listed.end());
    for (const MatchedSource& source : matched) {
      const bool there = sameGeoreference(*source.source);
      if (there) {
        for (const std::size_t k : source.listed) absent.erase(std::find(absent.begin(), absent.end(), k));
        given_.push_back({source.source, *places_.of(source.source->header),
                          source.listed.empty() ? listed.size() : source.listed.front()});
      }
      elsewhere_ = elsewhere_ || !there;
    }
    std::sort(given_.begin(), given_.end(),
              [](const PlacedSource& a, const PlacedSource& b) { return a.rank < b.rank; });
    for (const std::size_t k : absent) {
      const SourceDescription& source = geometry_.header().sources[k];
      absent_.push_back({nullptr, places_.of(source), k});
      absent_names_ += (absent_names_.empty() ? "" : ", ") + source.name;
    }
  }

  void run() {
    const PostRectangle ours = rectangleOf(geometry_.header());
    if (given_.empty()) {
      skip(postsOf(ours));
      return;
    }
    reach_ = given_.front().at;
    for (const PlacedSource& source : given_) reach_ = hull(reach_, source.at);
    for (const PlacedSource& source : absent_) reach_ = hull(reach_, source.at);
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
    if (hidden_ > 0) skip(hidden_);
    const auto expected = static_cast<std::uint64_t>(postsOf(intersection(ours, reach_)));
    const std::uint64_t seen = context_.report.posts_compared - before + static_cast<std::uint64_t>(hidden_);
    if (seen < expected) {
      addSkipped(context_.report,
                 fmt::format("{} of {} posts of grid {} against {}, since their nodes could not be read",
                             expected - seen, expected, grid_, context_.options.against_name));
    }
  }

 private:
  struct Nearby {
    std::vector<PlacedSource> given, absent;
  };

  void skip(std::int64_t posts) {
    std::string why = absent_names_.empty()
                          ? "no source of theirs is given"
                          : fmt::format("{}, where they come from, is not given", absent_names_);
    if (elsewhere_) why = "the posts of the source are elsewhere";
    addSkipped(context_.report,
               fmt::format("{} posts of grid {} against their source: {}", posts, grid_, why));
  }

  void complain(IssueCode code, std::string message) {
    IssueLocation where;
    where.file = std::string(kAreaFileName);
    context_.report.add(makeIssue(code, std::move(message), where));
  }

  bool sameGeoreference(const RawGrid& source) {
    const GridHeader& ours = geometry_.header();
    const GridHeader& theirs = source.header;
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
    if (!places_.columnOf(theirs.x_axis)) differ("columns are not where the source's are");
    if (!places_.rowOf(theirs.y_axis)) differ("rows are not where the source's are");
    if (same && !checkPatches(source)) {
      differ("posts of one projection lie at different places on the Earth");
    }
    return same;
  }

  // Equal coordinates mean equal places: another projection with like axes lies elsewhere.
  bool checkPatches(const RawGrid& source) const {
    if (geometry_.isGeodetic() || source.patches == nullptr || !context_.positions_known) return true;
    const GridGeometry theirs(source.header, source.patches);
    const GridAxis& x = source.header.x_axis;
    const GridAxis& y = source.header.y_axis;
    const PostRectangle at = *places_.of(source.header), ours = rectangleOf(geometry_.header());
    for (const std::int64_t column : {std::int64_t{0}, x.count / 2, x.count - 1}) {
      for (const std::int64_t row : {std::int64_t{0}, y.count / 2, y.count - 1}) {
        const std::int64_t our_column = at.columns.begin + column, our_row = at.rows.begin + row;
        if (!ours.holds(our_column, our_row)) continue;
        const Vector3 difference = geometry_.placeAt(our_column, our_row).foot -
                                   theirs.placeAt(x.first + column, y.first + row).foot;
        if (length(difference) > kSamePlace) return false;
      }
    }
    return true;
  }
  static constexpr double kSamePlace = 1e-2;  // metres

  void checkExtent() {
    const auto check = [&](const GridAxis& ours, PostRange theirs, const char* what) {
      if (ours.first == theirs.begin && ours.count == theirs.size()) return;
      // An area that was cut on purpose may be smaller than its sources.
      if (cut_ && ours.first >= theirs.begin && ours.first + ours.count <= theirs.end) return;
      complain(IssueCode::kSrcExtent,
               fmt::format("the database has {} {} from {} on, the source {} from {} on", ours.count, what,
                           ours.first, theirs.size(), theirs.begin));
    };
    check(geometry_.header().x_axis, reach_.columns, "columns");
    check(geometry_.header().y_axis, reach_.rows, "rows");
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
    const PostRectangle here = intersection({tile.columns, tile.rows}, reach_);
    Nearby nearby;
    for (const PlacedSource& source : given_) {
      if (postsOf(intersection(source.at, here)) > 0) nearby.given.push_back(source);
    }
    for (const PlacedSource& source : absent_) {
      if (postsOf(intersection(source.at, here)) > 0) nearby.absent.push_back(source);
    }
    // A post on a shared border belongs to one leaf only, so that it is compared and counted once.
    for (std::int64_t row = here.rows.begin; row < here.rows.end; ++row) {
      if (ownerOf(row, leaf, rows) != record.y) continue;
      for (std::int64_t column = here.columns.begin; column < here.columns.end; ++column) {
        if (ownerOf(column, leaf, columns) == record.x)
          comparePost(number, tile, column, row, nearby, report);
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
                   const Nearby& nearby, Report& report) {
    const auto holds = [&](const PlacedSource& source) { return source.at.holds(column, row); };
    // Its height may be that of a source nobody has shown.
    if (std::any_of(nearby.absent.begin(), nearby.absent.end(), holds)) {
      ++hidden_;
      return;
    }
    ++report.posts_compared;
    const bool valid = tile.isValid(column, row);
    // The first of the sources that has a height there; what none covers is void.
    const auto found =
        std::find_if(nearby.given.begin(), nearby.given.end(), [&](const PlacedSource& source) {
          return holds(source) &&
                 source.posts->isValid(column - source.at.columns.begin, row - source.at.rows.begin);
        });
    const bool source_valid = found != nearby.given.end();
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
    const GridHeader& ours_header = geometry_.header();
    const GridHeader& theirs_header = found->posts->header;
    const std::int32_t height = tile.height(column, row);
    const std::int32_t source_height =
        found->posts->height(column - found->at.columns.begin, row - found->at.rows.begin);
    const bool same_quantum = ours_header.quantum == theirs_header.quantum;
    if (same_quantum && height == source_height) return;
    const double ours = geometry_.metres(height);
    const double theirs = static_cast<double>(source_height) * theirs_header.quantum.value();
    const double metres = std::abs(ours - theirs);
    if (!same_quantum && metres <= ours_header.height_error + theirs_header.height_error + kSameHeight)
      return;
    addLazily(report, IssueCode::kSrcHeight, metres, [&] {
      return makeIssue(IssueCode::kSrcHeight,
                       fmt::format("height {} m, in the source {} m ({} m apart)", ours, theirs, metres),
                       where(), metres);
    });
  }

  CheckContext& context_;
  const std::uint16_t grid_;
  const GridGeometry& geometry_;
  const SourcePlaces places_;
  TileLoader loader_;
  const bool cut_, filled_;
  std::vector<PlacedSource> given_, absent_;
  std::string absent_names_;
  bool elsewhere_ = false;
  PostRectangle reach_;                  // of all sources
  std::atomic<std::int64_t> hidden_{0};  // posts that sources cover which are not given
};

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
  SourceMatching matching = matchSources(context);
  for (const std::string& name : matching.outside) {
    context.report.notes.push_back(
        fmt::format("{} has no heights within the bounds the area was cut to: nothing to compare", name));
  }
  const auto listed =
      std::stable_partition(matching.matched.begin(), matching.matched.end(),
                            [](const MatchedSource& source) { return source.listed.empty(); });
  for (std::uint16_t grid = 0; grid < context.grids.size(); ++grid) {
    std::vector<MatchedSource> its;
    std::copy_if(listed, matching.matched.end(), std::back_inserter(its),
                 [grid](const MatchedSource& source) { return source.grid == grid; });
    std::vector<std::size_t> all(context.grids[grid].header().sources.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    GridRule(context, grid, its, all).run();
  }
  // What is no source of any grid is told how it differs from the one in its place.
  for (auto source = matching.matched.begin(); source != listed; ++source)
    GridRule(context, source->grid, std::span(&*source, 1), {}).run();
}

}  // namespace deltaz
