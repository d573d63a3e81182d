// What the samples of a pixel show, gathered: a fragment for each face, and for sea and sky.
//
// Thread-safety: a gatherer belongs to one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "librender/antialias/sample_grid.h"
#include "librender/raster/face_lanes.h"
#include "librender/raster/tiler.h"
#include "librender/scene/environment.h"
#include "librender/scene/sea_cover.h"

namespace deltaz {

struct Fragment {
  std::int32_t column = 0;          // of its pixel, in the row that was asked for
  std::uint32_t count = 0;          // samples
  std::uint64_t samples = 0;        // which: bit s for sample s
  const FaceLanes* face = nullptr;  // nullptr: the sea or the sky
  double j = 0, i = 0;              // their mean place on the sample grid
};

class FragmentGatherer {
 public:
  // The environment is that of the sample grid, and must live as long.
  FragmentGatherer(const Environment& environment, const Sampling& sampling);

  // Goes to a tile; `faces` are those of tile.faces(). All must live until the next one.
  void enter(const SettledTile& tile, std::span<const FaceLanes> faces, int tile_j, int tile_i);
  // Appends the fragments of the tile's row `row` of pixels, `columns` of them from its first, pixel by
  // pixel, in the order of their first samples. Returns how many samples show a face, in front of the sea or
  // not.
  std::uint64_t gatherRow(int row, int columns, std::vector<Fragment>& fragments);

 private:
  using Owner = std::uint32_t;  // a face of the tile, or one of
  static constexpr Owner kSky = kNoTriangle, kSea = kNoTriangle - 1;
  static constexpr int kMost = 64;

  // Whether and how the sea may come before faces in a row of pixels of the tile.
  void enterRow(int first_i);
  // Puts the sea before what lies behind it, sample by sample.
  void meetSea(int first_j, int first_i);
  bool isBeforeSea(const FaceLanes& face, double j, double i) const;
  void append(int column, int first_j, int first_i, std::vector<Fragment>& fragments) const;

  const Environment& environment_;
  SampleGrid grid_;
  int across_;  // samples of a pixel
  std::size_t count_;
  std::uint64_t all_;
  std::vector<SamplePlace> places_;
  std::array<std::uint16_t, kMost> index_{};  // of a sample in TileBuffer's order, from its pixel's first
  std::array<double, kMost + 1> to_grid_{};   // from a sum of so many places to their mean on the grid
  const SettledTile* tile_ = nullptr;
  std::span<const FaceLanes> faces_;
  int first_j_ = 0, first_i_ = 0;                                       // of the tile on the sample grid
  SeaCover sea_of_tile_ = SeaCover::kPartly, sea_ = SeaCover::kPartly;  // sea_: of the row
  SeaBound bound_;                                                      // where the sea is everywhere
  bool faces_are_nearer_ = false;     // all of the tile, than the sea anywhere in it
  std::array<Owner, kMost> owner_{};  // of the pixel's samples
};

}  // namespace deltaz
