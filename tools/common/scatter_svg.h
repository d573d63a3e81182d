// Scatter diagrams as SVG: logarithmic axes, points in groups, a line through those of a front with their
// labels. Text that needs nothing but a viewer; the same input gives the same bytes. Thread-safety: pure
// function.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace deltaz {

struct ScatterPoint {
  double x = 0, y = 0;    // x > 0; y >= 0, and 0 stands below the axis's least value, where the axis says 0
  std::size_t group = 0;  // index into ScatterPanel::groups
  std::string label;      // shown if the point is on the front
};

struct ScatterPanel {
  std::string title, x_label, y_label;
  std::vector<std::string> groups;  // named in a legend if there are several
  std::vector<ScatterPoint> points;
  std::vector<std::size_t> front;  // indices of points, in the order of the line
};

// Panels side by side under one title. Points that are not finite are left out.
std::string scatterSvg(const std::string& title, std::span<const ScatterPanel> panels);

}  // namespace deltaz
