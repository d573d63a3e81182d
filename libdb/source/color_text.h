// Text files of values and their colours, as GDAL's gdaldem and QGIS write them: a value and `R G B [A]`
// (0 .. 255) or a colour's name a line, separated by spaces, tabs, commas or colons; '#' begins a comment.
// Errors: kInvalid, naming file and line; kCannotAccess. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/error.h"
#include "libdb/access/color.h"

namespace deltaz {

// sRGB codes and opacity.
using ColorCode = std::array<std::uint8_t, 4>;

CoveredColor coveredColor(const ColorCode& code);

struct ColorLine {
  int line = 0;       // counted from 1
  std::string value;  // as written
  ColorCode color{};
  std::string label;  // what follows; may be empty
};

// What is common to both uses. Lines of QGIS that say how it interpolates are passed over.
Result<std::vector<ColorLine>> readColorLines(const std::string& path);

// kInvalid that names the line.
Error badColorLine(const std::string& path, const ColorLine& line, const std::string& what);

}  // namespace deltaz
