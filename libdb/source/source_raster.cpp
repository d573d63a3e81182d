#include "libdb/source/source_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "libdb/source/gdal_session.h"
#include "libdb/source/height_units.h"
#include "libdb/source/source_error.h"
#include "libdb/source/source_opening.h"
#include "libdb/source/source_placement.h"
#include "libdb/source/source_posts.h"
#include "libdb/source/stated_system.h"
#include "libdb/source/usgs_dem_check.h"

namespace deltaz {

namespace {

constexpr int kRowsPerRead = 256;

// ---- which band

std::string bandText(GDALRasterBand& band, int number) {
  const std::string description = band.GetDescription();
  return fmt::format("{} ({}{}{})", number, GDALGetDataTypeName(band.GetRasterDataType()),
                     band.GetColorInterpretation() == GCI_Undefined
                         ? ""
                         : fmt::format(", {}", GDALGetColorInterpretationName(band.GetColorInterpretation())),
                     description.empty() ? "" : ", " + description);
}

// The band of elevations: the one asked for, else the only one that is no mask.
Result<int> chooseBand(GDALDataset& dataset, const std::string& path, int wanted) {
  const int count = dataset.GetRasterCount();
  if (count < 1) return refusedSource(path, "the source has no raster band", {}, "Name the raster in it");
  if (wanted > 0) {
    if (wanted > count)
      return usageError("--band", fmt::format("{} has no band {}", path, wanted),
                        fmt::format("it has {}", count));
    return wanted;
  }
  std::vector<int> candidates;
  std::string list;
  for (int number = 1; number <= count; ++number) {
    GDALRasterBand& band = *dataset.GetRasterBand(number);
    if (band.GetColorInterpretation() != GCI_AlphaBand) candidates.push_back(number);
    list += (list.empty() ? "" : ", ") + bandText(band, number);
  }
  if (candidates.size() == 1) return candidates.front();
  return usageError(path,
                    fmt::format("the source has {} bands, and which one holds elevations is not said", count),
                    list, "Choose one with --band, if one of them does");
}

Status checkBand(GDALRasterBand& band, const std::string& path) {
  if (band.GetColorTable() != nullptr) {
    return refusedSource(path, "the source has a colour table",
                         "its values are classes or colours, not elevations");
  }
  if (!storedTypeOf(GDALGetDataTypeName(band.GetRasterDataType()))) {
    return refusedSource(
        path,
        fmt::format("elevations of type {} are not read", GDALGetDataTypeName(band.GetRasterDataType())),
        "a height is one number");
  }
  // GDAL before 3.7 reads signed bytes as unsigned ones, and tells them only so.
  if (const char* signedness = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
      signedness != nullptr && EQUAL(signedness, "SIGNEDBYTE")) {
    return refusedSource(path, "elevations of signed bytes are not read", {}, "Convert them to Int16 first");
  }
  return Success{};
}

// ---- the posts

Error unreadable(const std::string& path, const GdalSession& session) {
  return refusedSource(path, "the source cannot be read to its end", session.lastFailure(),
                       "It is damaged or cut short");
}

// Reads all rows of a band, south first. T is what GDAL converts to.
template <typename T>
Result<std::vector<T>> readRows(GDALRasterBand& band, GDALDataType type, const SourceDescription& source,
                                const std::string& path, const GdalSession& session) {
  const auto columns = static_cast<std::size_t>(source.columns);
  const int rows = static_cast<int>(source.rows);
  const bool south_up = source.geotransform[5] > 0;
  std::vector<T> posts(columns * static_cast<std::size_t>(rows));
  std::vector<T> buffer(columns * kRowsPerRead);
  for (int first = 0; first < rows; first += kRowsPerRead) {
    const int count = std::min(kRowsPerRead, rows - first);
    if (band.RasterIO(GF_Read, 0, first, static_cast<int>(columns), count, buffer.data(),
                      static_cast<int>(columns), count, type, 0, 0, nullptr) != CE_None)
      return unreadable(path, session);
    for (int row = 0; row < count; ++row) {
      const int target = south_up ? first + row : rows - 1 - (first + row);
      std::copy_n(buffer.begin() + static_cast<std::ptrdiff_t>(columns) * row, columns,
                  posts.begin() + static_cast<std::ptrdiff_t>(columns) * target);
    }
  }
  return posts;
}

Result<PostValues> readValues(GDALRasterBand& band, const StoredType& type, const SourceDescription& source,
                              const std::string& path, const GdalSession& session) {
  PostValues values;
  const bool fits = !type.floating && type.lowest >= -2147483648.0 && type.highest <= 2147483647.0;
  if (fits) {
    DELTAZ_TRY_ASSIGN(values.integers, readRows<std::int32_t>(band, GDT_Int32, source, path, session));
  } else {
    DELTAZ_TRY_ASSIGN(values.numbers, readRows<double>(band, GDT_Float64, source, path, session));
  }
  return values;
}

// The band that says how opaque each post is, if there is one. GDAL makes a mask of it for some types only.
GDALRasterBand* alphaBand(GDALDataset& dataset) {
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    GDALRasterBand* const band = dataset.GetRasterBand(number);
    if (band->GetColorInterpretation() == GCI_AlphaBand) return band;
  }
  return nullptr;
}

// 1 where a mask or an alpha band of the source says void; empty if it has none.
Result<std::vector<std::uint8_t>> readMask(GDALDataset& dataset, GDALRasterBand& band,
                                           const SourceDescription& source, const std::string& path,
                                           const GdalSession& session) {
  std::vector<std::uint8_t> masked;
  if ((band.GetMaskFlags() & GMF_PER_DATASET) != 0 && (band.GetMaskFlags() & GMF_ALPHA) == 0) {
    DELTAZ_TRY_ASSIGN(masked, readRows<std::uint8_t>(*band.GetMaskBand(), GDT_Byte, source, path, session));
    for (std::uint8_t& value : masked) value = value == 0 ? 1 : 0;
  }
  GDALRasterBand* const alpha = alphaBand(dataset);
  if (alpha == nullptr || alpha == &band) return masked;
  DELTAZ_TRY_ASSIGN(const std::vector<float> opacity,
                    readRows<float>(*alpha, GDT_Float32, source, path, session));
  masked.resize(opacity.size(), 0);
  for (std::size_t k = 0; k < opacity.size(); ++k) {
    if (opacity[k] == 0) masked[k] = 1;
  }
  return masked;
}

// ---- what the source says

void describeBand(GDALDataset& dataset, GDALRasterBand& band, const SourceOptions& options,
                  SourceDescription& source) {
  source.data_type = GDALGetDataTypeName(band.GetRasterDataType());
  source.unit = band.GetUnitType();
  source.scale = band.GetScale(nullptr);
  source.offset = band.GetOffset(nullptr);
  int has_nodata = 0;
  double nodata = 0;
  if (band.GetRasterDataType() == GDT_Int64) {
    nodata = static_cast<double>(band.GetNoDataValueAsInt64(&has_nodata));
  } else if (band.GetRasterDataType() == GDT_UInt64) {
    nodata = static_cast<double>(band.GetNoDataValueAsUInt64(&has_nodata));
  } else {
    nodata = band.GetNoDataValue(&has_nodata);
  }
  if (has_nodata != 0 && !std::isinf(nodata)) source.nodata = nodata;
  if (options.nodata) source.nodata = options.nodata;
  const char* const registration = dataset.GetMetadataItem(GDALMD_AREA_OR_POINT);
  source.point_registered = registration != nullptr && EQUAL(registration, GDALMD_AOP_POINT);
}

void fillHeader(const ReferenceSystem& system, GDALDataset& dataset, GridHeader& header) {
  header.unit = "metre";
  header.crs_wkt = system.wkt;
  header.coordinate_epoch = system.epoch;
  header.ellipsoid = system.ellipsoid;
  header.horizontal_datum = system.horizontal_datum;
  header.vertical_datum = system.vertical_datum;
  if (const char* dted = dataset.GetMetadataItem("DTED_VerticalDatum");
      dted != nullptr && header.vertical_datum == "unknown")
    header.vertical_datum = dted;
}

Result<SourceRaster> readOpened(GDALDataset& dataset, const std::string& path, const SourceOptions& options,
                                const GdalSession& session, std::vector<std::string>& warnings) {
  SourceRaster raster;
  raster.path = path;
  DELTAZ_TRY_ASSIGN(const int band_number, chooseBand(dataset, path, options.band));
  GDALRasterBand& band = *dataset.GetRasterBand(band_number);
  DELTAZ_TRY(checkBand(band, path));
  SourceDescription source;
  source.name = baseName(path);
  source.driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  source.columns = dataset.GetRasterXSize();
  source.rows = dataset.GetRasterYSize();
  source.band = band_number;
  if (dataset.GetGeoTransform(source.geotransform.data()) != CE_None)
    return refusedSource(path, "the source is not georeferenced", "it does not say where its posts are");
  describeBand(dataset, band, options, source);
  if (source.scale == 0 || !std::isfinite(source.scale) || !std::isfinite(source.offset))
    return refusedSource(
        path, fmt::format("the source scales its elevations by {} and adds {}", source.scale, source.offset));
  DELTAZ_TRY_ASSIGN(raster.system, statedSystem(dataset, path, options.crs, warnings));
  DELTAZ_TRY_ASSIGN(source.content, hashOfContent(path, membersOfVirtual(dataset)));
  fillHeader(raster.system, dataset, raster.grid.header);
  DELTAZ_TRY(placeSource(source, path, raster.system, raster.grid.header, warnings));

  PostMeaning meaning;
  meaning.path = path;
  meaning.source = source;
  meaning.quantum = options.quantum;
  const std::optional<StoredType> type = storedTypeOf(source.data_type);
  if (!type) return refusedSource(path, fmt::format("elevations of type {} are not read", source.data_type));
  meaning.type = *type;
  const std::string unit = source.unit.empty() ? raster.system.vertical_unit : source.unit;
  const std::optional<Rational> metres = metresPerUnit(unit);
  if (!metres) {
    return refusedSource(path, fmt::format("the elevation unit '{}' is unknown", unit),
                         "known are metres, feet and US survey feet");
  }
  meaning.unit = *metres;
  const int failures = session.failures();
  DELTAZ_TRY_ASSIGN(PostValues values, readValues(band, *type, source, path, session));
  DELTAZ_TRY_ASSIGN(const std::vector<std::uint8_t> masked, readMask(dataset, band, source, path, session));
  // Some drivers stop reading without a failed call.
  if (session.failures() > failures) return unreadable(path, session);
  if (source.driver == "USGSDEM") DELTAZ_TRY(checkUsgsDemComplete(path, static_cast<int>(source.columns)));
  DELTAZ_TRY(interpretPosts(std::move(values), masked, meaning, raster.grid, warnings));
  raster.grid.header.sources.push_back(meaning.source);
  return raster;
}

}  // namespace

Result<SourceRaster> readSourceRaster(const std::string& path, const SourceOptions& options,
                                      std::vector<std::string>& warnings) {
  const GdalSession session;
  constexpr unsigned kOpenFlags = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), kOpenFlags));
  if (!dataset) {
    return refusedSource(path, "this is not an elevation raster that can be read", session.lastFailure());
  }
  return readOpened(*dataset, path, options, session, warnings);
}

}  // namespace deltaz
