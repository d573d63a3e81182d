#include "libdb/source/void_filling.h"

#include <algorithm>
#include <cmath>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <vector>

#include "libdb/source/gdal_session.h"

namespace deltaz {

namespace {

// Rounds of smoothing over what was filled, so that its edges do not show as creases.
constexpr int kSmoothings = 2;
// Below every height above the lowest.
constexpr float kUnfilled = -1;

}  // namespace

Result<std::uint64_t> fillVoidPosts(RawGrid& grid, const std::string& path) {
  if (std::find(grid.valid.begin(), grid.valid.end(), std::uint8_t{0}) == grid.valid.end())
    return std::uint64_t{0};
  const GdalSession session;
  const int columns = static_cast<int>(grid.header.x_axis.count),
            rows = static_cast<int>(grid.header.y_axis.count);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  if (driver == nullptr) return internalError(path, "GDAL has no memory driver");
  const GDALDatasetUniquePtr heights(driver->Create("", columns, rows, 1, GDT_Float32, nullptr));
  const GDALDatasetUniquePtr mask(driver->Create("", columns, rows, 1, GDT_Byte, nullptr));
  if (!heights || !mask) return accessError(path, "cannot fill the voids", session.lastFailure());
  // In quanta above the lowest, so that a float holds them as well as it can.
  const std::int32_t lowest = *std::min_element(grid.heights.begin(), grid.heights.end());
  std::vector<float> numbers(grid.heights.size());
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k] = grid.valid[k] == 0 ? kUnfilled : static_cast<float>(std::int64_t{grid.heights[k]} - lowest);
  GDALRasterBand& of_heights = *heights->GetRasterBand(1);
  GDALRasterBand& of_mask = *mask->GetRasterBand(1);
  bool failed = of_heights.RasterIO(GF_Write, 0, 0, columns, rows, numbers.data(), columns, rows, GDT_Float32,
                                    0, 0, nullptr) != CE_None;
  failed = failed || of_mask.RasterIO(GF_Write, 0, 0, columns, rows, grid.valid.data(), columns, rows,
                                      GDT_Byte, 0, 0, nullptr) != CE_None;
  failed = failed || GDALFillNodata(&of_heights, &of_mask, std::hypot(columns, rows), 0, kSmoothings, nullptr,
                                    nullptr, nullptr) != CE_None;
  failed = failed || of_heights.RasterIO(GF_Read, 0, 0, columns, rows, numbers.data(), columns, rows,
                                         GDT_Float32, 0, 0, nullptr) != CE_None;
  if (failed) return internalError(path, "the voids could not be filled: " + session.lastFailure());
  std::uint64_t filled = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (grid.valid[k] != 0 || !(numbers[k] >= 0)) continue;
    grid.heights[k] = static_cast<std::int32_t>(std::llround(numbers[k]) + lowest);
    grid.valid[k] = 1;
    if (!grid.void_kinds.empty()) grid.void_kinds[k] = 0;
    ++filled;
  }
  if (std::find(grid.valid.begin(), grid.valid.end(), std::uint8_t{0}) == grid.valid.end()) {
    grid.valid.clear();
    grid.void_kinds.clear();
    grid.header.sentinels.clear();
  }
  return filled;
}

}  // namespace deltaz
