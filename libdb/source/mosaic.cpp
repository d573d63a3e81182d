#include "libdb/source/mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "formats/terrain_segment.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/source/full_turn.h"
#include "libdb/source/grid_placement.h"
#include "libdb/source/height_units.h"
#include "libdb/source/simple_fraction.h"
#include "libdb/source/source_error.h"
#include "libdb/source/source_posts.h"

namespace deltaz {

namespace {

constexpr std::int64_t kMostPosts = std::int64_t{1} << 33;  // of a joined grid: 40 GB in memory

struct Origins {
  AxisOrigin x, y;
};
Origins originsOf(const GridHeader& header) {
  if (header.kind == "geodetic") return {kLongitudeOrigin, kLatitudeOrigin};
  return {kProjectedOrigin, kProjectedOrigin};
}

bool isWhole(const SourceDescription& source) {
  const std::optional<StoredType> type = storedTypeOf(source.data_type);
  return type && !type->floating;
}

// Whether one description of stored values can stand for both.
bool sameStorage(const SourceRaster& a, const SourceRaster& b) {
  const SourceDescription& of_a = a.grid.header.sources.front();
  const SourceDescription& of_b = b.grid.header.sources.front();
  const auto unitOf = [](const SourceRaster& raster, const SourceDescription& source) {
    return metresPerUnit(source.unit.empty() ? raster.system.vertical_unit : source.unit);
  };
  return of_a.scale == of_b.scale && of_a.offset == of_b.offset && unitOf(a, of_a) == unitOf(b, of_b) &&
         (of_a.data_type == of_b.data_type || (isWhole(of_a) && isWhole(of_b)));
}

// A quantum both can be told in without loss: nothing if that would have to be below a millimetre.
std::optional<Rational> commonQuantum(const Rational& a, const Rational& b) {
  if (a == b) return a;
  const std::optional<Rational> common = commonMeasure(a, b);
  if (!common || common->value() < kFinestExactQuantum) return std::nullopt;
  return common;
}

// Whether all heights can count in `quantum`, a whole fraction of theirs.
bool canRequantise(const RawGrid& grid, const Rational& quantum) {
  const std::optional<Rational> factor = quotient(grid.header.quantum, quantum);
  if (!factor || factor->denominator != 1) return false;
  const std::int64_t most = kMaximumHeightQuanta / factor->numerator;
  return std::all_of(grid.heights.begin(), grid.heights.end(),
                     [most](std::int32_t height) { return std::abs(std::int64_t{height}) <= most; });
}
void requantise(RawGrid& grid, const Rational& quantum) {
  if (grid.header.quantum == quantum) return;
  const std::optional<Rational> factor = quotient(grid.header.quantum, quantum);
  for (std::int32_t& height : grid.heights) height *= static_cast<std::int32_t>(factor->numerator);
  grid.header.quantum = quantum;
}

// Where a raster's first post lies on the lattice of another.
struct Offset {
  std::int64_t x = 0, y = 0;
};

std::optional<Offset> offsetOn(const SourceRaster& lattice, const SourceRaster& other) {
  const GridHeader& a = lattice.grid.header;
  const GridHeader& b = other.grid.header;
  if (a.kind != b.kind) return std::nullopt;
  const Origins origins = originsOf(a);
  const auto x = indexOnAxis(a.x_axis, b.x_axis, origins.x, placementTolerance(origins.x));
  const auto y = indexOnAxis(a.y_axis, b.y_axis, origins.y, placementTolerance(origins.y));
  if (!x || !y) return std::nullopt;
  const bool one_vertical =
      a.vertical_datum == b.vertical_datum || a.vertical_datum == "unknown" || b.vertical_datum == "unknown";
  if (!one_vertical || !sameStorage(lattice, other) || !sameHorizontalSystem(lattice.system, other.system))
    return std::nullopt;
  return Offset{*x, *y};
}

struct Placed {
  std::size_t raster = 0;
  Offset at;
};

// Ranges of posts that overlap or follow one another without a gap.
bool meet(std::int64_t first_a, std::int64_t count_a, std::int64_t first_b, std::int64_t count_b) {
  return first_a <= first_b + count_b && first_b <= first_a + count_a;
}

// The rasters that belong together, those of one group placed on the lattice of its first.
std::vector<std::vector<Placed>> groupsOf(const std::vector<SourceRaster>& rasters) {
  std::vector<std::vector<Placed>> groups;
  std::vector<bool> taken(rasters.size(), false);
  for (std::size_t first = 0; first < rasters.size(); ++first) {
    if (taken[first]) continue;
    const SourceRaster& lattice = rasters[first];
    std::vector<std::optional<Offset>> offsets(rasters.size());
    for (std::size_t k = first + 1; k < rasters.size(); ++k) {
      if (!taken[k]) offsets[k] = offsetOn(lattice, rasters[k]);
    }
    const std::int64_t turn = columnsInTurn(lattice.grid.header);
    std::vector<Placed> group = {
        {first, {lattice.grid.header.x_axis.first, lattice.grid.header.y_axis.first}}};
    taken[first] = true;
    Rational quantum = lattice.grid.header.quantum;
    // Grows from every member in turn; each neighbour takes the place next to it, also across the
    // antimeridian.
    for (std::size_t member = 0; member < group.size(); ++member) {
      for (std::size_t k = first + 1; k < rasters.size(); ++k) {
        if (taken[k] || !offsets[k]) continue;
        const GridHeader& header = rasters[k].grid.header;
        const GridHeader& beside = rasters[group[member].raster].grid.header;
        if (!meet(group[member].at.y, beside.y_axis.count, offsets[k]->y, header.y_axis.count)) continue;
        for (const std::int64_t shift : {std::int64_t{0}, turn, -turn}) {
          const Offset at = {offsets[k]->x + shift, offsets[k]->y};
          if (!meet(group[member].at.x, beside.x_axis.count, at.x, header.x_axis.count)) continue;
          const std::optional<Rational> common = commonQuantum(quantum, header.quantum);
          if (!common || !canRequantise(rasters[k].grid, *common)) break;
          const bool all = std::all_of(group.begin(), group.end(), [&](const Placed& placed) {
            return canRequantise(rasters[placed.raster].grid, *common);
          });
          if (!all) break;
          quantum = *common;
          taken[k] = true;
          group.push_back({k, at});
          break;
        }
      }
    }
    std::sort(group.begin(), group.end(),
              [](const Placed& a, const Placed& b) { return a.raster < b.raster; });
    groups.push_back(std::move(group));
  }
  return groups;
}

// ---- one group

class Join {
 public:
  Join(std::vector<SourceRaster>& rasters, const std::vector<Placed>& group,
       std::vector<std::string>& warnings)
      : rasters_(rasters), group_(group), warnings_(warnings) {}

  Result<SourceRaster> run() {
    Rational quantum = rasters_[group_.front().raster].grid.header.quantum;
    for (const Placed& placed : group_) {
      const std::optional<Rational> common =
          commonMeasure(quantum, rasters_[placed.raster].grid.header.quantum);
      if (common) quantum = *common;
    }
    const SourceRaster& first = rasters_[group_.front().raster];
    joined_.path = first.path;
    joined_.system = first.system;
    joined_.grid.header = first.grid.header;
    joined_.grid.header.quantum = quantum;
    DELTAZ_TRY(span());
    for (const Placed& placed : group_) add(placed, quantum);
    DELTAZ_TRY(nameUncovered());
    settle();
    return std::move(joined_);
  }

 private:
  Status span() {
    std::int64_t west = group_.front().at.x, south = group_.front().at.y, east = west, north = south;
    for (const Placed& placed : group_) {
      const GridHeader& header = rasters_[placed.raster].grid.header;
      west = std::min(west, placed.at.x);
      south = std::min(south, placed.at.y);
      east = std::max(east, placed.at.x + header.x_axis.count);
      north = std::max(north, placed.at.y + header.y_axis.count);
    }
    GridHeader& header = joined_.grid.header;
    header.x_axis.count = east - west;
    header.y_axis.count = north - south;
    west_ = west;
    south_ = south;
    const std::int64_t turn = columnsInTurn(header);
    if (turn > 0 && header.x_axis.count > turn + 1)
      return refusedSource(joined_.path, "the sources joined go more than once round the Earth");
    if (header.x_axis.count > kMostPosts / header.y_axis.count)
      return refusedSource(joined_.path, "the sources joined have too many posts", {}, "Build several areas");
    const auto posts = static_cast<std::size_t>(header.x_axis.count * header.y_axis.count);
    joined_.grid.heights.assign(posts, 0);
    covered_.assign(posts, 0);
    kinds_.assign(posts, 0);
    header.x_axis.first = west;
    header.y_axis.first = south;
    // The west edge in [-180, 180).
    while (turn > 0 && header.x_axis.first < 0) header.x_axis.first += turn;
    while (turn > 0 && header.x_axis.first >= turn) header.x_axis.first -= turn;
    header.sources.clear();
    header.sentinels.clear();
    return Success{};
  }

  std::uint8_t kindOf(double sentinel) {
    std::vector<double>& sentinels = joined_.grid.header.sentinels;
    for (std::size_t k = 0; k < sentinels.size(); ++k) {
      if (sentinels[k] == sentinel || (std::isnan(sentinels[k]) && std::isnan(sentinel)))
        return static_cast<std::uint8_t>(k);
    }
    // More different sentinels than a grid can list: the first stands for the rest.
    if (sentinels.size() == 64) return 0;
    sentinels.push_back(sentinel);
    return static_cast<std::uint8_t>(sentinels.size() - 1);
  }

  void add(const Placed& placed, const Rational& quantum) {
    SourceRaster& raster = rasters_[placed.raster];
    requantise(raster.grid, quantum);
    GridHeader& header = joined_.grid.header;
    const GridHeader& theirs = raster.grid.header;
    header.sources.push_back(theirs.sources.front());
    header.height_error = std::max(header.height_error, theirs.height_error);
    if (header.vertical_datum == "unknown") header.vertical_datum = theirs.vertical_datum;
    std::vector<std::uint8_t> kind_here;
    for (const double sentinel : theirs.sentinels) kind_here.push_back(kindOf(sentinel));
    std::size_t shared = 0, differing = 0;
    std::int64_t largest = 0;
    std::size_t from = 0;
    for (std::int64_t row = 0; row < theirs.y_axis.count; ++row) {
      auto to =
          static_cast<std::size_t>((placed.at.y - south_ + row) * header.x_axis.count + placed.at.x - west_);
      for (std::int64_t column = 0; column < theirs.x_axis.count; ++column, ++to, ++from) {
        const bool valid = raster.grid.valid.empty() || raster.grid.valid[from] != 0;
        if (!valid) {
          if (covered_[to] != kUncovered) continue;
          covered_[to] = kVoid;
          const std::uint8_t kind =
              raster.grid.void_kinds.empty() ? std::uint8_t{0} : raster.grid.void_kinds[from];
          kinds_[to] = kind < kind_here.size() ? kind_here[kind] : std::uint8_t{0};
          continue;
        }
        const std::int32_t height = raster.grid.heights[from];
        if (covered_[to] != kValid) {
          covered_[to] = kValid;
          kinds_[to] = 0;
          joined_.grid.heights[to] = height;
          continue;
        }
        ++shared;
        const std::int64_t difference = std::abs(std::int64_t{height} - joined_.grid.heights[to]);
        if (difference != 0) ++differing;
        largest = std::max(largest, difference);
      }
    }
    if (differing > 0) {
      warnings_.push_back(
          fmt::format("{}: {} of {} posts shared with sources named before it have another height, by up to "
                      "{} m; theirs are kept",
                      raster.path, differing, shared, static_cast<double>(largest) * quantum.value()));
    }
    raster.grid = RawGrid{};
  }

  // A grid is a rectangle: what no source covers is void, and an export writes a nodata value there.
  Status nameUncovered() {
    if (std::find(covered_.begin(), covered_.end(), kUncovered) == covered_.end()) return Success{};
    SourceDescription& source = joined_.grid.header.sources.front();
    if (!source.nodata) {
      DELTAZ_TRY_ASSIGN(source.nodata, unusedValue(source));
    }
    const std::uint8_t kind = kindOf(*source.nodata);
    for (std::size_t k = 0; k < covered_.size(); ++k) {
      if (covered_[k] == kUncovered) kinds_[k] = kind;
    }
    return Success{};
  }

  Result<double> unusedValue(const SourceDescription& source) const {
    const StoredType type = storedTypeOf(source.data_type).value_or(StoredType{});
    const Rational unit =
        metresPerUnit(source.unit.empty() ? joined_.system.vertical_unit : source.unit).value_or(Rational{});
    const StoredValues stored(source, type, unit, joined_.grid.header.quantum);
    return unusedStoredValue(type, joined_.path, [&](double value) {
      for (std::size_t k = 0; k < covered_.size(); ++k) {
        if (covered_[k] == kValid && stored.storedOf(joined_.grid.heights[k]) == value) return true;
      }
      return false;
    });
  }

  void settle() {
    if (std::find_if(covered_.begin(), covered_.end(), [](std::uint8_t c) { return c != kValid; }) ==
        covered_.end()) {
      joined_.grid.header.sentinels.clear();
      return;
    }
    joined_.grid.valid = std::move(covered_);
    for (std::uint8_t& state : joined_.grid.valid) state = state == kValid ? 1 : 0;
    if (std::any_of(kinds_.begin(), kinds_.end(), [](std::uint8_t kind) { return kind != 0; }))
      joined_.grid.void_kinds = std::move(kinds_);
  }

  static constexpr std::uint8_t kUncovered = 0, kVoid = 1, kValid = 2;

  std::vector<SourceRaster>& rasters_;
  const std::vector<Placed>& group_;
  std::vector<std::string>& warnings_;
  SourceRaster joined_;
  std::int64_t west_ = 0, south_ = 0;
  std::vector<std::uint8_t> covered_, kinds_;
};

}  // namespace

Result<std::vector<SourceRaster>> joinRasters(std::vector<SourceRaster> rasters,
                                              std::vector<std::string>& warnings) {
  std::vector<SourceRaster> joined;
  for (const std::vector<Placed>& group : groupsOf(rasters)) {
    if (group.size() == 1) {
      joined.push_back(std::move(rasters[group.front().raster]));
      continue;
    }
    DELTAZ_TRY_ASSIGN(SourceRaster one, Join(rasters, group, warnings).run());
    joined.push_back(std::move(one));
  }
  return joined;
}

}  // namespace deltaz
