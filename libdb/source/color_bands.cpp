#include "libdb/source/color_bands.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <gdal_priv.h>

#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

std::string bandsText(GDALDataset& dataset) {
  std::string list;
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    GDALRasterBand& band = *dataset.GetRasterBand(number);
    list += fmt::format("{}{} ({}, {})", list.empty() ? "" : ", ", number,
                        GDALGetDataTypeName(band.GetRasterDataType()),
                        GDALGetColorInterpretationName(band.GetColorInterpretation()));
  }
  return list;
}

int bandOf(GDALDataset& dataset, GDALColorInterp interpretation) {
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    if (dataset.GetRasterBand(number)->GetColorInterpretation() == interpretation) return number;
  }
  return 0;
}

// The number that means full in a band of colours or opacity.
Result<double> fullOf(GDALRasterBand& band, const std::string& path, bool opacity) {
  const GDALDataType type = band.GetRasterDataType();
  if (type != GDT_Byte && type != GDT_UInt16) {
    return refusedSource(path, fmt::format("numbers of type {} are no colours", GDALGetDataTypeName(type)),
                         "colours are Byte or UInt16",
                         "Scale them to bytes, with gdal_translate -ot Byte -scale");
  }
  const char* const bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const int most_bits = type == GDT_Byte ? 8 : 16;
  const int used = bits == nullptr ? 0 : std::atoi(bits);
  if (used >= 1 && used < most_bits) return static_cast<double>((1 << used) - 1);
  if (type == GDT_Byte) return 255.0;
  if (opacity) return 65535.0;
  double range[2] = {0, 0};
  constexpr double kFills = 16384;  // a quarter of the range: darker pictures hardly mean to be so dark
  if (band.ComputeRasterMinMax(TRUE, range) != CE_None || range[1] >= kFills) return 65535.0;
  return refusedSource(
      path, fmt::format("its 16-bit colours reach {} of 65535 only", range[1]),
      "how bright they are meant to be is not said",
      fmt::format("Scale them to bytes, with gdal_translate -ot Byte -scale 0 {} 0 255", range[1]));
}

std::optional<double> nodataOf(GDALRasterBand& band, const ColorImageOptions& options) {
  if (options.nodata) return options.nodata;
  int has = 0;
  const double value = band.GetNoDataValue(&has);
  return has != 0 ? std::optional(value) : std::nullopt;
}

std::vector<ColorCode> paletteOf(const GDALColorTable& table) {
  std::vector<ColorCode> palette;
  const auto code = [](short value) { return static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255)); };
  for (int k = 0; k < table.GetColorEntryCount(); ++k) {
    GDALColorEntry entry{};
    (void)table.GetColorEntryAsRGB(k, &entry);
    palette.push_back({code(entry.c1), code(entry.c2), code(entry.c3), code(entry.c4)});
  }
  return palette;
}

bool holdsClasses(GDALDataType type) {
  return type == GDT_Byte || type == GDT_UInt16 || type == GDT_Int16 || type == GDT_UInt32 ||
         type == GDT_Int32;
}

// The classes in a band, some of them: enough to write a legend by.
std::string classesIn(GDALRasterBand& band, const std::optional<double>& nodata) {
  constexpr std::size_t kMost = 60;
  std::map<std::int64_t, bool> found;
  std::vector<double> row(static_cast<std::size_t>(band.GetXSize()));
  for (int r = 0; r < band.GetYSize() && found.size() <= kMost; ++r) {
    if (band.RasterIO(GF_Read, 0, r, band.GetXSize(), 1, row.data(), band.GetXSize(), 1, GDT_Float64, 0, 0,
                      nullptr) != CE_None)
      break;
    for (const double value : row) {
      if (nodata && value == *nodata) continue;
      found.emplace(static_cast<std::int64_t>(value), true);
    }
  }
  std::string text;
  std::size_t count = 0;
  for (const auto& [value, seen] : found) {
    if (count++ == kMost) return text + " and more";
    text += (text.empty() ? "" : ", ") + std::to_string(value);
  }
  return text;
}

Result<ColorBands> chooseClasses(GDALDataset& dataset, const std::string& path,
                                 const ColorImageOptions& options) {
  if (dataset.GetRasterCount() != 1) {
    return refusedSource(
        path, fmt::format("a raster of classes has one band, this has {}", dataset.GetRasterCount()),
        bandsText(dataset), "Take out the one of classes, with gdal_translate -b");
  }
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if (!holdsClasses(band.GetRasterDataType())) {
    return refusedSource(
        path, fmt::format("numbers of type {} are no classes", GDALGetDataTypeName(band.GetRasterDataType())),
        "those are whole numbers", "Convert them, with gdal_translate -ot Int32");
  }
  ColorBands bands;
  bands.kind = ColorBands::Kind::kClasses;
  bands.bands = {1};
  bands.nodata = {nodataOf(band, options)};
  if (options.legend) return bands;
  if (band.GetColorTable() == nullptr) {
    return usageError(path, "the classes have no colours: the raster has no colour table",
                      "its classes are " + classesIn(band, bands.nodata.front()),
                      "Give a file with their colours with --legend");
  }
  bands.palette = paletteOf(*band.GetColorTable());
  return bands;
}

// The colour bands of a picture: red, green, blue, or one of grey.
Result<std::vector<int>> colorBandsOf(GDALDataset& dataset, const std::string& path, int alpha,
                                      std::vector<std::string>& warnings) {
  const std::vector<int> named = {bandOf(dataset, GCI_RedBand), bandOf(dataset, GCI_GreenBand),
                                  bandOf(dataset, GCI_BlueBand)};
  const int colors = dataset.GetRasterCount() - (alpha > 0 ? 1 : 0);
  if (named[0] > 0 && named[1] > 0 && named[2] > 0) {
    if (colors > 3)
      warnings.push_back(fmt::format("{}: of its {} bands red, green and blue are used", path, colors));
    return named;
  }
  std::vector<int> plain;
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    if (number != alpha) plain.push_back(number);
  }
  if (plain.size() == 1 || plain.size() == 3) return plain;
  return refusedSource(path, "which of its bands are red, green and blue is not said", bandsText(dataset),
                       "Take them out, with gdal_translate -b R -b G -b B -colorinterp red,green,blue");
}

}  // namespace

Result<ColorBands> chooseColorBands(GDALDataset& dataset, const std::string& path,
                                    const ColorImageOptions& options, std::vector<std::string>& warnings) {
  if (dataset.GetRasterCount() < 1)
    return refusedSource(path, "the image has no raster band", {}, "Name the raster in it");
  if (options.classes) return chooseClasses(dataset, path, options);
  ColorBands bands;
  bands.alpha = bandOf(dataset, GCI_AlphaBand);
  DELTAZ_TRY_ASSIGN(bands.bands, colorBandsOf(dataset, path, bands.alpha, warnings));
  GDALRasterBand& first = *dataset.GetRasterBand(bands.bands.front());
  if (bands.bands.size() == 1 && first.GetColorTable() != nullptr) {
    bands.kind = ColorBands::Kind::kPalette;
    bands.palette = paletteOf(*first.GetColorTable());
    if (!holdsClasses(first.GetRasterDataType()))
      return refusedSource(path, "the numbers of its palette are not whole numbers");
  } else {
    bands.most = 0;
    for (const int number : bands.bands) {
      DELTAZ_TRY_ASSIGN(const double full, fullOf(*dataset.GetRasterBand(number), path, false));
      bands.most = std::max(bands.most, full);
    }
  }
  if (bands.alpha > 0) {
    DELTAZ_TRY_ASSIGN(bands.most_alpha, fullOf(*dataset.GetRasterBand(bands.alpha), path, true));
  }
  bands.masked = (first.GetMaskFlags() & GMF_PER_DATASET) != 0 && (first.GetMaskFlags() & GMF_ALPHA) == 0;
  for (const int number : bands.bands)
    bands.nodata.push_back(nodataOf(*dataset.GetRasterBand(number), options));
  return bands;
}

}  // namespace deltaz
