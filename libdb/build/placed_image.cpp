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

// Whether the image may lie in the block. Columns are followed from place to place, so that a turn of the
// Earth is no jump.
bool PlacedImage::touches(const TexelBlock& block) const {
  const double texel = colorTexelCells(grid_.leaf_cells, block.level);
  PixelPlaces places;
  for (int j = 0; j < kProbes; ++j) {
    for (int i = 0; i < kProbes; ++i) {
      const double u = i / (kProbes - 1.0), v = j / (kProbes - 1.0);
      places.column.push_back((static_cast<double>(block.first_column) + u * block.columns) * texel);
      places.row.push_back((static_cast<double>(block.first_row) + v * block.rows) * texel);
    }
  }
  if (!toPixels(places.column, places.row).ok()) return true;
  const double turn = image_.columnsPerTurn();
  std::array<double, 2> columns = {HUGE_VAL, -HUGE_VAL}, rows = {HUGE_VAL, -HUGE_VAL};
  std::size_t missing = 0;
  bool winds = false;
  for (std::size_t k = 0; k < places.column.size(); ++k) {
    double& column = places.column[k];
    if (!isPlace(column, places.row[k])) {
      ++missing;
      continue;
    }
    const std::size_t before = k % kProbes > 0 ? k - 1 : k < kProbes ? k : k - kProbes;
    if (turn > 0 && isPlace(places.column[before], places.row[before])) {
      const double step = std::remainder(column - places.column[before], turn);
      column = places.column[before] + step;
      winds = winds || std::abs(step) > 0.25 * turn;
    }
    columns = {std::min(columns[0], column), std::max(columns[1], column)};
    rows = {std::min(rows[0], places.row[k]), std::max(rows[1], places.row[k])};
  }
  if (columns[0] > columns[1]) return false;
  // Where much of the block has left the projection's realm the rest tells little of it.
  if (missing > places.column.size() / 4) return true;
  // Between the places the block may reach a little farther, and farther still beyond the last good one.
  double slack_x = 1 + (columns[1] - columns[0]) / 8, slack_y = 1 + (rows[1] - rows[0]) / 8;
  if (missing > 0) slack_x = slack_y = 8 * std::max(slack_x, slack_y);
  if (rows[1] + slack_y < 0 || rows[0] - slack_y > image_.rows()) return false;
  const double west = columns[0] - slack_x, east = columns[1] + slack_x;
  if (turn > 0) return winds || west - turn * std::floor(east / turn) <= image_.columns();
  return east >= 0 && west <= image_.columns();
}

// Measured where the places of a lattice lie in the image, or at the one nearest to it if none does.
double PlacedImage::pixelsPerTexel(const TexelBlock& block, int level) const {
  constexpr int kPoints = 5;
  constexpr std::size_t kAround = 5;  // a place and those to the east, west, north and south
  const double texel = colorTexelCells(grid_.leaf_cells, block.level);
  const double step_x = block.columns / 64.0, step_y = block.rows / 64.0;  // texels of the block
  PixelPlaces places;
  for (int j = 0; j < kPoints; ++j) {
    for (int i = 0; i < kPoints; ++i) {
      const double x = static_cast<double>(block.first_column) + block.columns * i / (kPoints - 1.0),
                   y = static_cast<double>(block.first_row) + block.rows * j / (kPoints - 1.0);
      for (const double dx : {0.0, step_x, -step_x, 0.0, 0.0}) places.column.push_back((x + dx) * texel);
      for (const double dy : {0.0, 0.0, 0.0, step_y, -step_y}) places.row.push_back((y + dy) * texel);
    }
  }
  if (!toPixels(places.column, places.row).ok()) return 0;
  double longest = 0, nearest = HUGE_VAL;
  for (std::size_t k = 0; k < places.column.size(); k += kAround) {
    const double x = places.column[k], y = places.row[k];
    if (!isPlace(x, y)) continue;
    const double away =
        std::hypot(std::max({0.0, -x, x - image_.columns()}), std::max({0.0, -y, y - image_.rows()}));
    if (away > nearest) continue;
    const std::optional<double> pixels = longestStep(places, k, step_x, step_y);
    if (!pixels) continue;
    longest = away < nearest ? *pixels : std::max(longest, *pixels);
    nearest = away;
  }
  return std::ldexp(longest, level - block.level);
}

// The longest side of a texel, pixels, from a place and the four around it; nothing where they have none.
std::optional<double> PlacedImage::longestStep(const PixelPlaces& places, std::size_t here, double texels_x,
                                               double texels_y) const {
  // Of the steps to both sides the shorter: the other may lead over a seam of the projection.
  const auto step = [&](std::size_t a, std::size_t b, double texels) {
    std::array<double, 2> shorter = {HUGE_VAL, HUGE_VAL};
    for (const std::size_t there : {a, b}) {
      const std::array<double, 2> to = {(places.column[there] - places.column[here]) / texels,
                                        (places.row[there] - places.row[here]) / texels};
      if (isPlace(to[0], to[1]) && std::hypot(to[0], to[1]) < std::hypot(shorter[0], shorter[1]))
        shorter = to;
    }
    return shorter;
  };
  const auto along = step(here + 1, here + 2, texels_x), across = step(here + 3, here + 4, texels_y);
  double longest = std::max(std::hypot(along[0], along[1]), std::hypot(across[0], across[1]));
  if (!std::isfinite(longest)) return {};
  if (!image_.hasTurn()) return longest;
  // Towards a pole pixels become ever narrower, but no less high.
  constexpr double kNarrowest = 1.0 / 16;
  const auto a = image_.coordinateStep(along[0], along[1]), b = image_.coordinateStep(across[0], across[1]);
  const double east = std::hypot(a[0], b[0]), north = std::hypot(a[1], b[1]);
  if (east * kNarrowest > north) longest *= north / (east * kNarrowest);
  return longest;
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
