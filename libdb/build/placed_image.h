// An image seen from a grid: where the grid's places lie in it, in pixels, and its colours there.
// Thread-safety: const members from any thread.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "libdb/build/color_field.h"
#include "libdb/source/color_image.h"

namespace deltaz {

// Positions in an image, pixels; NaN where a place has none.
struct PixelPlaces {
  std::vector<double> column, row;
};

class PlacedImage {
 public:
  // Both must outlive it. Errors as CoordinateChange::between.
  static Result<std::unique_ptr<PlacedImage>> make(const GridHeader& grid, const ColorImage& image,
                                                   bool allow_ballpark);

  const ColorImage& image() const { return image_; }
  // Whether the image may lie in the block; only a coarse answer where the image is bent there.
  bool touches(const TexelBlock& block) const;
  // The longest side of texels of `level` in the block, pixels, where the image is. Towards the poles of an
  // image in degrees no pixel counts as narrower than a 16th of its height.
  double pixelsPerTexel(const TexelBlock& block, int level) const;
  // The centres of the block's texels, row by row.
  Result<PixelPlaces> centres(const TexelBlock& block) const;

 private:
  PlacedImage(const GridHeader& grid, const ColorImage& image, ReferenceSystem system, bool allow_ballpark)
      : grid_(grid), image_(image), system_(std::move(system)), allow_ballpark_(allow_ballpark) {}
  Result<CoordinateChange> takeChange() const;
  void giveBack(CoordinateChange change) const;
  // Exactly, through PROJ. `posts`: columns and rows of level-0 posts, become pixels.
  Status toPixels(std::span<double> columns, std::span<double> rows) const;
  Status fill(const TexelBlock& block, int column, int row, int columns, int rows, PixelPlaces& places) const;
  std::optional<double> longestStep(const PixelPlaces& places, std::size_t here, double texels_x,
                                    double texels_y) const;

  const GridHeader& grid_;
  const ColorImage& image_;
  ReferenceSystem system_;  // of the grid
  bool allow_ballpark_;
  // PROJ's objects serve one thread at a time.
  mutable std::mutex mutex_;
  mutable std::vector<CoordinateChange> idle_;
};

}  // namespace deltaz
