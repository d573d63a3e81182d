// Draws meshes that lie in memory, without a database: the rasteriser by itself, for programs that have
// triangles of their own, for benchmarks against other renderers and for tests.
//
// Every triangle that is front-facing (counter-clockwise seen from its front) is drawn, Gouraud-shaded in
// perspective with the colours of its vertices. Work is threaded from the vertices to the pixels; the picture
// does not depend on the number of threads or the vector width. Runs in the caller's TBB arena. Memory is
// kept from frame to frame. Thread-safety: one draw at a time per MeshRenderer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "librender/raster/crossing_fates.h"
#include "librender/raster/gouraud_shader.h"
#include "librender/raster/tile_bins.h"
#include "librender/scene/camera.h"

namespace deltaz {

// Vertices as structure of arrays, each with kRowPadding readable entries behind the last; metres, RGBA a
// byte each, red lowest.
struct MeshVertices {
  std::vector<float> x, y, z;
  std::vector<std::uint32_t> rgba;

  // Number of vertices; `pad` must have been called.
  std::size_t size() const;
  void append(float vertex_x, float vertex_y, float vertex_z, std::uint32_t color);
  void pad();
};

// columns x rows vertices row by row; cells are split along the diagonal from their first vertex (SW) to the
// opposite one (NE). Front is where the rows run to the left of the columns' direction.
struct GridMesh {
  int columns = 0, rows = 0;
  MeshVertices vertices;
};

// Triangles by vertex numbers, cut into groups that use few vertices (meshlets), once.
class IndexedMesh {
 public:
  IndexedMesh() = default;
  IndexedMesh(const MeshVertices& vertices, std::span<const std::array<std::uint32_t, 3>> triangles);

  struct Meshlet {
    std::uint32_t first_vertex = 0, vertices = 0, first_triangle = 0, triangles = 0;
  };
  const std::vector<Meshlet>& meshlets() const { return meshlets_; }
  const MeshVertices& vertices() const { return vertices_; }
  // Vertex numbers within the meshlet, of each triangle's first, second or third corner.
  const std::vector<std::uint8_t>& corners(std::size_t k) const { return corners_[k]; }

 private:
  std::vector<Meshlet> meshlets_;
  MeshVertices vertices_;
  std::array<std::vector<std::uint8_t>, 3> corners_;  // with kRowPadding entries behind the last
};

struct MeshCounts {
  // in = outside + back_facing + no_sample + drawn; hidden ones are among the drawn, they lay behind others
  // before any of their samples was looked at.
  std::uint64_t in = 0, outside = 0, back_facing = 0, no_sample = 0, drawn = 0, hidden = 0;
  std::uint64_t samples_tested = 0, samples_written = 0;
};

class MeshRenderer {
 public:
  MeshRenderer();
  ~MeshRenderer();
  MeshRenderer(const MeshRenderer&) = delete;
  MeshRenderer& operator=(const MeshRenderer&) = delete;

  // Fills `frame`, which has the view's size.
  MeshCounts draw(const ViewTransform& view, std::span<const GridMesh> grids,
                  std::span<const IndexedMesh> meshes, ColorFrame& frame);

 private:
  struct Worker;
  TileBins bins_;
  std::vector<std::unique_ptr<Worker>> workers_;
  CrossingFates crossing_;
};

}  // namespace deltaz
