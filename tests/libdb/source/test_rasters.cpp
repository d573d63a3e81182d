#include "tests/libdb/source/test_rasters.h"

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

namespace deltaz {

std::string makeRaster(const TemporaryDirectory& folder, const TestRaster& raster, const std::string& name) {
  GDALAllRegister();
  const std::string path = folder.file(name);
  GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), raster.columns, raster.rows, raster.bands, raster.type, nullptr));
  if (raster.georeferenced) {
    std::array<double, 6> transform = raster.transform;
    dataset->SetGeoTransform(transform.data());
  }
  if (!raster.crs.empty()) {
    OGRSpatialReference reference;
    reference.SetFromUserInput(raster.crs.c_str());
    dataset->SetSpatialRef(&reference);
  }
  if (raster.prepare) raster.prepare(*dataset);
  std::vector<double> values = raster.values;
  for (int row = 0; raster.values.empty() && row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) values.push_back(10 * row + column);
  }
  EXPECT_EQ(values.size(), static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows));
  EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, raster.columns, raster.rows, values.data(),
                                                raster.columns, raster.rows, GDT_Float64, 0, 0, nullptr),
            CE_None);
  if (raster.change) raster.change(*dataset);
  return path;
}

std::vector<double> storedValues(const std::string& path) {
  GDALAllRegister();
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(path.c_str()));
  EXPECT_TRUE(dataset != nullptr);
  if (!dataset) return {};
  const int columns = dataset->GetRasterXSize(), rows = dataset->GetRasterYSize();
  std::vector<double> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, values.data(), columns, rows,
                                                GDT_Float64, 0, 0, nullptr),
            CE_None);
  return values;
}

SourceArea readAll(const std::vector<std::string>& paths, const SourceOptions& options) {
  Result<SourceArea> area = readElevationSources(paths, options);
  EXPECT_TRUE(area.ok()) << area.error().message();
  return area.ok() ? std::move(area).value() : SourceArea{};
}

RawGrid readOne(const std::string& path, const SourceOptions& options, std::vector<std::string>* warnings) {
  SourceArea area = readAll({path}, options);
  if (warnings != nullptr) *warnings = area.warnings;
  EXPECT_EQ(area.grids.size(), 1u);
  return area.grids.empty() ? RawGrid{} : std::move(area.grids.front());
}

}  // namespace deltaz
