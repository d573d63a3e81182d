#include "tools/common/svg_parts.h"

#include <array>
#include <fmt/format.h>

namespace deltaz {

namespace {

constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return out;
}

}  // namespace

std::string svgBegin(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      width, height);
}

const char* svgColor(std::size_t group) {
  return kColors[group % kColors.size()];
}

std::string svgMarker(std::size_t group, double x, double y) {
  const char* const color = svgColor(group);
  switch (group % 3) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", x, y, color);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" height=\"7\" fill=\"{}\"/>\n", x - 3.5,
                         y - 3.5, color);
    default:
      return fmt::format("<path d=\"M{:.1f} {:.1f} l4.5 8 h-9 z\" fill=\"{}\"/>\n", x, y - 5, color);
  }
}

std::string svgText(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& more) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more,
                     escaped(text));
}

std::string svgLine(double x1, double y1, double x2, double y2, const char* stroke) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x1,
                     y1, x2, y2, stroke);
}

std::string svgPolyline(const std::string& points, const char* stroke, bool dashed) {
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"{}/>\n", points,
                     stroke, dashed ? " stroke-dasharray=\"5 3\"" : "");
}

std::string svgPanelFrame(const SvgFrame& frame, const std::string& x_label, const std::string& y_label) {
  std::string svg = fmt::format(
      "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"none\" "
      "stroke=\"#444444\"/>\n",
      frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
  svg += svgText((frame.left + frame.right) / 2, frame.bottom + 38, "middle", x_label);
  const double middle = (frame.top + frame.bottom) / 2;
  return svg + svgText(frame.left - 48, middle, "middle", y_label,
                       fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", frame.left - 48, middle));
}

}  // namespace deltaz
