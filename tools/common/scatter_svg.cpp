#include "tools/common/scatter_svg.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "tools/common/svg_parts.h"

namespace deltaz {

namespace {

constexpr double kPanelWidth = 600, kPanelHeight = 460, kTitleHeight = 40;
constexpr double kLeft = 70, kRight = 24, kTop = 36, kBottom = 56;
constexpr double kZeroBand = 26;  // below the least value of a logarithmic axis
constexpr double kCharacter = 6.7, kLine = 13;
// A logarithmic axis over at least half a decade.
class Axis {
 public:
  Axis(std::vector<double> values, double from, double to, double zero) : from_(from), to_(to), zero_(zero) {
    std::erase_if(values, [](double value) { return !(value > 0); });
    double low = 1, high = 1;
    if (!values.empty()) {
      low = *std::min_element(values.begin(), values.end());
      high = *std::max_element(values.begin(), values.end());
    }
    low_ = std::log10(low);
    high_ = std::log10(high);
    const double margin = std::max(0.08 * (high_ - low_), (0.5 - (high_ - low_)) / 2);
    low_ -= margin;
    high_ += margin;
  }

  double place(double value) const {
    return value > 0 ? from_ + (std::log10(value) - low_) / (high_ - low_) * (to_ - from_) : zero_;
  }

  // 1, 2, 5, 10, ...; only powers of ten where those would crowd.
  std::vector<double> ticks() const {
    std::vector<double> ticks;
    const bool few = high_ - low_ > 3;
    for (int decade = static_cast<int>(std::floor(low_)); decade <= static_cast<int>(std::ceil(high_));
         ++decade) {
      for (const int digit : {1, 2, 5}) {
        if (few && digit != 1) continue;
        const double value = digit * std::pow(10.0, decade);
        if (std::log10(value) >= low_ && std::log10(value) <= high_) ticks.push_back(value);
      }
    }
    return ticks;
  }

 private:
  double from_, to_, zero_;
  double low_ = 0, high_ = 1;
};

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

class PanelDrawing {
 public:
  PanelDrawing(const ScatterPanel& panel, double offset)
      : panel_(panel),
        left_(offset + kLeft),
        right_(offset + kPanelWidth - kRight),
        top_(kTitleHeight + kTop),
        bottom_(kTitleHeight + kPanelHeight - kBottom),
        x_(valuesOf(&ScatterPoint::x), left_, right_, left_),
        y_(valuesOf(&ScatterPoint::y), bottom_ - (hasZero() ? kZeroBand : 0), top_, bottom_ - kZeroBand / 3) {
  }

  std::string draw() {
    std::string svg =
        svgText((left_ + right_) / 2, top_ - 12, "middle", panel_.title, " font-weight=\"bold\"");
    for (const double tick : x_.ticks()) {
      svg += svgLine(x_.place(tick), top_, x_.place(tick), bottom_, "#dddddd");
      svg += svgText(x_.place(tick), bottom_ + 16, "middle", fmt::format("{:.6g}", tick));
    }
    for (const double tick : y_.ticks()) {
      svg += svgLine(left_, y_.place(tick), right_, y_.place(tick), "#dddddd");
      svg += svgText(left_ - 6, y_.place(tick) + 4, "end", fmt::format("{:.6g}", tick));
    }
    if (hasZero()) {
      svg += svgText(left_ - 6, y_.place(0) + 4, "end", "0");
      // Below this line the axis is none.
      svg += svgLine(left_, bottom_ - kZeroBand, right_, bottom_ - kZeroBand, "#999999");
    }
    svg += svgPanelFrame({left_, top_, right_, bottom_}, panel_.x_label, panel_.y_label);
    svg += frontLine();
    for (const ScatterPoint& point : panel_.points) {
      if (!shown(point)) continue;
      svg += svgMarker(point.group, x_.place(point.x), y_.place(point.y));
      taken_.push_back(around(point));
    }
    svg += legend();
    for (const std::size_t k : panel_.front) svg += label(panel_.points[k]);
    return svg;
  }

 private:
  static bool shown(const ScatterPoint& point) {
    return std::isfinite(point.x) && point.x > 0 && std::isfinite(point.y) && point.y >= 0;
  }
  std::vector<double> valuesOf(double ScatterPoint::*coordinate) const {
    std::vector<double> values;
    for (const ScatterPoint& point : panel_.points) {
      if (shown(point)) values.push_back(point.*coordinate);
    }
    return values;
  }
  bool hasZero() const {
    return std::any_of(panel_.points.begin(), panel_.points.end(),
                       [](const ScatterPoint& point) { return shown(point) && point.y == 0; });
  }
  Box around(const ScatterPoint& point) const {
    const double x = x_.place(point.x), y = y_.place(point.y);
    return {x - 5, y - 5, x + 5, y + 5};
  }

  std::string frontLine() const {
    std::string points;
    for (const std::size_t k : panel_.front) {
      const ScatterPoint& point = panel_.points[k];
      if (shown(point)) points += fmt::format("{:.1f},{:.1f} ", x_.place(point.x), y_.place(point.y));
    }
    if (points.empty()) return {};
    points.pop_back();
    return svgPolyline(points, "#888888");
  }

  std::string legend() {
    if (panel_.groups.size() < 2) return {};
    std::size_t longest = 0;
    for (const std::string& group : panel_.groups) longest = std::max(longest, group.size());
    const double width = 24 + kCharacter * static_cast<double>(longest);
    const double height = 8 + 16 * static_cast<double>(panel_.groups.size());
    const Box box{right_ - width - 6, top_ + 6, right_ - 6, top_ + 6 + height};
    taken_.push_back(box);
    std::string svg = fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"white\" "
        "fill-opacity=\"0.85\" stroke=\"#cccccc\"/>\n",
        box.left, box.top, width, height);
    for (std::size_t group = 0; group < panel_.groups.size(); ++group) {
      const double y = box.top + 12 + 16 * static_cast<double>(group);
      svg +=
          svgMarker(group, box.left + 10, y) + svgText(box.left + 20, y + 4, "start", panel_.groups[group]);
    }
    return svg;
  }

  // Beside the point, where nothing else stands; if there is no such place, right above it.
  std::string label(const ScatterPoint& point) {
    if (!shown(point) || point.label.empty()) return {};
    const double x = x_.place(point.x), y = y_.place(point.y);
    const double width = kCharacter * static_cast<double>(point.label.size());
    struct Place {
      double left = 0, baseline = 0;
    };
    std::vector<Place> places;
    for (const double away : {8.0, 20.0, 34.0}) {
      places.push_back({x + 8, y - away + 4});
      places.push_back({x - 8 - width, y + away + 4});
      places.push_back({x + 8, y + away + 4});
      places.push_back({x - 8 - width, y - away + 4});
    }
    Place best = {x + 8, y - 4};
    for (const Place& place : places) {
      const Box box{place.left, place.baseline - kLine + 2, place.left + width, place.baseline + 3};
      const bool inside =
          box.left > left_ + 2 && box.right < right_ - 2 && box.top > top_ + 2 && box.bottom < bottom_ - 2;
      if (!inside ||
          std::any_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.meets(other); }))
        continue;
      best = place;
      break;
    }
    taken_.push_back({best.left, best.baseline - kLine + 2, best.left + width, best.baseline + 3});
    return svgText(best.left, best.baseline, "start", point.label);
  }

  const ScatterPanel& panel_;
  double left_, right_, top_, bottom_;
  Axis x_, y_;
  std::vector<Box> taken_;
};

}  // namespace

std::string scatterSvg(const std::string& title, std::span<const ScatterPanel> panels) {
  const double width = kPanelWidth * static_cast<double>(panels.size()), height = kTitleHeight + kPanelHeight;
  std::string svg = svgBegin(width, height);
  svg += svgText(width / 2, 26, "middle", title, " font-size=\"15\"");
  for (std::size_t k = 0; k < panels.size(); ++k)
    svg += PanelDrawing(panels[k], kPanelWidth * static_cast<double>(k)).draw();
  return svg + kSvgEnd;
}

}  // namespace deltaz
