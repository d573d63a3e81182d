#include "libdb/build/build_color.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <new>

#include "libdb/access/database.h"
#include "libdb/access/earth.h"
#include "libdb/build/color_map_edit.h"
#include "libdb/build/color_plan.h"
#include "libdb/build/color_pyramid.h"
#include "libdb/build/image_field.h"
#include "libdb/build/terrain_field.h"
#include "libdb/source/datum_report.h"
#include "libdb/source/gdal_session.h"
#include "libdb/source/source_opening.h"

namespace deltaz {

namespace {

Status checkOptions(const ColorBuildOptions& options) {
  const int origins = static_cast<int>(!options.images.empty()) + static_cast<int>(!options.ramp.empty()) +
                      static_cast<int>(!options.classes.empty()) +
                      static_cast<int>(!options.synthetic.empty());
  if (origins != 1) {
    return usageError("color",
                      origins == 0 ? "nothing says which colours" : "the colours are given in two ways", {},
                      "Give one of --image, --ramp, --classes and --synthetic");
  }
  if (!options.legend.empty() && options.classes.empty())
    return usageError("--legend", "there are no classes it could be of", {},
                      "Give their raster with --classes");
  if (!options.synthetic.empty() && options.synthetic != "natural" && options.synthetic != "winter")
    return usageError("--synthetic", fmt::format("'{}' is neither natural nor winter", options.synthetic));
  const bool of_raster = !options.images.empty() || !options.classes.empty();
  if (!of_raster && (!options.crs.empty() || options.nodata))
    return usageError(options.crs.empty() ? "--nodata" : "--crs", "there is no image it could be of");
  return Success{};
}

// Cells that a texel of the wanted size spans at most, at the middle of the grid.
double wantedCells(const GridGeometry& geometry, const PostSpacing& texel) {
  const GridAxis &x = geometry.header().x_axis, &y = geometry.header().y_axis;
  constexpr double kArcSecondsPerDegree = 3600;
  if (geometry.isGeodetic() && texel.arc_seconds)
    return texel.value / kArcSecondsPerDegree / std::max(x.spacing, y.spacing);
  // A cell's longer side on the ground; an arc-second is taken for one of latitude.
  const std::int64_t column = x.first + x.count / 2 - 1, row = y.first + y.count / 2 - 1;
  const Vector3 here = geometry.placeAt(column, row).foot;
  const double east = length(geometry.placeAt(column + 1, row).foot - here),
               north = length(geometry.placeAt(column, row + 1).foot - here);
  constexpr double kMetresPerArcSecond = 30.87;
  const double metres = texel.arc_seconds ? texel.value * kMetresPerArcSecond : texel.value;
  return metres / std::max(east, north);
}

class ColorBuild {
 public:
  ColorBuild(const FileSystem& files, const std::string& target, const ColorBuildOptions& options)
      : files_(files), target_(target), options_(options), workers_(options.threads) {}

  Result<ColorBuildSummary> run() {
    DELTAZ_TRY_ASSIGN(Database database, Database::open(files_, target_));
    DELTAZ_TRY(checkColorMapName(database.area(), target_, options_.name, options_.overwrite));
    report("reading", 0);
    DELTAZ_TRY_ASSIGN(const AssetHeader header, openSources(database));
    const std::uint64_t generation = database.area().generation;
    DELTAZ_TRY_ASSIGN(summary_.bytes,
                      addColorMap(files_, target_, header, options_.overwrite,
                                  [&](const AreaHeader& area, ColorMapWriter& writer) -> Status {
                                    if (area.generation == generation) return fill(database, writer);
                                    // Another writer was faster; its terrain is the one to colour.
                                    DELTAZ_TRY_ASSIGN(const Database newer, Database::open(files_, target_));
                                    return fill(newer, writer);
                                  }));
    warnOfMissingClasses();
    return summary_;
  }

 private:
  void report(std::string_view phase, double fraction) const {
    if (options_.progress) options_.progress(phase, fraction);
  }

  Status addFile(AssetHeader& header, const std::string& path) const {
    DELTAZ_TRY_ASSIGN(const Hash128 content, hashOfContent(path, {}));
    header.sources.push_back({baseName(path), content});
    return Success{};
  }

  Status openImages(AssetHeader& header, const std::vector<std::string>& paths,
                    const ColorImageOptions& image_options) {
    for (const std::string& path : paths) {
      DELTAZ_TRY_ASSIGN(const std::vector<std::string> rasters, rastersBehind(path));
      for (const std::string& raster : rasters) {
        DELTAZ_TRY_ASSIGN(ColorImage image, ColorImage::open(raster, image_options, summary_.warnings));
        header.sources.push_back(image.source());
        images_.push_back(std::move(image));
      }
    }
    return Success{};
  }

  Result<AssetHeader> openSources(const Database& database) {
    AssetHeader header;
    header.name = options_.name;
    header.options = options_.provenance;
    std::sort(header.options.begin(), header.options.end());
    ColorImageOptions image_options;
    image_options.crs = options_.crs;
    image_options.nodata = options_.nodata;
    if (!options_.images.empty()) {
      header.origin = "image";
      DELTAZ_TRY(openImages(header, options_.images, image_options));
    } else if (!options_.classes.empty()) {
      header.origin = "classes";
      image_options.classes = true;
      if (!options_.legend.empty()) {
        DELTAZ_TRY_ASSIGN(image_options.legend, ClassLegend::read(options_.legend));
      }
      DELTAZ_TRY(openImages(header, {options_.classes}, image_options));
      if (!options_.legend.empty()) DELTAZ_TRY(addFile(header, options_.legend));
    } else if (!options_.ramp.empty()) {
      header.origin = "ramp";
      const AreaHeader& area = database.area();
      DELTAZ_TRY_ASSIGN(ramp_, ColorRamp::read(options_.ramp, area.lowest_height, area.highest_height));
      DELTAZ_TRY(addFile(header, options_.ramp));
    } else {
      header.origin = "synthetic";
    }
    return header;
  }

  Result<std::unique_ptr<ColorField>> fieldOf(const Database& database, int grid) const {
    if (!images_.empty()) {
      DELTAZ_TRY_ASSIGN(std::unique_ptr<ImageField> field,
                        ImageField::make(database.grid(grid).header(), images_, options_.allow_ballpark));
      return std::unique_ptr<ColorField>(std::move(field));
    }
    if (ramp_) {
      DELTAZ_TRY_ASSIGN(std::unique_ptr<TerrainField> field, TerrainField::ofRamp(database, grid, *ramp_));
      return std::unique_ptr<ColorField>(std::move(field));
    }
    DELTAZ_TRY_ASSIGN(
        std::unique_ptr<TerrainField> field,
        TerrainField::ofRule(database, grid, options_.synthetic == "winter" ? winterColor : naturalColor));
    return std::unique_ptr<ColorField>(std::move(field));
  }

  // The level --texel asks for; none: as fine as the field is. kUsage if its texels would be absurdly finer
  // than what is to be shown, or too many to be numbered.
  Result<std::optional<int>> lastLevel(std::uint16_t number, const GridGeometry& geometry,
                                       const ColorField& field) {
    if (!options_.texel) return std::optional<int>();
    // A size that is meant to be the cell's is not to fail by a rounding, nor by a projection's scale.
    constexpr double kAbout = 1.005;
    const double cells = wantedCells(geometry, *options_.texel) * kAbout;
    const GridHeader& grid = geometry.header();
    const int coarsest = colorRootLevel(grid) + kColorFarLevels;
    int level = coarsest;
    while (level > kLowestColorLevel && colorTexelCells(grid.leaf_cells, level) > cells) --level;
    // What the field touches, by nodes so coarse that there are few of them.
    constexpr int kProbeLevels = 5;
    const int probe = std::max(level, colorRootLevel(grid) - kProbeLevels);
    double texels = 0;
    bool much_finer = !images_.empty(), absurdly_finer = true;
    for (const PlannedTile& tile : planColorTiles(number, grid, field, probe)) {
      if (tile.place.level != probe) continue;
      const TexelBlock block = clampedBlock(blockOf(tile.place, probe), texelsOverGrid(grid, probe));
      texels += std::ldexp(static_cast<double>(block.columns) * block.rows, 2 * (probe - level));
      constexpr int kMuchFinerLevels = 2, kAbsurdlyFinerLevels = 4;  // a quarter, a sixteenth of a pixel
      much_finer = much_finer && !field.isFiner(block, level + kMuchFinerLevels);
      absurdly_finer = absurdly_finer && !field.isFiner(block, level + kAbsurdlyFinerLevels);
    }
    constexpr double kManyTexels = 0x1p28;  // minutes of work
    if (texels > kManyTexels && absurdly_finer) {
      return usageError(
          "--texel", "the texels would be smaller than a sixteenth of what there is to show",
          fmt::format("there would be {:.3g} of them, and the images' pixels or the terrain's cells are that "
                      "much larger",
                      texels),
          "Give a larger one, or leave it out");
    }
    constexpr double kMostTexels = 0x1p36;
    if (texels > kMostTexels || colorTexelCells(grid.leaf_cells, level) > cells) {
      const double larger = std::exp2(std::max(1.0, std::ceil(0.5 * std::log2(texels / kMostTexels))));
      return usageError(
          "--texel", "the map would have too many texels of this size",
          fmt::format("there would be {:.3g} of them, and about {:.3g} GB to write; {:.3g} are taken at most",
                      texels, 4 * texels / 1e9, kMostTexels),
          fmt::format(
              "Give {:.3g}{} or more",
              options_.texel->value * colorTexelCells(grid.leaf_cells, level) / cells * kAbout * larger,
              options_.texel->arc_seconds ? "as" : "m"));
    }
    if (much_finer && texels > 0) {
      summary_.warnings.push_back(
          "--texel: the texels are no larger than a quarter of the images' pixels; they show no more for it, "
          "and take more room");
    }
    return std::optional<int>(level);
  }

  // Says how images come from their datum to the grid's, once each; refuses a guess nobody asked for.
  Status checkDatumChanges(const GridHeader& grid) {
    if (images_.empty()) return Success{};
    const GdalSession session;
    DELTAZ_TRY_ASSIGN(const ReferenceSystem system,
                      parseReferenceSystem(grid.crs_wkt, "area.json", grid.coordinate_epoch));
    for (const ColorImage& image : images_) {
      if (sameDatum(image.system(), system)) continue;
      const auto middle = image.coordinatesAt(0.5 * image.columns(), 0.5 * image.rows());
      DELTAZ_TRY_ASSIGN(std::string warning,
                        reportDatumChange(image.path(), image.system(), system, middle[0], middle[1],
                                          options_.allow_ballpark));
      std::vector<std::string>& warnings = summary_.warnings;
      if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
        warnings.push_back(std::move(warning));
    }
    return Success{};
  }

  Status fill(const Database& database, ColorMapWriter& writer) {
    const int grids = database.gridCount();
    for (int grid = 0; grid < grids; ++grid) {
      const GridGeometry& geometry = database.grid(grid);
      DELTAZ_TRY(checkDatumChanges(geometry.header()));
      DELTAZ_TRY_ASSIGN(const std::unique_ptr<ColorField> field, fieldOf(database, grid));
      ColorPyramidOptions pyramid;
      DELTAZ_TRY_ASSIGN(pyramid.last_level, lastLevel(static_cast<std::uint16_t>(grid), geometry, *field));
      pyramid.progress = [&](double fraction) { report("colours", (grid + fraction) / grids); };
      DELTAZ_TRY(buildColorPyramid(static_cast<std::uint16_t>(grid), geometry.header(), *field, pyramid,
                                   workers_, writer));
    }
    if (writer.count() == 0) {
      std::string names;
      for (const ColorImage& image : images_) names += (names.empty() ? "" : ", ") + image.path();
      return invalidError(IssueCode::kNone, names.empty() ? target_ : names,
                          "there is no colour for any part of the area",
                          images_.empty() ? "it has no posts with a height"
                                          : "the image lies beside the area, or has no cover there",
                          images_.empty() ? "" : "Check its georeferencing, or give --crs");
    }
    summary_.nodes = writer.count();
    const auto [finest, coarsest] = writer.levels();
    summary_.finest_level = finest;
    summary_.coarsest_level = coarsest;
    return Success{};
  }

  void warnOfMissingClasses() {
    if (options_.classes.empty()) return;
    for (const ColorImage& image : images_) {
      const std::vector<std::int64_t> missing = image.missingClasses();
      if (missing.empty()) continue;
      constexpr std::size_t kMost = 40;
      std::string text;
      for (std::size_t k = 0; k < std::min(missing.size(), kMost); ++k)
        text += (k == 0 ? "" : ", ") + std::to_string(missing[k]);
      if (missing.size() > kMost) text += " and more";
      summary_.warnings.push_back(
          fmt::format("{}: no colour is given for classes {}; they stay uncovered", image.path(), text));
    }
  }

  const FileSystem& files_;
  const std::string& target_;
  const ColorBuildOptions& options_;
  WorkerPool workers_;
  std::vector<ColorImage> images_;
  std::optional<ColorRamp> ramp_;
  ColorBuildSummary summary_;
};

}  // namespace

Result<ColorBuildSummary> buildColor(const FileSystem& files, const std::string& target,
                                     const ColorBuildOptions& options) {
  DELTAZ_TRY(checkOptions(options));
  try {
    return ColorBuild(files, target, options).run();
  } catch (const std::bad_alloc&) {
    return accessError(target, "cannot build the colour map", "there is not enough memory");
  } catch (const std::exception& exception) {
    return internalError(target, exception.what());
  }
}

}  // namespace deltaz
