// The pretiler (report 5.3): view-space faces -> triangles on the screen, binned by tile.
//
// Vertices are projected and snapped many at a time and faces tested many at a time (vertex_projection.h,
// grid_culler.h): beside the picture, turned away, between the samples. What is left is copied into the bins
// of the tiles it touches. The few faces that reach before the hither plane or beyond the guard band are
// clipped, in three dimensions, linear in U, V, W (clipper.h). Gradients are computed for faces that are
// seen, once per face, by vertex differences in double from the unsnapped vertices (FacePlanes).
//
// Watertight: a position is snapped the same way wherever it comes from, and a clipped point is the same for
// the two faces of its edge. Thread-safety: const members from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "librender/objects/grid_faces.h"
#include "librender/objects/model_object_processor.h"
#include "librender/objects/terrain_object_processor.h"
#include "librender/raster/tile_bins.h"
#include "librender/raster/vertex_projection.h"
#include "librender/scene/camera.h"
#include "librender/scene/render.h"

namespace deltaz {

// Unsnapped position on the screen.
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

// What all pixels of a face share. An attribute c of the vertices is (c0 weight0 + c1 weight1 + c2 weight2)
// with barycentric weights; those divided by U are linear on the screen, as 1/U is.
struct FacePlanes {
  double anchor_j = 0, anchor_i = 0;  // a projected vertex
  ScreenPlane inverse_u;
  ScreenPlane weight1, weight2;  // of the face's second and third vertex, times 1/U
  // Corners of what lies in front of the hither plane, in order, from the anchor, which is the first of them.
  std::array<double, 4> corner_j{}, corner_i{};
  std::uint32_t corners = 0;
  double least = 0, greatest = 0;  // 1/U over the vertices of what is in front of the hither plane
  std::array<std::array<float, 3>, 3> color{};     // of each vertex: red, green, blue, linear, lit
  std::array<float, 3> intensity{};                // of each vertex
  GridCoordinates texture;                         // of the first vertex; see texture_planes.h
  std::array<GridCoordinates, 2> texture_steps{};  // from there to the second and third
  std::uint64_t identity = 0;                      // as Picture::triangle
  Surface surface = Surface::kTerrain;

  // 1/U at a sample. Within the vertices' range, so that slivers, whose samples may lie just outside the
  // unsnapped triangle, cannot extrapolate.
  double inverseDepthAt(double j, double i) const {
    const double d = inverse_u.at(j - anchor_j, i - anchor_i);
    return d < least ? least : d > greatest ? greatest : d;
  }
};

// Set in the number of a face of a node's own grid; the rest is the cell << 1, | 1 for the top face. Other
// faces are numbered by their place in PretiledNode::faces.
inline constexpr std::uint32_t kGridFace = std::uint32_t{1} << 31;

// The front faces of one terrain node, or of one part of a model, with their vertices.
struct PretiledNode {
  Surface surface = Surface::kTerrain;
  std::uint16_t grid = 0;                // whose colours its faces show
  std::uint32_t identity = 0;            // number of the node's record, or of the instance
  TerrainVertices vertices;              // of a terrain node
  std::vector<std::uint8_t> grid_faces;  // of the vertices' grid, as of GridFaces::cells
  std::vector<TerrainFace> faces;        // all others
  ModelFaces model;  // of a part of a model; its faces, with no colours, stand in `faces` as well
  std::uint64_t clipped = 0, no_sample = 0;  // faces that left nothing: outside the picture, between samples

  static PretiledNode ofTerrain(std::uint16_t grid, std::uint32_t record, TerrainVertices vertices,
                                std::vector<TerrainFace> front);
  static PretiledNode ofTerrain(std::uint16_t grid, std::uint32_t record, TerrainVertices vertices,
                                GridFaces faces);
  static PretiledNode ofModel(std::uint32_t instance, ModelFaces model);
  const std::vector<Vector3>& positions() const {
    return surface == Surface::kModel ? model.position : vertices.position;
  }
  // By its number, kGridFace or not.
  TerrainFace face(std::uint32_t number) const;
};

// Pre: some of the face lies in front of the hither plane.
FacePlanes facePlanes(const ViewTransform& view, const PretiledNode& node, std::uint32_t face);

class Pretiler {
 public:
  // Samples lie no farther from the pixels' centres than `reach`, 1/256 pixel.
  explicit Pretiler(const ViewTransform& view, std::int32_t reach = 0) : view_(view), reach_(reach) {}

  // Adds the node's faces to the bins as RasterTriangle::node `number`, in their order, and counts those that
  // leave nothing.
  void process(PretiledNode& node, std::uint32_t number, TileBins::Writer& bins) const;

 private:
  // The faces of the node's grid, and all others.
  void processGrid(PretiledNode& node, std::uint32_t number, const ProjectedVertices& vertices,
                   TileBins::Writer& bins) const;
  void processList(PretiledNode& node, std::uint32_t number, const ProjectedVertices& vertices,
                   TileBins::Writer& bins) const;
  // The careful way for one face; counted if nothing is left of it.
  void processClipped(PretiledNode& node, std::uint32_t number, std::uint32_t face,
                      TileBins::Writer& bins) const;

  ViewTransform view_;
  std::int32_t reach_;
};

}  // namespace deltaz
