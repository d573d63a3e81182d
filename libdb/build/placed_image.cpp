#include "libdb/build/placed_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "libdb/access/color_map.h"
#include "libdb/build/grid_coordinates.h"
#include "libdb/build/image_field.h"
#include "libdb/source/gdal_session.h"

namespace deltaz {

namespace {

// Rectangles no longer than this are placed point by point.
constexpr int kShortest = 4;
constexpr int kProbes = 9;  // along a side of a block that is asked whether an image touches it

bool isPlace(double column, double row) {
  return std::isfinite(column) && std::isfinite(row);
}

}  // namespace

Result<std::unique_ptr<PlacedImage>> PlacedImage::make(const GridHeader& grid, const ColorImage& image,
                                                       bool allow_ballpark) {
  const GdalSession session;
  DELTAZ_TRY_ASSIGN(ReferenceSystem system,
                    parseReferenceSystem(grid.crs_wkt, "area.json", grid.coordinate_epoch));
  std::unique_ptr<PlacedImage> placed(new PlacedImage(grid, image, std::move(system), allow_ballpark));
  // The first says whether there is a way at all.
  DELTAZ_TRY_ASSIGN(CoordinateChange change, placed->takeChange());
  placed->giveBack(std::move(change));
  return placed;
}

Result<CoordinateChange> PlacedImage::takeChange() const {
  {
    const std::lock_guard guard(mutex_);
    if (!idle_.empty()) {
      CoordinateChange change = std::move(idle_.back());
      idle_.pop_back();
      return change;
    }
  }
  return CoordinateChange::between(system_, image_.system(), allow_ballpark_, image_.path());
}

void PlacedImage::giveBack(CoordinateChange change) const {
  const std::lock_guard guard(mutex_);
  idle_.push_back(std::move(change));
}

Status PlacedImage::toPixels(std::span<double> columns, std::span<double> rows) const {
  const GdalSession session;
  for (double& column : columns) column = xCoordinateAt(grid_, column);
  for (double& row : rows) row = yCoordinateAt(grid_, row);
  DELTAZ_TRY_ASSIGN(CoordinateChange change, takeChange());
  (void)change.apply(columns, rows);  // what has no counterpart is NaN
  giveBack(std::move(change));
  image_.toPixels(columns, rows);
  return Success{};
}

// `points` x `points` places spread over the block from edge to edge; NaN throughout if that fails.
PixelPlaces PlacedImage::lattice(const TexelBlock& block, int points) const {
  const double texel = colorTexelCells(grid_.leaf_cells, block.level);
  PixelPlaces places;
  for (int j = 0; j < points; ++j) {
    for (int i = 0; i < points; ++i) {
      const double u = static_cast<double>(i) / (points - 1), v = static_cast<double>(j) / (points - 1);
      places.column.push_back((static_cast<double>(block.first_column) + u * block.columns) * texel);
      places.row.push_back((static_cast<double>(block.first_row) + v * block.rows) * texel);
    }
  }
  if (!toPixels(places.column, places.row).ok()) {
    std::fill(places.column.begin(), places.column.end(), std::nan(""));
  }
  return places;
}

bool PlacedImage::touches(const TexelBlock& block) const {
  const PixelPlaces places = lattice(block, kProbes);
  std::array<double, 2> columns = {HUGE_VAL, -HUGE_VAL}, rows = {HUGE_VAL, -HUGE_VAL};
  bool whole = true;
  for (std::size_t k = 0; k < places.column.size(); ++k) {
    if (!isPlace(places.column[k], places.row[k])) {
      whole = false;
      continue;
    }
    columns = {std::min(columns[0], places.column[k]), std::max(columns[1], places.column[k])};
    rows = {std::min(rows[0], places.row[k]), std::max(rows[1], places.row[k])};
  }
  if (columns[0] > columns[1]) return false;
  // Between the places the block may reach a little farther; where it leaves the projection's realm,
  // anywhere.
  if (!whole) return true;
  const double slack_x = 1 + (columns[1] - columns[0]) / 8, slack_y = 1 + (rows[1] - rows[0]) / 8;
  const bool beside = columns[1] + slack_x < 0 || columns[0] - slack_x > image_.columns();
  return (image_.closesRound() || !beside) && rows[1] + slack_y >= 0 && rows[0] - slack_y <= image_.rows();
}

double PlacedImage::pixelsPerTexel(const TexelBlock& block, int level) const {
  constexpr int kPoints = 5;
  const PixelPlaces places = lattice(block, kPoints);
  const double texels_x = block.columns / (kPoints - 1.0), texels_y = block.rows / (kPoints - 1.0);
  double longest = 0;
  const auto include = [&](std::size_t a, std::size_t b, double texels) {
    const double x = places.column[b] - places.column[a], y = places.row[b] - places.row[a];
    // Where longitudes jump by a turn the distance means nothing.
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    if (image_.closesRound() && std::abs(x) > 0.5 * image_.columns()) return;
    longest = std::max(longest, std::hypot(x, y) / texels);
  };
  for (std::size_t j = 0; j < kPoints; ++j) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      if (i + 1 < kPoints) include(j * kPoints + i, j * kPoints + i + 1, texels_x);
      if (j + 1 < kPoints) include(j * kPoints + i, (j + 1) * kPoints + i, texels_y);
    }
  }
  return std::ldexp(longest, level - block.level);
}

Result<PixelPlaces> PlacedImage::centres(const TexelBlock& block) const {
  const auto count = static_cast<std::size_t>(block.columns) * static_cast<std::size_t>(block.rows);
  PixelPlaces places{std::vector<double>(count), std::vector<double>(count)};
  DELTAZ_TRY(fill(block, 0, 0, block.columns, block.rows, places));
  return places;
}

// Places the texels (column, row) .. of the block: from its corners if five more places agree with them, else
// quarter by quarter.
Status PlacedImage::fill(const TexelBlock& block, int column, int row, int columns, int rows,
                         PixelPlaces& places) const {
  const double texel = colorTexelCells(grid_.leaf_cells, block.level);
  const auto posts_x = [&](double i) { return (static_cast<double>(block.first_column) + i + 0.5) * texel; };
  const auto posts_y = [&](double j) { return (static_cast<double>(block.first_row) + j + 0.5) * texel; };
  const auto at = [&](int i, int j) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(block.columns) +
           static_cast<std::size_t>(i);
  };
  if (columns <= kShortest && rows <= kShortest) {
    std::vector<double> x, y;
    for (int j = row; j < row + rows; ++j) {
      for (int i = column; i < column + columns; ++i) {
        x.push_back(posts_x(i));
        y.push_back(posts_y(j));
      }
    }
    DELTAZ_TRY(toPixels(x, y));
    std::size_t k = 0;
    for (int j = row; j < row + rows; ++j) {
      for (int i = column; i < column + columns; ++i) {
        places.column[at(i, j)] = x[k];
        places.row[at(i, j)] = y[k++];
      }
    }
    return Success{};
  }
  // Three by three from the first texel's centre to the last's.
  std::array<double, 9> x{}, y{};
  for (std::size_t k = 0; k < 9; ++k) {
    x[k] = posts_x(column + 0.5 * static_cast<double>(k % 3) * (columns - 1));
    y[k] = posts_y(row + 0.5 * static_cast<double>(k / 3) * (rows - 1));
  }
  DELTAZ_TRY(toPixels(x, y));
  const auto between = [](const std::array<double, 9>& value, double u, double v) {
    return (value[0] * (1 - u) + value[2] * u) * (1 - v) + (value[6] * (1 - u) + value[8] * u) * v;
  };
  double off = 0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double u = 0.5 * static_cast<double>(k % 3), v = 0.5 * static_cast<double>(k / 3);
    const double distance = std::hypot(x[k] - between(x, u, v), y[k] - between(y, u, v));
    off = std::isfinite(distance) ? std::max(off, distance) : HUGE_VAL;
  }
  if (off <= kPlaceTolerance) {
    for (int j = 0; j < rows; ++j) {
      const double v = rows == 1 ? 0 : static_cast<double>(j) / (rows - 1);
      for (int i = 0; i < columns; ++i) {
        const double u = columns == 1 ? 0 : static_cast<double>(i) / (columns - 1);
        places.column[at(column + i, row + j)] = between(x, u, v);
        places.row[at(column + i, row + j)] = between(y, u, v);
      }
    }
    return Success{};
  }
  const int left = columns > kShortest ? columns / 2 : columns, low = rows > kShortest ? rows / 2 : rows;
  for (const auto& [j, height] : {std::pair(row, low), std::pair(row + low, rows - low)}) {
    for (const auto& [i, width] : {std::pair(column, left), std::pair(column + left, columns - left)}) {
      if (width > 0 && height > 0) DELTAZ_TRY(fill(block, i, j, width, height, places));
    }
  }
  return Success{};
}

}  // namespace deltaz
