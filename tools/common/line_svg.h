// Curves as SVG: linear axes from zero or logarithmic ones, lines through points, dashed ones for what was
// published. Text that needs nothing but a viewer; the same input gives the same bytes. Thread-safety: pure
// function.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace deltaz {

struct LinePoint {
  double x = 0, y = 0;
};

struct LineSeries {
  std::string name;
  std::vector<LinePoint> points;  // in the order of the line
  bool dashed = false;
};

struct LinePanel {
  std::string title, x_label, y_label;
  std::vector<LineSeries> series;
  bool logarithmic_x = false, logarithmic_y = false;  // then only points above 0 are shown
};

// Panels under one title, at most `across` beside each other. Points that are not finite are left out.
std::string lineSvg(const std::string& title, std::span<const LinePanel> panels, int across = 2);

}  // namespace deltaz
