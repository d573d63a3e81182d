// Small GeoTIFFs for the tests of the import.
#pragma once

#include <array>
#include <functional>
#include <gdal_priv.h>
#include <string>
#include <vector>

#include "libdb/source/elevation_source.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {

struct TestRaster {
  GDALDataType type = GDT_Int16;
  int columns = 5, rows = 4, bands = 1;
  std::array<double, 6> transform = {-80.5 / 3600, 1.0 / 3600, 0, 43.5 / 3600, 0, -1.0 / 3600};
  std::string crs = "EPSG:4326";
  bool georeferenced = true;
  std::vector<double> values;                 // row by row from the first; empty: 10 * row + column
  std::function<void(GDALDataset&)> prepare;  // before the posts are written
  std::function<void(GDALDataset&)> change;   // after
};

// Its path.
std::string makeRaster(const TemporaryDirectory& folder, const TestRaster& raster = {},
                       const std::string& name = "dem.tif");

// All stored values of a raster's first band, row by row from the first.
std::vector<double> storedValues(const std::string& path);

// Reads a raster that must be accepted; the warnings too if asked for.
RawGrid readOne(const std::string& path, const SourceOptions& options = {},
                std::vector<std::string>* warnings = nullptr);
SourceArea readAll(const std::vector<std::string>& paths, const SourceOptions& options = {});

}  // namespace deltaz
