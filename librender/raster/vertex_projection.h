// View space -> screen for many vertices at once: unsnapped positions for set-up, snapped ones for the tests
// before it.
//
// A vertex before the hither plane has kBeforeHitherCoordinate for both snapped coordinates; one outside the
// guard band is cut off at it (grid_culler.h). Same bits on every vector width. Thread-safety: pure
// functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "libdb/access/vector3.h"
#include "librender/raster/raster_triangle.h"
#include "librender/scene/camera.h"

namespace deltaz {

// Where projected vertices go; room for `count` rounded up to 16 in each.
struct ProjectedVertices {
  RasterVertex* vertex;
  std::int32_t *snapped_x, *snapped_y;
};
// The same, for vertices few of which are used.
struct ProjectedArrays {
  float *x, *y, *inverse_u;
  std::int32_t *snapped_x, *snapped_y;
};

// Vertices of a mesh in single precision, rotated and scaled about the eye; reads up to 15 behind the last.
struct MeshProjection {
  float eye[3];
  float forward[3], right[3], down[3];  // right and down times the pixels of a unit of tangent
  int width, height;
  float hither;

  explicit MeshProjection(const ViewTransform& view);
  void project(const float* x, const float* y, const float* z, const std::uint32_t* payload,
               std::size_t count, const ProjectedVertices& out) const;
  void project(const float* x, const float* y, const float* z, std::size_t count,
               const ProjectedArrays& out) const;
};

// (U, V, W) in double, as the object processors make them (camera.h). The payload is the vertex' index.
void projectViewPositions(std::span<const Vector3> positions, int width, int height,
                          const ProjectedVertices& out);

}  // namespace deltaz
