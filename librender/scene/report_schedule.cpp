#include "librender/scene/report_schedule.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "librender/scene/render.h"

namespace deltaz {
namespace {

// Of the rows of posts, in kReportSpacing. On a projected grid in metres, 1852 of which are a minute of arc.
double spacingShare(const GridGeometry& geometry) {
  const double spacing = std::abs(geometry.yCoordinate(1) - geometry.yCoordinate(0));
  const double arc_seconds = geometry.isGeodetic() ? spacing * 3600 : spacing / (1852.0 / 60);
  return arc_seconds / kReportSpacing;
}

}  // namespace

ReportRanges::ReportRanges(const ReportLod& lod, const ViewTransform& view, const GridGeometry& geometry)
    : overlap_(lod.overlap) {
  const double report_pixels =
      kReportWidth / 2.0 / std::tan(kReportFieldOfView / 2 * (std::numbers::pi / 180));
  double range = lod.first_range * (view.pixels / report_pixels) * spacingShare(geometry);
  for (double& largest : largest_) {
    largest = range;
    range /= std::sqrt(1 - lod.face_reduction);
  }
  largest_.back() = std::numeric_limits<double>::infinity();
}

ReportLevels ReportRanges::at(double range) const {
  int level = 1;
  while (level < kReportLevels && !(range <= largest(level))) ++level;
  const bool twice = level < kReportLevels && range > largest(level) * (1 - overlap_);
  return {level, level + static_cast<int>(twice)};
}

FrameStatistics::Objects& FrameStatistics::Objects::operator+=(const Objects& other) {
  out_of_view += other.out_of_view;
  drawn += other.drawn;
  drawn_twice += other.drawn_twice;
  for (std::size_t level = 0; level < faces.size(); ++level) faces[level] += other.faces[level];
  faces_twice += other.faces_twice;
  return *this;
}

}  // namespace deltaz
