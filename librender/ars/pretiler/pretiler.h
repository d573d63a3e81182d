// The pretiler (report 5.3): triangles in view space -> triangles on the machine's screen.
//
// A triangle wholly beyond the yon plane is dropped. One that reaches before the hither plane is cut there in
// three dimensions, linear in U, V, W and colour: 1/U of a point behind the eye is below zero, so what lies
// between must not be interpolated in it; a quadrangle that is left is two triangles from there on. What is
// left is projected, and its gradients are made, once, by vertex differences (7.2.2: normals of view space
// lose more digits), anchored at a vertex; that of 1/U from the larger of two triangles. Then it is cut
// right, top, left and bottom, and a polygon of n corners leaves as n - 2 triangles: ten at most.
//
// The screen is cut at its outer pixels' centres, so that what is rounded stays in nine bits; nothing that
// covers a pixel's centre is lost. A new corner is computed from the inside end of its edge towards the
// outside one, so two triangles get the same of the edge they share.
// Cost: a constant a triangle. Errors: none; points that are not finite are dropped with their triangle.
// Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "librender/ars/pretiler/screen_triangle.h"

namespace deltaz::ars {

// Where the eye looks through the screen, and how near and far it sees.
struct ScreenView {
  double centre_i = 0, centre_j = 0;  // of the view's axis, in this screen's lines and pixels
  int lines = 512, pixels = 512;
  double hither = 1;  // metres, above 0
  double yon = std::numeric_limits<double>::infinity();
};

// in = beyond_yon + before_hither + beside + edge_on + drawn.
struct PretilerCounts {
  std::uint64_t in = 0, beyond_yon = 0, before_hither = 0, beside = 0, edge_on = 0, drawn = 0;
  std::uint64_t cut_by_hither = 0, cut_by_screen = 0;  // of those drawn
  std::uint64_t out = 0;                               // triangles that leave

  PretilerCounts& operator+=(const PretilerCounts& other);
  bool operator==(const PretilerCounts&) const = default;
};

class Pretiler {
 public:
  explicit Pretiler(const ScreenView& view) : view_(view) {}

  // Appends what is left of the triangle. Back faces are the caller's business: both sides are drawn.
  void process(const ViewTriangle& triangle, std::vector<ScreenTriangle>& out, PretilerCounts& counts) const;

 private:
  ScreenView view_;
};

}  // namespace deltaz::ars
