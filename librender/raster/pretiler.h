// The pretiler (report 5.3): view-space faces -> triangles on the screen, ready to be tiled.
//
// In order: outcode rejection against the picture; hither clip in three dimensions, linear in U, V, W and
// attributes; projection; guard-band clip; snap to 1/256 pixel; rejection of what covers no sample;
// gradients, once per face, by vertex differences in double from the unsnapped vertices.
//
// Watertight: a clipped point is always computed from the inside end of its edge towards the outside end, so
// that the two faces of an edge get the same point; a position is snapped the same way wherever it comes
// from. Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "librender/objects/model_object_processor.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/raster/coverage.h"
#include "librender/scene/camera.h"
#include "librender/scene/render.h"

namespace deltaz {

// Unsnapped position on the screen: what triangle set-up is given.
struct ScreenVertex {
  double j = 0, i = 0, inverse_u = 0;
};

// Pre: p.x > 0.
inline ScreenVertex project(const ViewTransform& view, const Vector3& p) {
  const double inverse_u = 1 / p.x;
  return {view.centre_j + p.y * inverse_u, view.centre_i + p.z * inverse_u, inverse_u};
}

// The Earth-centred point that `project` put there.
inline Vector3 unproject(const ViewTransform& view, const ScreenVertex& vertex) {
  return view.eye + view.ray(vertex.j, vertex.i) * (1 / vertex.inverse_u);
}

// A value linear on the screen.
struct ScreenPlane {
  double value = 0, per_j = 0, per_i = 0;  // at the anchor, and its gradient
  double at(double dj, double di) const { return value + (per_j * dj + per_i * di); }
};

// What all pieces of a face share. An attribute c of the vertices is (c0 weight0 + c1 weight1 + c2 weight2)
// with barycentric weights; those divided by U are linear on the screen, as 1/U is.
struct FacePlanes {
  double anchor_j = 0, anchor_i = 0;  // a projected vertex
  ScreenPlane inverse_u;
  ScreenPlane weight1, weight2;    // of the face's second and third vertex, times 1/U
  double least = 0, greatest = 0;  // 1/U over the vertices of what is in front of the hither plane
  std::array<std::array<float, 3>, 3> color{};     // of each vertex: red, green, blue, linear, lit
  std::array<float, 3> intensity{};                // of each vertex
  GridCoordinates texture;                         // of the first vertex; see texture_planes.h
  std::array<GridCoordinates, 2> texture_steps{};  // from there to the second and third
  std::uint64_t identity = 0;                      // as Picture::triangle
  Surface surface = Surface::kTerrain;

  // 1/U at a sample. Within the vertices' range, so that slivers, whose samples may lie just outside the
  // unsnapped triangle, cannot extrapolate.
  double inverseDepthAt(int j, int i) const {
    const double d = inverse_u.at(j - anchor_j, i - anchor_i);
    return d < least ? least : d > greatest ? greatest : d;
  }
};

// What comes of one terrain node, or of one part of a model.
struct PretiledNode {
  std::uint16_t grid = 0;  // whose colours its faces show
  std::vector<FacePlanes> faces;
  std::vector<SnappedTriangle> triangles;
  std::uint64_t clipped = 0, no_sample = 0;  // faces that left nothing: outside the picture, between samples
};

class Pretiler {
 public:
  explicit Pretiler(const ViewTransform& view);

  // Appends the node's front faces to `out` in their order, and leaves out.grid as it is. `record` is the
  // node's record number.
  void process(const TerrainVertices& vertices, const TerrainFaces& faces, std::uint32_t record,
               PretiledNode& out) const;
  // The same for the front faces of a part of the model that stands as `instance`.
  void process(const ModelFaces& faces, std::uint32_t instance, PretiledNode& out) const;

 private:
  // `set_attributes(face, planes)` gives a face's planes all that does not depend on where it is.
  template <typename Face, typename SetAttributes>
  void processFaces(const std::vector<Vector3>& position, const std::vector<Face>& faces,
                    const SetAttributes& set_attributes, PretiledNode& out) const;
  void clipAndEmit(const std::array<Vector3, 3>& corners_of_face, FacePlanes planes, PretiledNode& out) const;

  ViewTransform view_;
};

}  // namespace deltaz
