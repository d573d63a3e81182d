#include "libdb/source/elevation_source.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <new>

#include "libdb/access/grid_geometry.h"
#include "libdb/source/datum_report.h"
#include "libdb/source/full_turn.h"
#include "libdb/source/gdal_session.h"
#include "libdb/source/grid_cutting.h"
#include "libdb/source/grid_placement.h"
#include "libdb/source/mosaic.h"
#include "libdb/source/patch_fitting.h"
#include "libdb/source/reference_system.h"
#include "libdb/source/resampling.h"
#include "libdb/source/source_error.h"
#include "libdb/source/source_opening.h"
#include "libdb/source/source_raster.h"
#include "libdb/source/void_cover.h"
#include "libdb/source/void_filling.h"

namespace deltaz {

namespace {

constexpr double kMetresPerDegree = 111319.49;

class AreaReader {
 public:
  explicit AreaReader(const SourceOptions& options) : options_(options) {}

  Result<SourceArea> run(std::span<const std::string> paths) {
    if (paths.empty()) return usageError("DEM", "no source is named");
    DELTAZ_TRY(readRasters(paths));
    if (!options_.order.empty()) putInOrder();
    DELTAZ_TRY(chooseDatum());
    if (options_.join) {
      DELTAZ_TRY_ASSIGN(rasters_, joinRasters(std::move(rasters_), result_.warnings));
    }
    for (SourceRaster& raster : rasters_) closeTurn(raster.grid);
    compareVerticalDatums();
    if (options_.bounds) DELTAZ_TRY(cut());
    for (SourceRaster& raster : rasters_) DELTAZ_TRY(placeOnEarth(raster));
    const bool resampled = options_.grid != "source" || options_.spacing;
    if (resampled) DELTAZ_TRY(resample());
    sortFinestFirst();
    if (options_.voids == VoidPolicy::kFill && !resampled) DELTAZ_TRY(fill());
    for (SourceRaster& raster : rasters_) result_.grids.push_back(std::move(raster.grid));
    return std::move(result_);
  }

 private:
  Status readRasters(std::span<const std::string> paths) {
    for (const std::string& path : paths) {
      DELTAZ_TRY_ASSIGN(const std::vector<std::string> behind, rastersBehind(path));
      for (const std::string& raster : behind) {
        DELTAZ_TRY_ASSIGN(SourceRaster read, readSourceRaster(raster, options_, result_.warnings));
        rasters_.push_back(std::move(read));
      }
    }
    return Success{};
  }

  void putInOrder() {
    const auto placeOf = [this](const SourceRaster& raster) {
      const SourceDescription& source = raster.grid.header.sources.front();
      return std::find_if(options_.order.begin(), options_.order.end(),
                          [&](const SourceDescription& known) {
                            return known.name == source.name && known.content == source.content;
                          }) -
             options_.order.begin();
    };
    std::stable_sort(rasters_.begin(), rasters_.end(),
                     [&](const SourceRaster& a, const SourceRaster& b) { return placeOf(a) < placeOf(b); });
  }

  // All grids of an area refer to one datum: that of the target system, else of the first source.
  Status chooseDatum() {
    if (!options_.datum.empty()) {
      DELTAZ_TRY_ASSIGN(const ReferenceSystem given, parseReferenceSystem(options_.datum, "datum"));
      DELTAZ_TRY_ASSIGN(area_, geographicOf(given, "datum"));
      return Success{};
    }
    if (options_.grid != "source" && options_.grid != "geodetic") {
      DELTAZ_TRY_ASSIGN(const ReferenceSystem target, parseReferenceSystem(options_.grid, "--grid"));
      DELTAZ_TRY_ASSIGN(area_, geographicOf(target, "--grid"));
      return Success{};
    }
    DELTAZ_TRY_ASSIGN(area_, geographicOf(rasters_.front().system, rasters_.front().path));
    return Success{};
  }

  void compareVerticalDatums() {
    const std::string& first = rasters_.front().grid.header.vertical_datum;
    for (const SourceRaster& raster : rasters_) {
      const std::string& other = raster.grid.header.vertical_datum;
      if (other == first || other == "unknown" || first == "unknown") continue;
      result_.warnings.push_back(
          fmt::format("{}: its heights refer to '{}', those of {} to '{}'; they are taken as they are, and "
                      "may differ by metres",
                      raster.path, other, rasters_.front().path, first));
    }
  }

  Status cut() {
    std::vector<SourceRaster> kept;
    for (SourceRaster& raster : rasters_) {
      DELTAZ_TRY_ASSIGN(const std::vector<PostWindow> windows,
                        windowsWithin(raster.grid.header, raster.system, area_, *options_.bounds,
                                      options_.allow_ballpark, raster.path));
      const std::string path = raster.path;
      const std::size_t before = kept.size();
      for (std::size_t k = 0; k < windows.size(); ++k) {
        SourceRaster part = k + 1 < windows.size() ? raster : std::move(raster);
        cutTo(part.grid, windows[k]);
        const auto& valid = part.grid.valid;
        if (valid.empty() || std::find(valid.begin(), valid.end(), std::uint8_t{1}) != valid.end())
          kept.push_back(std::move(part));
      }
      if (kept.size() == before) {
        result_.warnings.push_back(
            fmt::format("{}: it has no elevations within --bounds, and is left out", path));
      } else if (kept.size() > before + 1) {
        result_.warnings.push_back(fmt::format(
            "{}: its east and its west side lie within --bounds, but nothing between; they become two grids",
            path));
      }
    }
    if (kept.empty()) return usageError("--bounds", "no source has elevations there");
    rasters_ = std::move(kept);
    return Success{};
  }

  // ---- places

  Status placeOnEarth(SourceRaster& raster) {
    GridHeader& header = raster.grid.header;
    const bool same = sameDatum(raster.system, area_);
    if (header.kind == "geodetic" && same) return Success{};
    if (header.kind == "geodetic") DELTAZ_TRY(countInDegrees(raster));
    if (!same) DELTAZ_TRY(checkDatumChange(raster));
    header.ellipsoid = area_.ellipsoid;
    header.horizontal_datum = area_.horizontal_datum;
    DELTAZ_TRY_ASSIGN(
        const CoordinateChange to_geographic,
        CoordinateChange::between(raster.system, area_, same || options_.allow_ballpark, raster.path));
    DELTAZ_TRY_ASSIGN(raster.grid.patches, fitPatches(header, to_geographic, raster.path));
    header.patches = raster.grid.patches->placement;
    return Success{};
  }

  // Latitudes and longitudes of another datum are coordinates like those of a projection.
  static Status countInDegrees(SourceRaster& raster) {
    GridHeader& header = raster.grid.header;
    if (header.x_axis.spacing < kLeastSpacingProjected || header.y_axis.spacing < kLeastSpacingProjected) {
      return refusedSource(
          raster.path,
          fmt::format("the source refers to '{}', unlike the area, and its posts are less than {} "
                      "degrees apart",
                      raster.system.name, kLeastSpacingProjected),
          {}, "Resample it with --grid geodetic");
    }
    const auto count = [](GridAxis& axis, const AxisOrigin& origin) {
      axis = placeAxis(postCoordinate(axis, origin, axis.first), axis.spacing, axis.count, kProjectedOrigin,
                       kPlacementTolerance);
    };
    count(header.x_axis, kLongitudeOrigin);
    count(header.y_axis, kLatitudeOrigin);
    header.kind = "projected";
    return Success{};
  }

  // Says how the datum is changed; refuses a guess nobody asked for.
  Status checkDatumChange(const SourceRaster& raster) {
    const GridHeader& header = raster.grid.header;
    const double x =
        postCoordinate(header.x_axis, kProjectedOrigin, header.x_axis.first + header.x_axis.count / 2);
    const double y =
        postCoordinate(header.y_axis, kProjectedOrigin, header.y_axis.first + header.y_axis.count / 2);
    DELTAZ_TRY_ASSIGN(std::string warning,
                      reportDatumChange(raster.path, raster.system, area_, x, y, options_.allow_ballpark));
    result_.warnings.push_back(std::move(warning));
    return Success{};
  }

  static double spacingInMetres(const SourceRaster& raster) {
    const GridHeader& header = raster.grid.header;
    const double spacing = std::sqrt(header.x_axis.spacing * header.y_axis.spacing);
    return spacing * (raster.system.projected ? raster.system.metres_per_unit : kMetresPerDegree);
  }

  void sortFinestFirst() {
    std::stable_sort(rasters_.begin(), rasters_.end(), [](const SourceRaster& a, const SourceRaster& b) {
      return spacingInMetres(a) < spacingInMetres(b);
    });
  }

  // ---- what is changed on request

  Status resample() {
    ResamplingTarget target;
    target.spacing = options_.spacing;
    target.bounds = options_.bounds;
    target.quantum = options_.quantum;
    target.allow_ballpark = options_.allow_ballpark;
    target.fill_voids = options_.voids == VoidPolicy::kFill;
    sortFinestFirst();
    if (options_.grid == "source") {
      target.system = rasters_.front().system;
    } else if (options_.grid == "geodetic") {
      target.system = area_;
    } else {
      DELTAZ_TRY_ASSIGN(target.system, parseReferenceSystem(options_.grid, "--grid"));
    }
    DELTAZ_TRY_ASSIGN(ResampledRasters one, resampleRasters(rasters_, area_, target));
    result_.filled_posts = one.filled_posts;
    rasters_.clear();
    rasters_.push_back(std::move(one.raster));
    return placeOnEarth(rasters_.front());
  }

  // Ground is made up only where no grid has any: a fill of an upper grid would bury what a lower one knows.
  Status fill() {
    std::vector<std::vector<std::uint8_t>> covered;
    for (SourceRaster& raster : rasters_) {
      std::vector<PlacedGrid> others;
      for (const SourceRaster& other : rasters_) {
        if (&other != &raster) others.push_back({&other.grid, other.system, other.path});
      }
      DELTAZ_TRY_ASSIGN(std::vector<std::uint8_t> found,
                        coverVoids(raster.grid, raster.system, others, options_.allow_ballpark));
      covered.push_back(std::move(found));
    }
    for (std::size_t k = 0; k < rasters_.size(); ++k)
      result_.filled_posts += fillVoidPosts(rasters_[k].grid, covered[k]);
    return Success{};
  }

  const SourceOptions& options_;
  SourceArea result_;
  std::vector<SourceRaster> rasters_;
  ReferenceSystem area_;  // geographic
};

}  // namespace

Result<SourceArea> readElevationSources(std::span<const std::string> paths, const SourceOptions& options) {
  const std::string where = paths.empty() ? "" : paths.front();
  try {
    const GdalSession session;
    return AreaReader(options).run(paths);
  } catch (const std::bad_alloc&) {
    return accessError(where, "cannot read the source", "there is not enough memory for all its posts");
  } catch (const std::exception& exception) {
    return internalError(where, exception.what());
  }
}

Result<RawGrid> readElevationSource(const std::string& path, const SourceOptions& options) {
  DELTAZ_TRY_ASSIGN(SourceArea area, readElevationSources(std::span(&path, 1), options));
  if (area.grids.size() != 1) {
    return refusedSource(path, fmt::format("the source makes {} grids", area.grids.size()), "one was wanted");
  }
  return std::move(area.grids.front());
}

}  // namespace deltaz
