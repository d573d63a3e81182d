// Colours by height: a text file as `gdaldem color-relief` takes it. Each line gives a height in metres, a
// percentage of the area's range ("25%") or `nv` (no value), and a colour; between two heights codes are
// interpolated linearly, beyond the outermost the outermost colour holds. Errors: kInvalid, naming file and
// line; kCannotAccess. Thread-safety: const members from any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libdb/source/color_text.h"

namespace deltaz {

class ColorRamp {
 public:
  // `lowest` and `highest`: 0 % and 100 %, metres.
  static Result<ColorRamp> read(const std::string& path, double lowest, double highest);

  ColorCode colorAt(double height) const;
  // Of posts without a height; no cover unless the file says.
  ColorCode colorOfVoid() const { return of_void_; }

 private:
  struct Entry {
    double height = 0;
    ColorCode color{};
  };
  std::vector<Entry> entries_;  // by height
  ColorCode of_void_{};
};

}  // namespace deltaz
