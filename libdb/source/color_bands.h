// Which bands of a GDAL dataset are which colour, and what their numbers mean. Errors as color_image.h.
// Thread-safety: as the dataset's.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "libdb/source/color_image.h"

class GDALDataset;

namespace deltaz {

struct ColorBands {
  enum class Kind { kColors, kPalette, kClasses };
  Kind kind = Kind::kColors;
  std::vector<int> bands;  // counted from 1: three of colours, or one (grey, palette, classes)
  int alpha = 0;           // 0: none
  bool masked = false;     // a mask of the whole dataset counts
  double most = 255;       // number that means full
  double most_alpha = 255;
  std::vector<std::optional<double>> nodata;  // of each of `bands`
  std::vector<ColorCode> palette;             // by number
};

Result<ColorBands> chooseColorBands(GDALDataset& dataset, const std::string& path,
                                    const ColorImageOptions& options, std::vector<std::string>& warnings);

}  // namespace deltaz
