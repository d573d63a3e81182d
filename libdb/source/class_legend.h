// The colours of classes: a text file of lines `class R G B [A] [label]` (libdb/source/color_text.h), or what
// a raster's own colour table says. Errors: kInvalid, naming file and line; kCannotAccess. Thread-safety:
// plain value.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "libdb/source/color_text.h"

namespace deltaz {

struct ClassLegend {
  std::map<std::int64_t, ColorCode> colors;

  static Result<ClassLegend> read(const std::string& path);
};

}  // namespace deltaz
