#include "libdb/source/color_image.h"

#include <cmath>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <mutex>
#include <set>

#include "formats/file_system.h"
#include "libdb/source/color_bands.h"
#include "libdb/source/gdal_session.h"
#include "libdb/source/source_error.h"
#include "libdb/source/source_opening.h"
#include "libdb/source/stated_system.h"
#include "libdb/source/turn_length.h"

namespace deltaz {

namespace {

// A turn of the Earth may be rounded by so many pixels.
constexpr double kFullTurnSlack = 0.5;

Status checkPlacement(GDALDataset& dataset, const std::string& path, std::array<double, 6>& transform,
                      std::array<double, 6>& inverse) {
  if (dataset.GetGeoTransform(transform.data()) != CE_None) {
    if (dataset.GetGCPCount() > 0) {
      return refusedSource(path, "the image is placed by ground control points only",
                           "how they are to be joined is a choice of its own",
                           "Warp it first, with gdalwarp -t_srs");
    }
    return refusedSource(path, "the image is not georeferenced", "it does not say where its pixels are",
                         "Give it a georeferencing, with gdal_translate -a_ullr -a_srs");
  }
  for (const double value : transform) {
    if (!std::isfinite(value)) return refusedSource(path, "the image's georeferencing is not finite");
  }
  if (GDALInvGeoTransform(transform.data(), inverse.data()) == FALSE)
    return refusedSource(path, "the image's georeferencing gives its pixels no extent");
  return Success{};
}

}  // namespace

struct ColorImage::Opened {
  GDALDatasetUniquePtr dataset;
  ColorBands bands;
  std::optional<ClassLegend> legend;
  std::mutex mutex;  // of the dataset and of `missing`
  std::set<std::int64_t> missing;

  Status readBand(int number, GDALDataType type, const PixelWindow& window, void* values,
                  const std::string& path);
  Status readColors(const PixelWindow& window, std::span<CoveredColor> colors, const std::string& path);
  Status readNumbers(const PixelWindow& window, std::span<CoveredColor> colors, const std::string& path);
};

ColorImage::ColorImage() : opened_(std::make_unique<Opened>()) {}
ColorImage::ColorImage(ColorImage&&) noexcept = default;
ColorImage::~ColorImage() = default;

Result<ColorImage> ColorImage::open(const std::string& path, const ColorImageOptions& options,
                                    std::vector<std::string>& warnings) {
  const GdalSession session;
  ColorImage image;
  image.path_ = path;
  constexpr unsigned kOpenFlags = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  image.opened_->dataset.reset(GDALDataset::Open(path.c_str(), kOpenFlags));
  if (!image.opened_->dataset)
    return refusedSource(path, "this is not an image that can be read", session.lastFailure());
  GDALDataset& dataset = *image.opened_->dataset;
  image.columns_ = dataset.GetRasterXSize();
  image.rows_ = dataset.GetRasterYSize();
  DELTAZ_TRY(checkPlacement(dataset, path, image.transform_, image.inverse_));
  DELTAZ_TRY_ASSIGN(image.opened_->bands, chooseColorBands(dataset, path, options, warnings));
  DELTAZ_TRY_ASSIGN(image.system_, statedSystem(dataset, path, options.crs, warnings));
  image.classes_ = options.classes;
  image.opened_->legend = options.legend;
  image.turn_ = turnLength(image.system_);
  image.middle_ = image.coordinatesAt(0.5 * image.columns_, 0.5 * image.rows_)[0];
  if (image.hasTurn()) {
    const double width = std::abs(image.transform_[1]) * image.columns_;
    image.closes_round_ = image.transform_[2] == 0 && image.transform_[4] == 0 &&
                          std::abs(width - image.turn_) <= kFullTurnSlack * std::abs(image.transform_[1]);
  }
  image.source_.name = baseName(path);
  DELTAZ_TRY_ASSIGN(image.source_.content, hashOfContent(path, membersOfVirtual(dataset)));
  return image;
}

std::array<double, 2> ColorImage::coordinatesAt(double column, double row) const {
  return {transform_[0] + column * transform_[1] + row * transform_[2],
          transform_[3] + column * transform_[4] + row * transform_[5]};
}

double ColorImage::columnsPerTurn() const {
  return inverse_[4] == 0 ? std::abs(inverse_[1]) * turn_ : 0;
}

std::array<double, 2> ColorImage::coordinateStep(double columns, double rows) const {
  return {columns * transform_[1] + rows * transform_[2], columns * transform_[4] + rows * transform_[5]};
}

void ColorImage::toPixels(std::span<double> x, std::span<double> y) const {
  for (std::size_t k = 0; k < x.size(); ++k) {
    double east = x[k];
    const double north = y[k];
    if (hasTurn()) east -= turn_ * std::round((east - middle_) / turn_);
    x[k] = inverse_[0] + east * inverse_[1] + north * inverse_[2];
    y[k] = inverse_[3] + east * inverse_[4] + north * inverse_[5];
  }
}

Status ColorImage::Opened::readBand(int number, GDALDataType type, const PixelWindow& window, void* values,
                                    const std::string& path) {
  const GdalSession session;
  GDALRasterBand* const band = number > 0 ? dataset->GetRasterBand(number)
                                          : dataset->GetRasterBand(bands.bands.front())->GetMaskBand();
  if (band->RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, values, window.columns,
                     window.rows, type, 0, 0, nullptr) != CE_None ||
      session.hasFailed()) {
    return refusedSource(path, "the image cannot be read to its end", session.lastFailure(),
                         "It is damaged or cut short");
  }
  return Success{};
}

Status ColorImage::Opened::readColors(const PixelWindow& window, std::span<CoveredColor> colors,
                                      const std::string& path) {
  const std::size_t count = colors.size();
  std::vector<std::uint16_t> values(count);
  // A pixel has no colour where all its bands say so: black in one of them is a colour.
  std::vector<std::uint8_t> empty(count, 1);
  // Numbers become codes and those linear light, through one table.
  std::vector<double> linear(static_cast<std::size_t>(bands.most) + 1);
  for (std::size_t k = 0; k < linear.size(); ++k)
    linear[k] = linearOfSrgb(
        static_cast<std::uint8_t>(std::floor(255.0 * static_cast<double>(k) / bands.most + 0.5)));
  for (std::size_t b = 0; b < bands.bands.size(); ++b) {
    DELTAZ_TRY(readBand(bands.bands[b], GDT_UInt16, window, values.data(), path));
    const std::optional<double>& nodata = bands.nodata[b];
    for (std::size_t k = 0; k < count; ++k) {
      if (!nodata || values[k] != *nodata) empty[k] = 0;
      const double light = linear[std::min<std::size_t>(values[k], linear.size() - 1)];
      CoveredColor& color = colors[k];
      if (bands.bands.size() == 1) {
        color.red = color.green = color.blue = light;
      } else {
        (b == 0 ? color.red : b == 1 ? color.green : color.blue) = light;
      }
    }
  }
  for (std::size_t k = 0; k < count; ++k) colors[k].cover = empty[k] != 0 ? 0 : 1;
  return Success{};
}

// Palettes and classes.
Status ColorImage::Opened::readNumbers(const PixelWindow& window, std::span<CoveredColor> colors,
                                       const std::string& path) {
  std::vector<double> values(colors.size());
  DELTAZ_TRY(readBand(bands.bands.front(), GDT_Float64, window, values.data(), path));
  const std::optional<double>& nodata = bands.nodata.front();
  for (std::size_t k = 0; k < colors.size(); ++k) {
    colors[k] = {};
    if (nodata && values[k] == *nodata) continue;
    const auto number = static_cast<std::int64_t>(values[k]);
    std::optional<ColorCode> code;
    if (legend) {
      if (const auto found = legend->colors.find(number); found != legend->colors.end()) code = found->second;
    } else if (number >= 0 && static_cast<std::size_t>(number) < bands.palette.size()) {
      code = bands.palette[static_cast<std::size_t>(number)];
    }
    if (!code) {
      missing.insert(number);
      continue;
    }
    const CoveredColor color = coveredColor(*code);
    // Not yet times the cover: the alpha band may still count.
    colors[k] = {linearOfSrgb((*code)[0]), linearOfSrgb((*code)[1]), linearOfSrgb((*code)[2]), color.cover};
  }
  return Success{};
}

Status ColorImage::read(const PixelWindow& window, std::span<CoveredColor> colors) const {
  Opened& opened = *opened_;
  const std::lock_guard guard(opened.mutex);
  if (opened.bands.kind == ColorBands::Kind::kColors) {
    DELTAZ_TRY(opened.readColors(window, colors, path_));
  } else {
    DELTAZ_TRY(opened.readNumbers(window, colors, path_));
  }
  std::vector<std::uint16_t> opacity(colors.size());
  if (opened.bands.alpha > 0) {
    DELTAZ_TRY(opened.readBand(opened.bands.alpha, GDT_UInt16, window, opacity.data(), path_));
    for (std::size_t k = 0; k < colors.size(); ++k)
      colors[k].cover *= std::min(opacity[k] / opened.bands.most_alpha, 1.0);
  }
  if (opened.bands.masked) {
    DELTAZ_TRY(opened.readBand(0, GDT_UInt16, window, opacity.data(), path_));
    for (std::size_t k = 0; k < colors.size(); ++k) colors[k].cover *= opacity[k] / 255.0;
  }
  for (CoveredColor& color : colors) {
    color.red *= color.cover;
    color.green *= color.cover;
    color.blue *= color.cover;
  }
  return Success{};
}

std::vector<std::int64_t> ColorImage::missingClasses() const {
  const std::lock_guard guard(opened_->mutex);
  return {opened_->missing.begin(), opened_->missing.end()};
}

}  // namespace deltaz
