#include "libdb/source/full_turn.h"

#include <algorithm>
#include <cmath>

#include "libdb/access/grid_geometry.h"

namespace deltaz {

namespace {

// A turn may differ from a whole number of columns by this many: spacings are written as decimals.
constexpr double kWholeTurn = 1e-6;

template <typename T>
void repeatFirstColumn(std::vector<T>& posts, std::int64_t columns, std::int64_t rows) {
  if (posts.empty()) return;
  posts.resize(static_cast<std::size_t>((columns + 1) * rows));
  // In place, from the last row on.
  for (std::int64_t row = rows; row-- > 0;) {
    const auto from = posts.begin() + row * columns;
    const auto to = posts.begin() + row * (columns + 1);
    const T first = *from;
    if (row > 0) std::copy_backward(from, from + columns, to + columns);
    *(to + columns) = first;
  }
}

}  // namespace

std::int64_t columnsInTurn(const GridHeader& header) {
  if (header.kind != "geodetic") return 0;
  const double columns = 360 / header.x_axis.spacing;
  return std::abs(columns - std::round(columns)) < kWholeTurn ? std::llround(columns) : 0;
}

std::int64_t fullTurn(const GridHeader& header) {
  const std::int64_t turn = columnsInTurn(header);
  return header.x_axis.count >= turn ? turn : 0;
}

void closeTurn(RawGrid& grid) {
  GridHeader& header = grid.header;
  const std::int64_t turn = fullTurn(header), columns = header.x_axis.count, rows = header.y_axis.count;
  if (turn == 0 || columns != turn) return;
  repeatFirstColumn(grid.heights, columns, rows);
  repeatFirstColumn(grid.valid, columns, rows);
  repeatFirstColumn(grid.void_kinds, columns, rows);
  ++header.x_axis.count;
}

bool hasRepeatedColumn(const GridHeader& header) {
  const std::int64_t turn = fullTurn(header);
  if (turn == 0 || header.x_axis.count != turn + 1 || header.resampling || header.sources.empty())
    return false;
  const double west = postCoordinate(header.x_axis, kLongitudeOrigin, header.x_axis.first);
  return std::none_of(header.sources.begin(), header.sources.end(), [&](const SourceDescription& source) {
    const double own_west = source.geotransform[0] + 0.5 * source.geotransform[1];
    std::int64_t first = std::llround((own_west - west) / header.x_axis.spacing) % turn;
    if (first < 0) first += turn;
    return first + source.columns - 1 >= turn;
  });
}

}  // namespace deltaz
