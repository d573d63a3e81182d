#include "libdb/check/source_matching.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "libdb/source/area_datum.h"
#include "libdb/source/full_turn.h"
#include "libdb/source/grid_cutting.h"
#include "libdb/source/grid_placement.h"
#include "libdb/source/reference_system.h"

namespace deltaz {
namespace {

// Posts of two grids are the same ones if they lie within this fraction of their spacing: far below a
// millimetre of any DEM, far above the rounding of a geotransform written as text.
constexpr double kSamePostFraction = 1e-6;

PostRange shifted(PostRange range, std::int64_t by) {
  return {range.begin + by, range.end + by};
}
PostRange shared(PostRange a, PostRange b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

bool isGeographic(const GridHeader& grid) {
  if (grid.kind == "geodetic") return true;
  // Latitudes and longitudes of another datum than the area's are kept like those of a projection.
  const Result<ReferenceSystem> system =
      parseReferenceSystem(grid.crs_wkt, std::string(kAreaFileName), grid.coordinate_epoch);
  return system.ok() && !system.value().projected;
}

// ---- which source is which

// How sure it is that a given source is a listed one, the surest first.
enum class Likeness : std::uint8_t { kNameAndContent, kContent, kName };

bool alike(const SourceDescription& a, const SourceDescription& b, Likeness likeness) {
  switch (likeness) {
    case Likeness::kNameAndContent:
      return a.name == b.name && a.content == b.content && a.band == b.band;
    case Likeness::kContent:
      return a.content == b.content && a.band == b.band;
    case Likeness::kName:
      return a.name == b.name;
  }
  return false;
}

class Matcher {
 public:
  explicit Matcher(const CheckContext& context) : context_(context) {
    for (const GridGeometry& grid : context.grids) {
      places_.emplace_back(grid.header());
      taken_.emplace_back(grid.header().sources.size(), false);
    }
    for (std::size_t k = 0; k < context.options.against_count; ++k) waiting_.push_back(k);
  }

  SourceMatching run() {
    for (const Likeness likeness : {Likeness::kNameAndContent, Likeness::kContent, Likeness::kName}) {
      passOver([&](std::size_t given) { return matchAlike(given, likeness); });
    }
    passOver([&](std::size_t given) { return isOutside(given); });
    passOver([&](std::size_t given) { return matchByPosts(given, true); });
    passOver([&](std::size_t given) { return matchByPosts(given, false); });
    // Of the same posts as nothing in the area: compared with the grid in its place, to tell how they differ.
    passOver([&](std::size_t given) {
      const std::size_t grid = gridInPlaceOf(given);
      result_.matched.push_back({&source(given), static_cast<std::uint16_t>(grid), {}});
      return true;
    });
    return std::move(result_);
  }

 private:
  const RawGrid& source(std::size_t given) const { return context_.options.against[given]; }
  const GridHeader& header(std::size_t grid) const { return context_.grids[grid].header(); }

  template <typename Match>
  void passOver(Match match) {
    std::vector<std::size_t> left;
    for (const std::size_t given : waiting_) {
      if (!match(given)) left.push_back(given);
    }
    waiting_ = std::move(left);
  }

  void take(std::size_t given, std::size_t grid, std::vector<std::size_t> listed) {
    for (const std::size_t k : listed) taken_[grid][k] = true;
    result_.matched.push_back({&source(given), static_cast<std::uint16_t>(grid), std::move(listed)});
  }

  // All files of the given source are files of one grid, or of two that bounds made of it.
  bool matchAlike(std::size_t given, Likeness likeness) {
    const std::vector<SourceDescription>& files = source(given).header.sources;
    if (files.empty()) return false;
    bool known = false, matched = false;
    for (std::size_t grid = 0; grid < places_.size(); ++grid) {
      std::vector<std::size_t> listed;
      const bool all = std::all_of(files.begin(), files.end(), [&](const SourceDescription& file) {
        const std::optional<std::size_t> found = findListed(grid, file, likeness, listed, known);
        if (found) listed.push_back(*found);
        return found.has_value();
      });
      if (!all) continue;
      take(given, grid, std::move(listed));
      matched = true;
    }
    // The same file may have been named twice.
    return matched || (known && likeness == Likeness::kNameAndContent);
  }

  // The first source of a grid that is like `file` and not spoken for; `known` if there is one that is.
  std::optional<std::size_t> findListed(std::size_t grid, const SourceDescription& file, Likeness likeness,
                                        const std::vector<std::size_t>& besides, bool& known) const {
    const std::vector<SourceDescription>& sources = header(grid).sources;
    for (std::size_t k = 0; k < sources.size(); ++k) {
      if (!alike(sources[k], file, likeness)) continue;
      const bool used = std::find(besides.begin(), besides.end(), k) != besides.end();
      if (!taken_[grid][k] && !used) return k;
      known = known || taken_[grid][k];
    }
    return std::nullopt;
  }

  std::int64_t sharedPosts(std::size_t given, std::size_t grid) const {
    const std::optional<PostRectangle> at = places_[grid].of(source(given).header);
    return at ? postsOf(intersection(*at, rectangleOf(header(grid)))) : 0;
  }

  // The grid that has most of its posts. It stands for the sources it covers, or for the one it covers most
  // of.
  bool matchByPosts(std::size_t given, bool not_spoken_for) {
    std::optional<std::size_t> best;
    std::int64_t most = 0;
    for (std::size_t grid = 0; grid < places_.size(); ++grid) {
      if (header(grid).resampling) continue;
      const bool free = std::find(taken_[grid].begin(), taken_[grid].end(), false) != taken_[grid].end();
      if (not_spoken_for && !free) continue;
      const std::int64_t posts = sharedPosts(given, grid);
      if (posts <= most) continue;
      most = posts;
      best = grid;
    }
    if (!best) return false;
    std::vector<std::size_t> listed = standsFor(given, *best);
    // Of a source that bounds cut in two it stands for both sides.
    for (const std::size_t k : listed) {
      const SourceDescription& its = header(*best).sources[k];
      for (std::size_t grid = 0; grid < places_.size(); ++grid) {
        bool known = false;
        const auto other = findListed(grid, its, Likeness::kNameAndContent, {}, known);
        if (grid != *best && other && sharedPosts(given, grid) > 0) take(given, grid, {*other});
      }
    }
    take(given, *best, std::move(listed));
    return true;
  }

  std::vector<std::size_t> standsFor(std::size_t given, std::size_t grid) const {
    const PostRectangle at = *places_[grid].of(source(given).header);
    std::vector<std::size_t> listed;
    std::optional<std::size_t> most_of;
    std::int64_t most = 0;
    for (std::size_t k = 0; k < taken_[grid].size(); ++k) {
      if (taken_[grid][k]) continue;
      const PostRectangle its = places_[grid].of(header(grid).sources[k]);
      const std::int64_t posts = postsOf(intersection(at, its));
      if (posts == postsOf(its)) listed.push_back(k);
      if (posts <= most) continue;
      most = posts;
      most_of = k;
    }
    if (listed.empty() && most_of) listed.push_back(*most_of);
    return listed;
  }

  std::size_t gridInPlaceOf(std::size_t given) const {
    for (std::size_t grid = 0; grid < taken_.size(); ++grid) {
      if (std::find(taken_[grid].begin(), taken_[grid].end(), true) == taken_[grid].end()) return grid;
    }
    return std::min(given, taken_.size() - 1);
  }

  // ---- what the area was cut to

  // West, south, east and north as they stand in the provenance.
  std::optional<SourceBounds> recordedBounds() const {
    const std::string text = optionOf(context_.area, "bounds");
    std::array<double, 4> sides{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t k = 0; k < sides.size(); ++k) {
      if (k > 0 && (at == end || *at++ != ',')) return std::nullopt;
      const auto [next, failure] = std::from_chars(at, end, sides[k]);
      if (failure != std::errc{}) return std::nullopt;
      at = next;
    }
    if (at != end) return std::nullopt;
    return SourceBounds{sides[0], sides[1], sides[2], sides[3]};
  }

  bool isOutside(std::size_t given) {
    const std::optional<SourceBounds> bounds = recordedBounds();
    if (!bounds || !hasNothingWithin(source(given), *bounds)) return false;
    const std::vector<SourceDescription>& files = source(given).header.sources;
    result_.outside.push_back(files.empty() ? context_.options.against_name : files.front().name);
    return true;
  }

  bool hasNothingWithin(const RawGrid& given, const SourceBounds& bounds) const {
    const std::string where(kAreaFileName);
    const Result<ReferenceSystem> system =
        parseReferenceSystem(given.header.crs_wkt, where, given.header.coordinate_epoch);
    if (!system.ok()) return false;
    const std::optional<ReferenceSystem> area = datumOf(context_.area);
    if (!area) return false;
    const Result<std::vector<PostWindow>> windows =
        windowsWithin(given.header, system.value(), *area, bounds, true, where);
    return windows.ok() && std::all_of(windows.value().begin(), windows.value().end(),
                                       [&](const PostWindow& window) { return isVoidIn(given, window); });
  }

  static bool isVoidIn(const RawGrid& given, const PostWindow& window) {
    const std::int64_t turn = columnsInTurn(given.header);
    for (std::int64_t row = window.first_row; row < window.first_row + window.rows; ++row) {
      for (std::int64_t k = window.first_column; k < window.first_column + window.columns; ++k) {
        if (given.isValid(k < given.header.x_axis.count ? k : k - turn, row)) return false;
      }
    }
    return true;
  }

  const CheckContext& context_;
  std::vector<SourcePlaces> places_;
  std::vector<std::vector<bool>> taken_;  // grid, source of it
  std::vector<std::size_t> waiting_;
  SourceMatching result_;
};

}  // namespace

PostRectangle intersection(const PostRectangle& a, const PostRectangle& b) {
  return {shared(a.columns, b.columns), shared(a.rows, b.rows)};
}
PostRectangle hull(const PostRectangle& a, const PostRectangle& b) {
  const auto both = [](PostRange one, PostRange other) {
    return PostRange{std::min(one.begin, other.begin), std::max(one.end, other.end)};
  };
  return {both(a.columns, b.columns), both(a.rows, b.rows)};
}
std::int64_t postsOf(const PostRectangle& rectangle) {
  return rectangle.columns.size() * rectangle.rows.size();
}
PostRectangle rectangleOf(const GridHeader& grid) {
  return {{grid.x_axis.first, grid.x_axis.first + grid.x_axis.count},
          {grid.y_axis.first, grid.y_axis.first + grid.y_axis.count}};
}

AxisOrigins originsOf(const GridHeader& grid) {
  if (grid.kind == "geodetic") return {kLongitudeOrigin, kLatitudeOrigin};
  return {kProjectedOrigin, kProjectedOrigin};
}

std::string optionOf(const AreaHeader& area, std::string_view name) {
  for (const auto& [option, value] : area.options) {
    if (option == name) return value;
  }
  return {};
}

SourcePlaces::SourcePlaces(const GridHeader& grid) : grid_(grid), origins_(originsOf(grid)) {
  const bool geographic = isGeographic(grid);
  const double least = geographic ? kPlacementTolerance : kProjectedPlacementTolerance;
  tolerance_x_ = std::max(least, kSamePostFraction * grid.x_axis.spacing);
  tolerance_y_ = std::max(least, kSamePostFraction * grid.y_axis.spacing);
  const double turn = 360 / grid.x_axis.spacing;
  if (geographic && std::abs(turn - std::round(turn)) < 1e-6) turn_ = std::llround(turn);
}

std::optional<std::int64_t> SourcePlaces::columnOf(const GridAxis& source) const {
  return indexOnAxis(grid_.x_axis, source, origins_.x, tolerance_x_);
}
std::optional<std::int64_t> SourcePlaces::rowOf(const GridAxis& source) const {
  return indexOnAxis(grid_.y_axis, source, origins_.y, tolerance_y_);
}

std::optional<PostRectangle> SourcePlaces::of(const GridHeader& source) const {
  if (source.kind != grid_.kind) return std::nullopt;
  const std::optional<std::int64_t> column = columnOf(source.x_axis), row = rowOf(source.y_axis);
  if (!column || !row) return std::nullopt;
  return turned({{*column, *column + source.x_axis.count}, {*row, *row + source.y_axis.count}});
}

PostRectangle SourcePlaces::of(const SourceDescription& source) const {
  const std::array<double, 6>& transform = source.geotransform;
  const double first_row = transform[3] + 0.5 * transform[5];
  const double last_row = transform[3] + (static_cast<double>(source.rows) - 0.5) * transform[5];
  // Bounded, since the text may say anything.
  const auto nearest = [](const GridAxis& axis, const AxisOrigin& origin, double coordinate) {
    constexpr double kFar = 1e15;
    const double position = (coordinate - postCoordinate(axis, origin, axis.first)) / axis.spacing;
    return std::isnan(position) ? axis.first : axis.first + std::llround(std::clamp(position, -kFar, kFar));
  };
  const std::int64_t column = nearest(grid_.x_axis, origins_.x, transform[0] + 0.5 * transform[1]);
  const std::int64_t row = nearest(grid_.y_axis, origins_.y, std::min(first_row, last_row));
  return turned({{column, column + source.columns}, {row, row + source.rows}});
}

PostRectangle SourcePlaces::turned(PostRectangle rectangle) const {
  if (turn_ == 0) return rectangle;
  const PostRange ours = rectangleOf(grid_).columns;
  // The turn that brings the first column next to the grid's, and those beside it.
  const std::int64_t turns = floorDivide(ours.begin - rectangle.columns.begin, turn_);
  PostRectangle best = rectangle;
  std::int64_t most = shared(rectangle.columns, ours).size();
  for (std::int64_t k = turns - 1; k <= turns + 2; ++k) {
    PostRectangle there = rectangle;
    there.columns = shifted(rectangle.columns, k * turn_);
    const std::int64_t posts = shared(there.columns, ours).size();
    if (posts <= most) continue;
    most = posts;
    best = there;
  }
  return best;
}

SourceMatching matchSources(const CheckContext& context) {
  return Matcher(context).run();
}

std::vector<std::string> sourcesNotGiven(const CheckContext& context, std::uint16_t grid) {
  std::vector<SourceDescription> listed = context.grids[grid].header().sources, given;
  for (std::size_t k = 0; k < context.options.against_count; ++k) {
    const std::vector<SourceDescription>& files = context.options.against[k].header.sources;
    given.insert(given.end(), files.begin(), files.end());
  }
  for (const Likeness likeness : {Likeness::kNameAndContent, Likeness::kContent, Likeness::kName}) {
    for (auto file = given.begin(); file != given.end();) {
      const auto found = std::find_if(listed.begin(), listed.end(), [&](const SourceDescription& source) {
        return alike(source, *file, likeness);
      });
      if (found != listed.end()) listed.erase(found);
      file = found != listed.end() ? given.erase(file) : file + 1;
    }
  }
  // What is given under other names and in another form may be any of them.
  std::vector<std::string> names;
  if (listed.size() <= given.size()) return names;
  for (const SourceDescription& source : listed) names.push_back(source.name);
  return names;
}

}  // namespace deltaz
