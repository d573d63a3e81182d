// The parts that diagrams as SVG are made of. Coordinates in pixels from the upper left. The same input gives
// the same bytes. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <string>

namespace deltaz {

// Everything up to the first part, on white; what is drawn ends with kSvgEnd.
std::string svgBegin(double width, double height);
inline constexpr const char* kSvgEnd = "</svg>\n";

// Of groups; distinguishable with most kinds of colour vision, and by the markers' shapes.
const char* svgColor(std::size_t group);
std::string svgMarker(std::size_t group, double x, double y);
// `anchor`: start, middle or end. `more`: further attributes, with a space before each.
std::string svgText(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& more = {});
std::string svgLine(double x1, double y1, double x2, double y2, const char* stroke);
std::string svgPolyline(const std::string& points, const char* stroke, bool dashed = false);

// Of a panel's plot: its border, and what its axes are called, below and to the left of it.
struct SvgFrame {
  double left = 0, top = 0, right = 0, bottom = 0;
};
std::string svgPanelFrame(const SvgFrame& frame, const std::string& x_label, const std::string& y_label);

}  // namespace deltaz
