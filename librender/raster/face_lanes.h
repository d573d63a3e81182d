// What all samples of a face share (FacePlanes), laid out so that a sample takes its five planes in one go.
//
// Lanes of `value`, `per_j` and `per_i`: columns and rows from the first vertex' on times 1/U
// (texture_planes.h), 1/U, the weights of the second and third vertex times 1/U; the others are 0.
// Thread-safety: plain values and pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "librender/raster/pretiler.h"

namespace deltaz {

enum FaceLane : std::uint8_t { kColumn, kRow, kInverseU, kSecondWeight, kThirdWeight };
inline constexpr std::size_t kFaceLanes = 8;

struct alignas(64) FaceLanes {
  double value[kFaceLanes], per_j[kFaceLanes], per_i[kFaceLanes];  // at the anchor, and gradients
  float color[3][4];  // of each vertex: red, green, blue, linear and lit, and intensity
  double anchor_j, anchor_i;
  double corner_j[4], corner_i[4];  // as FacePlanes
  std::uint32_t corners;
  double least, greatest;                                        // of 1/U
  double column, row;                                            // of the first vertex
  float least_column, greatest_column, least_row, greatest_row;  // of the face, from the first vertex' on
  std::uint64_t identity;                                        // as Picture::triangle
  std::uint16_t grid;                                            // whose colours it shows
  Surface surface;
};

// Names a face of the nodes that are drawn.
struct SeenFace {
  std::uint32_t node = 0, face = 0;
};

// Moves a place beside the face, counted from the anchor, to the nearest one that belongs to it. Samples lie
// beside a face by what its vertices were snapped, and on a face that is seen edge-on that little may be any
// depth.
void moveInside(const FaceLanes& face, double& dj, double& di);

FaceLanes faceLanes(const FacePlanes& planes, std::uint16_t grid);

// Of each face; `lanes` is replaced.
void makeFaceLanes(const ViewTransform& view, std::span<const PretiledNode> nodes,
                   std::span<const SeenFace> faces, std::vector<FaceLanes>& lanes);

}  // namespace deltaz
