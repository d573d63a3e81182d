// Level of detail by range, as the report has it (6.5): the historical alternative to the errors of
// scheduler.h.
//
// Terrain objects of 9 x 9 posts are drawn at one of five levels, each with every other post of one axis left
// out against the one before: 81, 45, 25, 15, 9 posts; 128, 64, 32, 16, 8 faces. The range from the eye to an
// object's centroid chooses (Table 18, corrected): a field of view theta shows a square of side 2 t =
// 2 R tan(theta / 2) at range R, its area is A = 4 t^2, and a level with the share PR of its faces left out
// serves an area 1 / (1 - PR) as large, so
//   A_i = A_(i-1) / (1 - PR),  R_i = sqrt(A_i) / (2 tan(theta / 2)) = R_1 (1 - PR)^(-(i - 1) / 2).
// R_1 = 10,120 m and PR = 0.495 fit Table 29's 10,000, 14,900, 19,240, 28,480 m best; a picture of 512 pixels
// and 32 degrees shows 3" posts 8 pixels apart at each of them.
//
// For other pictures and posts that distance on the screen is what is kept (6.5.5 asks for it): R_1 grows
// with the pixels to a unit of tangent, which keeps t in pixels, and with the spacing of the rows of posts.
// Beyond R_4 the coarsest level stays; the report's outer limit of 50 km is not taken over, so nothing
// vanishes.
//
// Objects in the outermost `overlap` of a level's range are drawn at that level and the next ("double
// processing"); nothing else is done about the cracks between levels, and no error is bounded.
//
// Thread-safety: plain values.
#pragma once

#include <array>
#include <cstddef>

#include "libdb/access/grid_geometry.h"
#include "librender/scene/camera.h"

namespace deltaz {

inline constexpr int kReportLevels = 5;

// The picture and the posts the report's ranges are for.
inline constexpr double kReportFieldOfView = 32;  // degrees, horizontal
inline constexpr int kReportWidth = 512;          // pixels
inline constexpr double kReportSpacing = 3;       // arc-seconds of latitude

struct ReportLod {
  double first_range = 10120;     // R_1, metres, for the picture and the posts above
  double face_reduction = 0.495;  // PR
  // Share of R_i in which both levels are drawn: with ground all round out to 50 km, 11.1 % of the faces are
  // then drawn in addition, as in Table 29.
  double overlap = 0.117;
};

// The levels an object is drawn at, 1 .. kReportLevels: one, or two that follow each other.
struct ReportLevels {
  int finest = 1, coarsest = 1;
  bool isTwice() const { return finest != coarsest; }
  bool operator==(const ReportLevels&) const = default;
};

// The ranges of one view of one grid.
class ReportRanges {
 public:
  ReportRanges(const ReportLod& lod, const ViewTransform& view, const GridGeometry& geometry);

  // R_level, metres: the largest range of a level, infinity for the last.
  double largest(int level) const { return largest_[static_cast<std::size_t>(level - 1)]; }
  ReportLevels at(double range) const;

 private:
  std::array<double, kReportLevels> largest_{};
  double overlap_;
};

}  // namespace deltaz
