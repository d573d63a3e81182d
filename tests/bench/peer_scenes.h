// The scenes of the neutral benchmark of CPU renderers, triangle for triangle, so that figures of other
// renderers on them can be set beside ours: A, a fractal terrain of 1025 x 1025 posts and 2.1 million
// triangles seen from 300 m above it; B, the 24,600 triangles of the 1983 report's Table 25 (terrain in a
// wedge and twelve models); C-small-8 and C-large-8, random triangles of 10 and 1000 pixels that cover every
// pixel eight times. Integer hashes and unfused double arithmetic: the same everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "librender/raster/mesh_renderer.h"
#include "librender/scene/camera.h"

namespace deltaz::bench {

struct PeerScene {
  std::string name;
  int width = 0, height = 0;
  // All vertices and triangles (counter-clockwise seen from the front), as other renderers take them.
  MeshVertices vertices;
  std::vector<float> texture_u, texture_v;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // The first grid_columns * grid_rows vertices and the first 2 triangles a cell are a grid; 0 if there is
  // none.
  int grid_columns = 0, grid_rows = 0;
  // The camera in the scene's metres: x east, y north, z up.
  std::array<double, 3> eye{}, right{}, up{}, forward{};
  double field_of_view = 32;  // horizontal, degrees
  double near = 1, far = 1000;

  ViewTransform view() const;
  // Column by column, for clip coordinates with z in [-w, w].
  std::array<float, 16> clipMatrix() const;
  // The same triangles as the rasteriser takes them.
  std::vector<GridMesh> grids() const;
  std::vector<IndexedMesh> meshes() const;
};

inline constexpr std::uint32_t kPeerBackground = 0xFFD99973;

// The benchmark's texture: value noise, a square of this side, RGBA.
inline constexpr int kPeerTextureSide = 1024;
std::vector<std::uint32_t> peerTexture();

// `name`: A, B, C-small-8, C-large-8, or C-small-X, C-large-X for depth complexity X.
PeerScene makePeerScene(std::string_view name, int width, int height);

}  // namespace deltaz::bench
