#include "libdb/build/image_field.h"

#include <algorithm>
#include <cmath>

namespace deltaz {

namespace {

// Texels that are larger than pixels by less than this count as no larger: a pixel of 30 m is none of an
// arc-second, yet people mean the same by them.
constexpr double kFinerBy = 1.05;
// Pixels read at once at most, unless a single texel needs more.
constexpr std::int64_t kMostPixels = 1 << 20;
// Positions so close to the edge of a pixel, or of the image, are on it: rounding decides nothing.
constexpr double kOnEdge = 1e-6;
constexpr double kFullCover = 1 - 1e-12;

// The pixels a position takes its colour from along one axis.
struct Taps {
  std::int64_t first = 0, second = 0;
  double share = 0;  // of the second
};

Taps bilinearTaps(double position, int count, bool round) {
  const double centre = position - 0.5;
  const double first = std::floor(centre);
  Taps taps{static_cast<std::int64_t>(first), static_cast<std::int64_t>(first) + 1, centre - first};
  if (round) {
    taps.first = (taps.first % count + count) % count;
    taps.second = (taps.second % count + count) % count;
  } else {
    taps.first = std::clamp<std::int64_t>(taps.first, 0, count - 1);
    taps.second = std::clamp<std::int64_t>(taps.second, 0, count - 1);
  }
  return taps;
}

Taps nearestTaps(double position, int count) {
  const auto pixel =
      std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(position + kOnEdge)), 0, count - 1);
  return {pixel, pixel, 0};
}

struct PixelTaps {
  std::size_t texel = 0;
  Taps x, y;
};

void add(CoveredColor& sum, const CoveredColor& color, double weight) {
  sum.red += weight * color.red;
  sum.green += weight * color.green;
  sum.blue += weight * color.blue;
  sum.cover += weight * color.cover;
}

}  // namespace

Result<std::unique_ptr<ImageField>> ImageField::make(const GridHeader& grid,
                                                     std::span<const ColorImage> images,
                                                     bool allow_ballpark) {
  std::unique_ptr<ImageField> field(new ImageField());
  for (const ColorImage& image : images) {
    DELTAZ_TRY_ASSIGN(std::unique_ptr<PlacedImage> placed, PlacedImage::make(grid, image, allow_ballpark));
    field->images_.push_back(std::move(placed));
  }
  return field;
}

bool ImageField::touches(const TexelBlock& block) const {
  return std::any_of(images_.begin(), images_.end(),
                     [&](const auto& placed) { return placed->touches(block); });
}

bool ImageField::isFiner(const TexelBlock& block, int level) const {
  return std::any_of(images_.begin(), images_.end(), [&](const auto& placed) {
    return placed->touches(block) && placed->pixelsPerTexel(block, level) > kFinerBy;
  });
}

Status ImageField::sample(const TexelBlock& block, std::span<CoveredColor> colors) const {
  std::fill(colors.begin(), colors.end(), CoveredColor{});
  for (const auto& placed : images_) {
    if (std::all_of(colors.begin(), colors.end(),
                    [](const CoveredColor& color) { return color.cover >= kFullCover; }))
      break;
    if (images_.size() > 1 && !placed->touches(block)) continue;
    DELTAZ_TRY(lay(*placed, block, colors));
  }
  return Success{};
}

// Puts an image under what is there already.
Status ImageField::lay(const PlacedImage& placed, const TexelBlock& block,
                       std::span<CoveredColor> colors) const {
  const ColorImage& image = placed.image();
  DELTAZ_TRY_ASSIGN(const PixelPlaces places, placed.centres(block));
  const bool round = image.closesRound();
  std::vector<PixelTaps> taps;
  std::int64_t first_column = image.columns(), last_column = -1, first_row = image.rows(), last_row = -1;
  for (std::size_t k = 0; k < colors.size(); ++k) {
    double x = places.column[k];
    const double y = places.row[k];
    if (!std::isfinite(x) || !std::isfinite(y) || colors[k].cover >= kFullCover) continue;
    if (round) x -= image.columns() * std::floor(x / image.columns());
    if (x < -kOnEdge || y < -kOnEdge || x > image.columns() + kOnEdge || y > image.rows() + kOnEdge) continue;
    PixelTaps tap{k, {}, {}};
    tap.x = image.isOfClasses() ? nearestTaps(x, image.columns()) : bilinearTaps(x, image.columns(), round);
    tap.y = image.isOfClasses() ? nearestTaps(y, image.rows()) : bilinearTaps(y, image.rows(), false);
    first_column = std::min({first_column, tap.x.first, tap.x.second});
    last_column = std::max({last_column, tap.x.first, tap.x.second});
    first_row = std::min({first_row, tap.y.first, tap.y.second});
    last_row = std::max({last_row, tap.y.first, tap.y.second});
    taps.push_back(tap);
  }
  if (taps.empty()) return Success{};
  const std::int64_t width = last_column - first_column + 1, height = last_row - first_row + 1;
  if (width * height > kMostPixels && block.columns * block.rows > 1) {
    // Split along the longer side; each half lies closer together in the image.
    const bool across = block.columns >= block.rows;
    TexelBlock low = block, high = block;
    (across ? low.columns : low.rows) /= 2;
    (across ? high.columns : high.rows) -= across ? low.columns : low.rows;
    (across ? high.first_column : high.first_row) += across ? low.columns : low.rows;
    for (const TexelBlock& half : {low, high}) {
      const auto offset = [&](int row) {
        return static_cast<std::ptrdiff_t>((half.first_row - block.first_row + row) * block.columns +
                                           (half.first_column - block.first_column));
      };
      std::vector<CoveredColor> part;
      for (int row = 0; row < half.rows; ++row)
        part.insert(part.end(), colors.begin() + offset(row), colors.begin() + offset(row) + half.columns);
      DELTAZ_TRY(lay(placed, half, part));
      for (int row = 0; row < half.rows; ++row)
        std::copy_n(part.begin() + std::ptrdiff_t{row} * half.columns, half.columns,
                    colors.begin() + offset(row));
    }
    return Success{};
  }
  std::vector<CoveredColor> pixels(static_cast<std::size_t>(width * height));
  DELTAZ_TRY(image.read({static_cast<int>(first_column), static_cast<int>(first_row), static_cast<int>(width),
                         static_cast<int>(height)},
                        pixels));
  const auto pixel = [&](std::int64_t column, std::int64_t row) -> const CoveredColor& {
    return pixels[static_cast<std::size_t>((row - first_row) * width + (column - first_column))];
  };
  for (const PixelTaps& tap : taps) {
    CoveredColor color;
    const double u = tap.x.share, v = tap.y.share;
    add(color, pixel(tap.x.first, tap.y.first), (1 - u) * (1 - v));
    add(color, pixel(tap.x.second, tap.y.first), u * (1 - v));
    add(color, pixel(tap.x.first, tap.y.second), (1 - u) * v);
    add(color, pixel(tap.x.second, tap.y.second), u * v);
    add(colors[tap.texel], color, 1 - colors[tap.texel].cover);
  }
  return Success{};
}

}  // namespace deltaz
