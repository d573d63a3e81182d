#include "libdb/source/resampling.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <unistd.h>
#include <vector>

#include "formats/terrain_segment.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/source/grid_cutting.h"
#include "libdb/source/grid_placement.h"
#include "libdb/source/grid_surface.h"
#include "libdb/source/raster_extent.h"
#include "libdb/source/source_error.h"
#include "libdb/source/void_filling.h"

namespace deltaz {

namespace {

constexpr double kMetresPerDegree = 111319.49;
constexpr double kDegree = 0.017453292519943295;
constexpr std::int64_t kMostPosts = std::int64_t{1} << 32;
// What building from a post takes at its peak, measured.
constexpr double kBytesPerPost = 12;
constexpr double kMemoryShare = 0.75;  // of the machine's
// A large grid with this many posts for each of its sources' is a slip of the spacing.
constexpr double kLargePosts = 1e8;
constexpr double kMostPostsPerPost = 50;

// The largest customary number not above `value`: 1, 2, 2.5 or 5 times a power of ten.
double roundSpacing(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  double best = power;
  for (const double step : {2.0, 2.5, 5.0}) {
    if (step * power <= value * 1.05) best = step * power;
  }
  return best;
}

// The same for arc-seconds, in degrees: DEMs have 1/9, 1/3, 1, 3, ...
double roundArcSeconds(double degrees) {
  double best = 0;
  for (const double seconds : {1.0 / 27, 1.0 / 9, 0.2, 1.0 / 3, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 15.0, 30.0,
                               60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0}) {
    if (seconds / 3600 <= degrees * 1.05) best = seconds / 3600;
  }
  return best > 0 ? best : degrees;
}

struct Spacings {
  double x = 0, y = 0;  // units of the target system
};

class Resampler {
 public:
  Resampler(std::span<const SourceRaster> rasters, const ReferenceSystem& area,
            const ResamplingTarget& target)
      : rasters_(rasters), area_(area), target_(target) {
    for (const SourceRaster& raster : rasters) placed_.push_back({&raster.grid, raster.system, raster.path});
  }

  Result<ResampledRasters> run() {
    made_.path = rasters_.front().path;
    made_.system = target_.system;
    describe();
    DELTAZ_TRY(chooseAxes());
    if (target_.bounds) {
      DELTAZ_TRY_ASSIGN(const std::vector<PostWindow> windows,
                        windowsWithin(made_.grid.header, target_.system, area_, *target_.bounds,
                                      target_.allow_ballpark, made_.path));
      if (windows.empty()) return usageError("--bounds", "no source has elevations there");
      if (windows.size() > 1) {
        return usageError("--bounds", "a resampled grid would come in two parts", "no source reaches across",
                          "Build each part by itself");
      }
      cutTo(made_.grid, windows.front());
    }
    DELTAZ_TRY(checkSize());
    DELTAZ_TRY(takeHeights());
    // A filled post has a part in the surface over the sources' posts beside it, so filling comes first.
    const std::uint64_t filled = target_.fill_voids ? fillVoidPosts(made_.grid) : 0;
    DELTAZ_TRY(measure());
    return ResampledRasters{std::move(made_), filled};
  }

 private:
  GridHeader& header() { return made_.grid.header; }

  void describe() {
    GridHeader& made = header();
    const GridHeader& first = rasters_.front().grid.header;
    made.kind = target_.system.projected ? "projected" : "geodetic";
    made.crs_wkt = target_.system.wkt;
    made.coordinate_epoch = target_.system.epoch;
    made.ellipsoid = target_.system.ellipsoid;
    made.horizontal_datum = target_.system.horizontal_datum;
    made.vertical_datum = first.vertical_datum;
    made.unit = "metre";
    made.quantum = target_.quantum.value_or(
        first.quantum.value() < kResampledQuantum.value() ? first.quantum : kResampledQuantum);
    for (const SourceRaster& raster : rasters_) {
      const auto& sources = raster.grid.header.sources;
      made.sources.insert(made.sources.end(), sources.begin(), sources.end());
    }
  }

  Result<Spacings> chooseSpacings() const {
    const SourceRaster& finest = rasters_.front();
    const GridHeader& like = finest.grid.header;
    const bool projected = target_.system.projected;
    if (target_.spacing) {
      if (target_.spacing->arc_seconds == projected) {
        return usageError(
            "--spacing",
            projected ? "arc-seconds are no spacing of a projected grid"
                      : "metres are no spacing of a geodetic grid",
            {}, projected ? "Name it in metres, for example 30m" : "Name it in arc-seconds, for example 1as");
      }
      const double value =
          projected ? target_.spacing->value / target_.system.metres_per_unit : target_.spacing->value / 3600;
      return Spacings{value, value};
    }
    if (!projected && !finest.system.projected) return Spacings{like.x_axis.spacing, like.y_axis.spacing};
    if (sameHorizontalSystem(target_.system, finest.system))
      return Spacings{like.x_axis.spacing, like.y_axis.spacing};
    const double metres = std::min(like.x_axis.spacing, like.y_axis.spacing) *
                          (finest.system.projected ? finest.system.metres_per_unit : kMetresPerDegree);
    const double value = projected ? roundSpacing(metres / target_.system.metres_per_unit)
                                   : roundArcSeconds(metres / kMetresPerDegree);
    return Spacings{value, value};
  }

  // The rectangle of all rasters in the target system.
  Status chooseAxes() {
    DELTAZ_TRY_ASSIGN(Spacings spacing, chooseSpacings());
    DELTAZ_TRY_ASSIGN(const CoordinateExtent extent,
                      extentOf(rasters_, target_.system, target_.allow_ballpark));
    if (!target_.system.projected && !target_.spacing && rasters_.front().system.projected) {
      // Where meridians are near one another, columns need not be as many as rows; DTED does the same.
      const double nearest = std::max({0.0, extent.south, -extent.north});
      const double shrunk = std::cos(nearest * kDegree);
      if (shrunk <= 0.5) spacing.x = roundArcSeconds(spacing.y / shrunk);
    }
    const AxisOrigin of_x = target_.system.projected ? kProjectedOrigin : kLongitudeOrigin;
    const AxisOrigin of_y = target_.system.projected ? kProjectedOrigin : kLatitudeOrigin;
    DELTAZ_TRY_ASSIGN(header().x_axis, axisBetween(extent.west, extent.east, spacing.x, of_x));
    DELTAZ_TRY_ASSIGN(header().y_axis, axisBetween(extent.south, extent.north, spacing.y, of_y));
    if (!target_.system.projected) {
      const double turn = 360 / spacing.x;
      while (postCoordinate(header().x_axis, of_x, header().x_axis.first) >= 180)
        header().x_axis.first -= std::llround(turn);
      while (postCoordinate(header().x_axis, of_x, header().x_axis.first) < -180)
        header().x_axis.first += std::llround(turn);
    }
    return Success{};
  }

  // Says so before hours and gigabytes are spent on a slip of the spacing.
  Status checkSize() {
    const double posts =
        static_cast<double>(header().x_axis.count) * static_cast<double>(header().y_axis.count);
    double of_sources = 0;
    for (const SourceRaster& raster : rasters_) of_sources += static_cast<double>(raster.grid.heights.size());
    const double bytes = posts * kBytesPerPost;
    const double memory =
        static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
    const bool slip = posts > kLargePosts && posts > kMostPostsPerPost * of_sources;
    if (posts <= static_cast<double>(kMostPosts) && bytes <= kMemoryShare * memory && !slip) return Success{};
    return usageError("--spacing",
                      fmt::format("the grid would have {} x {} posts, {:.3g} for each of its sources'",
                                  header().x_axis.count, header().y_axis.count, posts / of_sources),
                      fmt::format("building it takes about {:.1f} GB of memory; this machine has {:.1f} GB",
                                  bytes / 1e9, memory / 1e9),
                      "Choose a larger one, or a part with --bounds");
  }

  // Posts at whole multiples of the spacing inside [low, high].
  static Result<GridAxis> axisBetween(double low, double high, double spacing, const AxisOrigin& origin) {
    const double first = std::ceil((low - origin.coordinate) / spacing - kOnPost);
    const double last = std::floor((high - origin.coordinate) / spacing + kOnPost);
    if (!(last - first >= 1))
      return usageError("--spacing", "the sources are smaller than two posts of it", {},
                        "Choose a smaller one");
    if (!(last - first < 2e9) || !(std::abs(first) < 1e15))
      return usageError("--spacing", "the grid would have too many posts", {}, "Choose a larger one");
    return placeAxis(origin.coordinate + first * spacing, spacing,
                     static_cast<std::int64_t>(last - first) + 1, origin);
  }

  Status takeHeights() {
    const auto columns = static_cast<std::size_t>(header().x_axis.count);
    const auto rows = static_cast<std::size_t>(header().y_axis.count);
    made_.grid.heights.assign(columns * rows, 0);
    made_.grid.valid.assign(columns * rows, 0);
    const GridLattice lattice(header(), target_.system);
    DELTAZ_TRY_ASSIGN(const SurfaceStack stack,
                      SurfaceStack::make(placed_, target_.system, target_.allow_ballpark));
    const double quantum = header().quantum.value();
    std::size_t valid = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      std::vector<double> x(columns), y(columns, lattice.yAt(static_cast<std::int64_t>(row)));
      for (std::size_t column = 0; column < columns; ++column)
        x[column] = lattice.xAt(static_cast<std::int64_t>(column));
      const std::vector<double> heights = stack.heightsAt(x, y, stack.size());
      for (std::size_t column = 0; column < columns; ++column) {
        if (std::isnan(heights[column])) continue;
        const double quanta = std::round(heights[column] / quantum);
        if (!(std::abs(quanta) <= kMaximumHeightQuanta)) {
          return refusedSource(made_.path, fmt::format("the elevation {} m is out of range", heights[column]),
                               "in whole height steps it does not fit 31 bits", "Choose a larger --quantum");
        }
        made_.grid.heights[row * columns + column] = static_cast<std::int32_t>(quanta);
        made_.grid.valid[row * columns + column] = 1;
        header().height_error = std::max(header().height_error, std::abs(heights[column] - quanta * quantum));
        ++valid;
      }
    }
    if (valid == 0) return usageError("--grid", "no post of the resampled grid has a height");
    if (valid == made_.grid.valid.size()) {
      made_.grid.valid.clear();
    } else {
      header().sentinels = {kResampledVoid};
    }
    return Success{};
  }

  Status measure() {
    DELTAZ_TRY_ASSIGN(const SurfaceDifference difference,
                      differenceFrom(made_.grid, target_.system, placed_, target_.allow_ballpark));
    header().resampling = Resampling{"bilinear", difference.largest, difference.rms};
    return Success{};
  }

  std::span<const SourceRaster> rasters_;
  const ReferenceSystem& area_;
  const ResamplingTarget& target_;
  SourceRaster made_;
  std::vector<PlacedGrid> placed_;
};

}  // namespace

Result<ResampledRasters> resampleRasters(std::span<const SourceRaster> rasters, const ReferenceSystem& area,
                                         const ResamplingTarget& target) {
  return Resampler(rasters, area, target).run();
}

}  // namespace deltaz
