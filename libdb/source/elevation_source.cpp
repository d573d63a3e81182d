#include "libdb/source/elevation_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <limits>
#include <ogr_spatialref.h>

#include "formats/file_system.h"
#include "formats/terrain_segment.h"
#include "libdb/source/gdal_session.h"
#include "libdb/source/grid_placement.h"

namespace deltaz {

namespace {

constexpr double kDegreesTolerance = 1e-9;
constexpr int kRowsPerRead = 256;

Error refused(const std::string& path, std::string what, std::string why = {}, std::string remedy = {}) {
  return invalidError(IssueCode::kNone, path, std::move(what), std::move(why), std::move(remedy));
}

bool endsIn(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && std::equal(end.rbegin(), end.rend(), text.rbegin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

// The one raster inside a zip archive that its driver does not read by itself.
std::string rasterInsideZip(const std::string& path) {
  const std::string folder = "/vsizip/" + path;
  const CPLStringList names(VSIReadDir(folder.c_str()));
  std::string found;
  for (int i = 0; i < names.size(); ++i) {
    const std::string candidate = folder + "/" + names[i];
    if (GDALIdentifyDriver(candidate.c_str(), nullptr) == nullptr) continue;
    if (!found.empty()) return {};
    found = candidate;
  }
  return found;
}

Result<GDALDatasetUniquePtr> openRaster(const std::string& path, const GdalSession& session) {
  VSIStatBufL status;
  if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG | VSI_STAT_SIZE_FLAG) !=
      0) {
    return accessError(path, "cannot open the source", "there is no such file");
  }
  if (!VSI_ISDIR(status.st_mode) && !VSI_ISREG(status.st_mode))
    return refused(path, "the source is not a regular file", {}, "Copy it into one");
  if (VSI_ISDIR(status.st_mode))
    return refused(path, "a folder is not an elevation source", {}, "Name the file in it");
  if (status.st_size == 0) return refused(path, "the source is empty", "the file has no bytes");
  VSILFILE* readable = VSIFOpenL(path.c_str(), "rb");
  if (readable == nullptr)
    return accessError(path, "cannot open the source", "it cannot be read", "Check its permissions");
  VSIFCloseL(readable);
  constexpr unsigned kOpenFlags = GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR;
  GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str(), kOpenFlags));
  if (!dataset && endsIn(path, ".zip")) {
    if (const std::string inside = rasterInsideZip(path); !inside.empty()) {
      dataset.reset(GDALDataset::Open(inside.c_str(), kOpenFlags));
    }
  }
  if (!dataset)
    return refused(path, "this is not an elevation raster that can be read", session.lastFailure());
  return dataset;
}

Status addFile(const std::string& path, StreamingHash& hash) {
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (file == nullptr) return accessError(path, "cannot read the source");
  std::vector<std::byte> buffer(1 << 20);
  for (;;) {
    const std::size_t count = VSIFReadL(buffer.data(), 1, buffer.size(), file);
    hash.update(std::span(buffer).first(count));
    if (count < buffer.size()) break;
  }
  VSIFCloseL(file);
  return Success{};
}

// Hash of the source's bytes; of a virtual raster those of its members too, in GDAL's order.
Result<Hash128> hashOfContent(GDALDataset& dataset, const std::string& path) {
  StreamingHash hash;
  DELTAZ_TRY(addFile(path, hash));
  if (EQUAL(dataset.GetDriverName(), "VRT")) {
    const CPLStringList members(dataset.GetFileList());
    for (int i = 0; i < members.size(); ++i) {
      VSIStatBufL status;
      const bool is_file = VSIStatL(members[i], &status) == 0 && VSI_ISREG(status.st_mode);
      if (is_file && path != members[i]) DELTAZ_TRY(addFile(members[i], hash));
    }
  }
  return hash.digest();
}

// ---- units

struct UnitName {
  std::string_view name;
  Rational metres;
};
constexpr Rational kMetre{1, 1}, kFoot{381, 1250}, kSurveyFoot{1200, 3937};
constexpr std::array<UnitName, 16> kUnits = {{{"", kMetre},
                                              {"m", kMetre},
                                              {"metre", kMetre},
                                              {"metres", kMetre},
                                              {"meter", kMetre},
                                              {"meters", kMetre},
                                              {"ft", kFoot},
                                              {"foot", kFoot},
                                              {"feet", kFoot},
                                              {"international foot", kFoot},
                                              {"ft_int", kFoot},
                                              {"us-ft", kSurveyFoot},
                                              {"ftus", kSurveyFoot},
                                              {"us survey foot", kSurveyFoot},
                                              {"foot_us", kSurveyFoot},
                                              {"sft", kSurveyFoot}}};

// The unit of elevations that do not name their own: that of the vertical reference system, if there is one.
std::string unitOfVerticalSystem(const OGRSpatialReference& reference) {
  if (!reference.IsCompound()) return {};
  const char* name = nullptr;
  (void)reference.GetTargetLinearUnits("VERT_CS", &name);
  return name == nullptr ? "" : name;
}

Result<Rational> quantumOf(const std::string& path, const std::string& unit) {
  std::string lower = unit;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const UnitName& entry : kUnits) {
    if (entry.name == lower) return entry.metres;
  }
  return refused(path, fmt::format("the elevation unit '{}' is unknown", unit),
                 "known are metres, feet and US survey feet");
}

// ---- reference system

Status describeReferenceSystem(const OGRSpatialReference& stated, const std::string& path,
                               GridHeader& header) {
  OGRSpatialReference horizontal(stated);
  if (stated.IsCompound()) horizontal.StripVertical();
  if (horizontal.IsProjected()) {
    return refused(path, fmt::format("the source is projected ({})", horizontal.GetName()),
                   "this version reads geodetic sources only", "Warp it to geographic coordinates first");
  }
  if (!horizontal.IsGeographic()) return refused(path, "the source's reference system is not geographic");
  if (std::abs(horizontal.GetAngularUnits() - std::atan(1.0) / 45.0) > 1e-12) {
    return refused(path, "the source's coordinates are not in degrees");
  }
  if (std::abs(horizontal.GetPrimeMeridian()) > 0)
    return refused(path, "the source's prime meridian is not Greenwich");
  OGRErr failed = OGRERR_NONE;
  header.ellipsoid.semi_major_axis = horizontal.GetSemiMajor(&failed);
  if (failed != OGRERR_NONE) return refused(path, "the source's reference system has no ellipsoid");
  header.ellipsoid.inverse_flattening = horizontal.GetInvFlattening();
  const char* const datum = horizontal.GetAttrValue("DATUM");
  header.horizontal_datum = datum == nullptr ? "unknown" : datum;
  const char* const vertical = stated.IsCompound() ? stated.GetAttrValue("VERT_CS") : nullptr;
  header.vertical_datum = vertical == nullptr ? "unknown" : vertical;
  char* wkt = nullptr;
  const std::array<const char*, 2> options = {"FORMAT=WKT2_2018", nullptr};
  stated.exportToWkt(&wkt, options.data());
  header.crs_wkt = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
  // WKT has no room for the epoch of coordinates in a dynamic datum.
  if (stated.GetCoordinateEpoch() > 0) header.coordinate_epoch = stated.GetCoordinateEpoch();
  return Success{};
}

// ---- what is read and what is not

Status checkBand(GDALDataset& dataset, const std::string& path) {
  if (dataset.GetRasterCount() != 1) {
    return refused(path, fmt::format("the source has {} bands", dataset.GetRasterCount()),
                   "this version reads one band", "Extract the elevations into a file of their own");
  }
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const GDALDataType type = band.GetRasterDataType();
  if (type != GDT_Byte && type != GDT_Int16 && type != GDT_UInt16 && type != GDT_Int32) {
    return refused(path, fmt::format("elevations of type {} are not read", GDALGetDataTypeName(type)),
                   "this version reads integers of up to 32 bits");
  }
  if (band.GetScale(nullptr) != 1.0 || band.GetOffset(nullptr) != 0.0) {
    return refused(path, "the source scales its elevations", "this version reads plain integers");
  }
  if (band.GetColorTable() != nullptr) {
    return refused(path, "the source has a colour table",
                   "its values are classes or colours, not elevations");
  }
  if ((band.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) != 0) {
    return refused(path, "the source marks its voids with a mask of its own",
                   "this version reads a nodata value", "Convert it with a nodata value first");
  }
  return Success{};
}

Status placeGrid(const SourceDescription& source, const std::string& path, GridHeader& header) {
  const std::array<double, 6>& transform = source.geotransform;
  if (transform[2] != 0 || transform[4] != 0)
    return refused(path, "the source is rotated against its coordinate axes");
  if (!(transform[1] > 0) || transform[5] == 0 || !std::isfinite(transform[0]) ||
      !std::isfinite(transform[3])) {
    return refused(path, "the source's columns do not run from west to east");
  }
  if (source.columns < 2 || source.rows < 2) return refused(path, "the source has fewer than 2 x 2 posts");
  const double spacing_y = std::abs(transform[5]);
  if (transform[1] < kLeastSpacingDegrees || spacing_y < kLeastSpacingDegrees) {
    return refused(path, "the source's posts are less than 0.1 mm apart",
                   "its georeferencing is hardly meant so");
  }
  double west = transform[0] + 0.5 * transform[1];
  const double first_row = transform[3] + 0.5 * transform[5];
  const double last_row = transform[3] + (static_cast<double>(source.rows) - 0.5) * transform[5];
  const double south = std::min(first_row, last_row);
  const double north = std::max(first_row, last_row);
  if (south < -90 - kDegreesTolerance || north > 90 + kDegreesTolerance) {
    return refused(path, fmt::format("the source reaches from latitude {} to {}", south, north),
                   "there is no such latitude");
  }
  const double width = static_cast<double>(source.columns - 1) * transform[1];
  if (width > 360 + kDegreesTolerance || std::abs(west) > 720)
    return refused(path, "the source goes more than once round the Earth");
  // The west edge in [-180, 180), also when rounding left it a hair below.
  while (west < -180 - kDegreesTolerance) west += 360;
  while (west >= 180 - kDegreesTolerance) west -= 360;
  header.x_axis = placeAxis(west, transform[1], source.columns, kLongitudeOrigin);
  header.y_axis = placeAxis(south, spacing_y, source.rows, kLatitudeOrigin);
  return Success{};
}

// Reads all rows, south first, and marks the voids.
Status readPosts(GDALDataset& dataset, const std::string& path, const GdalSession& session, RawGrid& grid) {
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const SourceDescription& source = grid.header.sources.front();
  const auto columns = static_cast<std::size_t>(source.columns);
  const int rows = static_cast<int>(source.rows);
  const bool south_up = source.geotransform[5] > 0;
  grid.heights.resize(columns * static_cast<std::size_t>(rows));
  std::vector<std::int32_t> buffer(columns * kRowsPerRead);
  for (int first = 0; first < rows; first += kRowsPerRead) {
    const int count = std::min(kRowsPerRead, rows - first);
    if (band.RasterIO(GF_Read, 0, first, static_cast<int>(columns), count, buffer.data(),
                      static_cast<int>(columns), count, GDT_Int32, 0, 0, nullptr) != CE_None) {
      return refused(path, "the source cannot be read to its end", session.lastFailure(),
                     "It is damaged or cut short");
    }
    for (int row = 0; row < count; ++row) {
      const int target = south_up ? first + row : rows - 1 - (first + row);
      std::copy_n(buffer.begin() + static_cast<std::ptrdiff_t>(columns) * row, columns,
                  grid.heights.begin() + static_cast<std::ptrdiff_t>(columns) * target);
    }
  }
  std::size_t voids = 0;
  if (source.nodata && *source.nodata == std::floor(*source.nodata)) {
    const double sentinel = *source.nodata;
    for (std::size_t k = 0; k < grid.heights.size(); ++k) {
      if (static_cast<double>(grid.heights[k]) != sentinel) continue;
      if (voids++ == 0) grid.valid.assign(grid.heights.size(), 1);
      grid.valid[k] = 0;
      grid.heights[k] = 0;
    }
  }
  if (voids == grid.heights.size())
    return refused(path, "the source has no elevations", "every post is void");
  for (std::size_t k = 0; k < grid.heights.size(); ++k) {
    if (std::abs(static_cast<std::int64_t>(grid.heights[k])) > kMaximumHeightQuanta) {
      return refused(path, fmt::format("the elevation {} is out of range", grid.heights[k]));
    }
  }
  return Success{};
}

Result<RawGrid> readOpened(GDALDataset& dataset, const std::string& path, const SourceOptions& options,
                           const GdalSession& session) {
  RawGrid grid;
  DELTAZ_TRY(checkBand(dataset, path));
  SourceDescription source;
  source.name = baseName(path);
  source.driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  source.columns = dataset.GetRasterXSize();
  source.rows = dataset.GetRasterYSize();
  if (dataset.GetGeoTransform(source.geotransform.data()) != CE_None) {
    return refused(path, "the source is not georeferenced", "it does not say where its posts are");
  }
  const char* const registration = dataset.GetMetadataItem(GDALMD_AREA_OR_POINT);
  source.point_registered = registration != nullptr && EQUAL(registration, GDALMD_AOP_POINT);
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  source.data_type = GDALGetDataTypeName(band.GetRasterDataType());
  source.unit = band.GetUnitType();
  int has_nodata = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  if (has_nodata != 0 && std::isfinite(nodata)) source.nodata = nodata;
  DELTAZ_TRY_ASSIGN(source.content, hashOfContent(dataset, path));

  OGRSpatialReference reference;
  if (const OGRSpatialReference* stated = dataset.GetSpatialRef(); stated != nullptr) {
    reference = *stated;
  } else if (options.crs.empty()) {
    return usageError(path, "the source does not say what its coordinates refer to",
                      "it has no coordinate reference system",
                      "Give one with --crs, for example --crs EPSG:4326");
  } else if (reference.SetFromUserInput(options.crs.c_str()) != OGRERR_NONE) {
    return usageError("--crs", fmt::format("'{}' is not a coordinate reference system", options.crs),
                      session.lastFailure());
  }
  DELTAZ_TRY(describeReferenceSystem(reference, path, grid.header));
  if (const char* dted = dataset.GetMetadataItem("DTED_VerticalDatum");
      dted != nullptr && grid.header.vertical_datum == "unknown") {
    grid.header.vertical_datum = dted;
  }
  grid.header.unit = "metre";
  DELTAZ_TRY_ASSIGN(grid.header.quantum,
                    quantumOf(path, source.unit.empty() ? unitOfVerticalSystem(reference) : source.unit));
  DELTAZ_TRY(placeGrid(source, path, grid.header));
  grid.header.sources.push_back(source);
  DELTAZ_TRY(readPosts(dataset, path, session, grid));
  return grid;
}

}  // namespace

Result<RawGrid> readElevationSource(const std::string& path, const SourceOptions& options) {
  try {
    const GdalSession session;
    DELTAZ_TRY_ASSIGN(const GDALDatasetUniquePtr dataset, openRaster(path, session));
    return readOpened(*dataset, path, options, session);
  } catch (const std::bad_alloc&) {
    return accessError(path, "cannot read the source", "there is not enough memory for all its posts");
  } catch (const std::exception& exception) {
    return internalError(path, exception.what());
  }
}

}  // namespace deltaz
