// Georeferenced images as GDAL opens them: red, green and blue, grey, a palette, or classes with a legend;
// with an alpha band, a mask or nodata for what has no colour. Pixel (c, r) covers c .. c + 1, r .. r + 1 of
// the image, as GDAL counts, whatever the file is registered by.
//
// Bytes are sRGB codes; 16-bit numbers are scaled if the file says how many bits it uses or they fill their
// range, and refused if they do not. Errors: kUsage for what an option would settle, kInvalid for what is not
// taken, both naming the file; kCannotAccess. Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/area.h"
#include "libdb/access/color.h"
#include "libdb/source/class_legend.h"
#include "libdb/source/reference_system.h"

namespace deltaz {

struct ColorImageOptions {
  std::string crs = {};               // wins over what the image says; any form GDAL takes
  std::optional<double> nodata = {};  // stored value, of all colour bands, that means no colour
  // The image is of classes: it must have one band of whole numbers, and its own colour table if no legend is
  // given.
  bool classes = false;
  std::optional<ClassLegend> legend = {};
};

// A rectangle of pixels.
struct PixelWindow {
  int column = 0, row = 0, columns = 0, rows = 0;
};

class ColorImage {
 public:
  static Result<ColorImage> open(const std::string& path, const ColorImageOptions& options,
                                 std::vector<std::string>& warnings);
  ColorImage(ColorImage&&) noexcept;
  ~ColorImage();

  const std::string& path() const { return path_; }
  const ReferenceSystem& system() const { return system_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  // What identifies the file: base name and content.
  const SourceFile& source() const { return source_; }
  // Pixels are numbers that must not be mixed: take the nearest.
  bool isOfClasses() const { return classes_; }

  // Coordinates of the image's system (x east) into pixels, in place. Where the Earth repeats itself to the
  // east (turnLength) they are brought to within half a turn of the image's middle.
  void toPixels(std::span<double> x, std::span<double> y) const;
  // Coordinates of a place in the image, pixels.
  std::array<double, 2> coordinatesAt(double column, double row) const;
  // It goes once round the Earth: its first column follows its last.
  bool closesRound() const { return closes_round_; }
  // Whether the Earth repeats itself to the east in the image's system.
  bool hasTurn() const { return turn_ > 0; }
  // Columns after which the same places come again along a row; 0 where they never do.
  double columnsPerTurn() const;
  // A step in pixels as one in the image's coordinates.
  std::array<double, 2> coordinateStep(double columns, double rows) const;

  // The colours of a window that lies in the image, row by row from its first.
  Status read(const PixelWindow& window, std::span<CoveredColor> colors) const;

  // Of classes: those read so far that the legend does not name, in order.
  std::vector<std::int64_t> missingClasses() const;

 private:
  ColorImage();
  struct Opened;

  std::string path_;
  ReferenceSystem system_;
  SourceFile source_;
  int columns_ = 0, rows_ = 0;
  bool classes_ = false, closes_round_ = false;
  std::array<double, 6> transform_{}, inverse_{};  // GDAL's, pixels to coordinates and back
  double turn_ = 0;                                // turnLength of the system
  double middle_ = 0;                              // of the image, along x
  std::unique_ptr<Opened> opened_;
};

}  // namespace deltaz
