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
#include "libdb/source/gdal_session.h"

namespace deltaz {
namespace {

// Heights told in different quanta agree if they are this close beyond what rounding explains.
constexpr double kSameHeight = 1e-7;  // metres

// What is known of a source of a grid: its posts, or only where they stand.
struct PlacedSource {
  const RawGrid* posts = nullptr;
  PostRectangle at;
  std::size_t rank = 0;  // among the grid's sources
  bool isValid(std::int64_t column, std::int64_t row) const {
    return posts->isValid(column - at.columns.begin, row - at.rows.begin);
  }
  std::int32_t height(std::int64_t column, std::int64_t row) const {
    return posts->height(column - at.columns.begin, row - at.rows.begin);
  }
};

// What the sources say of a post: void without a source.
struct Promise {
  bool covered = false;
  const PlacedSource* source = nullptr;
  std::int64_t column = 0;
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
    if (places_.turn() > 0) offsets_ = {0, -places_.turn(), places_.turn()};
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
    if (goesRound()) reach_.columns = ours.columns;
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
    std::string why = "no source is given that could be theirs";
    if (!absent_names_.empty()) why = fmt::format("{} is not given", absent_names_);
    if (elsewhere_) why = "the source given for them has its posts elsewhere";
    addSkipped(context_.report, fmt::format("{} posts of grid {}, since {}", posts, grid_, why));
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

  bool goesRound() const { return places_.turn() > 0 && reach_.columns.size() >= places_.turn(); }

  void checkExtent() {
    PostRange columns = reach_.columns;
    const std::int64_t turn = places_.turn(), first = geometry_.header().x_axis.first;
    if (goesRound()) {
      // The first column of a full turn may be there again as its last, and a cut may run on past that.
      columns.end = columns.begin + std::max(columns.size(), turn + 1);
      const std::int64_t turns = floorDivide(first - columns.begin, turn);
      columns = {columns.begin + turns * turn, columns.end + (cut_ ? turns + 1 : turns) * turn};
    }
    const auto check = [&](const GridAxis& ours, PostRange theirs, const char* what) {
      if (ours.first == theirs.begin && ours.count == theirs.size()) return;
      // An area that was cut on purpose may be smaller than its sources.
      if (cut_ && ours.first >= theirs.begin && ours.first + ours.count <= theirs.end) return;
      complain(IssueCode::kSrcExtent,
               fmt::format("the database has {} {} from {} on, the source {} from {} on", ours.count, what,
                           ours.first, theirs.size(), theirs.begin));
    };
    check(geometry_.header().x_axis, columns, "columns");
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
    const auto isNear = [&](const PlacedSource& source) {
      return std::any_of(offsets_.begin(), offsets_.end(), [&](std::int64_t offset) {
        const PostRectangle there = {{here.columns.begin + offset, here.columns.end + offset}, here.rows};
        return postsOf(intersection(source.at, there)) > 0;
      });
    };
    std::copy_if(given_.begin(), given_.end(), std::back_inserter(nearby.given), isNear);
    std::copy_if(absent_.begin(), absent_.end(), std::back_inserter(nearby.absent), isNear);
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

  // The first of the sources that has a height there.
  static Promise promiseAt(const Nearby& nearby, std::int64_t column, std::int64_t row) {
    Promise promise;
    promise.column = column;
    for (const PlacedSource& source : nearby.given) {
      if (!source.at.holds(column, row)) continue;
      promise.covered = true;
      if (!source.isValid(column, row)) continue;
      promise.source = &source;
      break;
    }
    return promise;
  }

  void comparePost(std::uint32_t number, const LoadedTile& tile, std::int64_t column, std::int64_t row,
                   const Nearby& nearby, Report& report) {
    const bool hidden = std::any_of(nearby.absent.begin(), nearby.absent.end(), [&](const auto& source) {
      return std::any_of(offsets_.begin(), offsets_.end(),
                         [&](std::int64_t offset) { return source.at.holds(column + offset, row); });
    });
    // Its height may be that of a source nobody has shown.
    if (hidden) {
      ++hidden_;
      return;
    }
    ++report.posts_compared;
    // A meridian where sources begin and end that go round the Earth may hold what either says.
    Promise first;
    for (const std::int64_t offset : offsets_) {
      const Promise promise = promiseAt(nearby, column + offset, row);
      if (!promise.covered) continue;
      if (isKept(promise, tile, column, row)) return;
      if (!first.covered) first = promise;
    }
    // What no source covers is void.
    if (first.covered || !isKept(first, tile, column, row))
      reportDifference(number, first, tile, column, row, report);
  }

  bool isKept(const Promise& promise, const LoadedTile& tile, std::int64_t column, std::int64_t row) const {
    const bool valid = tile.isValid(column, row);
    if (promise.source == nullptr) return !valid || filled_;
    if (!valid) return false;
    const GridHeader& ours = geometry_.header();
    const GridHeader& theirs = promise.source->posts->header;
    if (ours.quantum == theirs.quantum)
      return tile.height(column, row) == promise.source->height(promise.column, row);
    return difference(promise, tile, column, row) <= ours.height_error + theirs.height_error + kSameHeight;
  }

  double metresOf(const Promise& promise, std::int64_t row) const {
    return static_cast<double>(promise.source->height(promise.column, row)) *
           promise.source->posts->header.quantum.value();
  }
  double difference(const Promise& promise, const LoadedTile& tile, std::int64_t column,
                    std::int64_t row) const {
    return std::abs(geometry_.metres(tile.height(column, row)) - metresOf(promise, row));
  }

  void reportDifference(std::uint32_t number, const Promise& promise, const LoadedTile& tile,
                        std::int64_t column, std::int64_t row, Report& report) const {
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
    const bool valid = tile.isValid(column, row);
    if (!valid || promise.source == nullptr) {
      addLazily(report, IssueCode::kSrcVoid, 0.0, [&] {
        return makeIssue(
            IssueCode::kSrcVoid,
            valid ? "a height here, a void in the source" : "a void here, a height in the source", where(),
            0.0);
      });
      return;
    }
    const double metres = difference(promise, tile, column, row);
    addLazily(report, IssueCode::kSrcHeight, metres, [&] {
      return makeIssue(
          IssueCode::kSrcHeight,
          fmt::format("height {} m, in the source {} m ({} m apart)",
                      geometry_.metres(tile.height(column, row)), metresOf(promise, row), metres),
          where(), metres);
    });
  }

  CheckContext& context_;
  const std::uint16_t grid_;
  const GridGeometry& geometry_;
  const SourcePlaces places_;
  TileLoader loader_;
  const bool cut_, filled_;
  std::vector<std::int64_t> offsets_ = {0};  // columns on, and the same meridian
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
  const GdalSession session;  // reference systems are asked for places, some in vain
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
