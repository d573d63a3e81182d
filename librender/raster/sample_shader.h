// The colour of samples: what is seen of a face, of the sea or of the sky at places of the picture, many at
// once, in linear light and with haze in it.
//
// Faces show their vertices' colours weighted in perspective, terrain that of the colour map where it has
// cover: trilinear (texture_sampler.h says it in scalar code), in single precision within kShadingError of
// it. Depth is the plane of 1/U in double. The sea is put in where it is nearer than the face, the sky where
// there is nothing. The bits are the same on every vector width. Thread-safety: one shader a thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "librender/raster/face_lanes.h"
#include "librender/scene/environment.h"
#include "librender/scene/texture_store.h"

namespace deltaz {

// Of a component, 1 = white, against the same in double: a hundredth of a code where codes lie closest.
inline constexpr double kShadingError = 4e-6;

struct SampleBatch {
  static constexpr std::size_t kMost = 64;
  template <typename T>
  using List = T[kMost + kVectorPadding];

  // What to shade: places in pixels, and the face that is nearest there, nullptr for none.
  std::size_t count = 0;
  alignas(64) List<double> j, i;
  List<const FaceLanes*> face;

  // Set: where it is seen, +infinity for the sky; what it is; its colour. `face` becomes nullptr where the
  // sea is nearer.
  alignas(64) List<double> u;
  alignas(64) List<double> red, green, blue;
  List<Surface> surface;
};

// A square of texels that was asked for last, in texels of its level.
struct LastSquare {
  bool known = false;
  int level = 0;
  double west = 0, south = 0;
  const TextureTile* tile = nullptr;
};

// How a grid is mapped.
struct GridMapping {
  bool textured = false;
  std::uint16_t grid = 0;
  int finest = 0, coarsest = 0;
  double texels_per_post = 0;      // of level 0
  double footprint = 1;            // what a sample stands for, pixels of the view
  std::array<LastSquare, 2> last;  // of an even and of an odd level
};

class SampleShader {
 public:
  // Both must live as long. Tiles of the colour map are read when they are needed; what goes wrong is in
  // TextureStore::status. Of the colour map a sample shows a square of `footprint` pixels of the view.
  SampleShader(const Environment& environment, TextureStore& textures, double footprint = 1);

  void shade(SampleBatch& batch);

 private:
  const Environment& environment_;
  TextureStore& textures_;
  std::vector<GridMapping> mappings_;  // by grid
};

}  // namespace deltaz
