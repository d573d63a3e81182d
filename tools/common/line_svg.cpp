#include "tools/common/line_svg.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "tools/common/svg_parts.h"

namespace deltaz {

namespace {

constexpr double kPanelWidth = 560, kPanelHeight = 380, kTitleHeight = 40;
constexpr double kLeft = 70, kRight = 24, kTop = 36, kBottom = 56;
constexpr double kCharacter = 6.7;
constexpr double kWantedTicks = 6;

// From zero, or from the least value, whichever is lower; logarithmic ones over at least half a decade.
class Axis {
 public:
  Axis(const std::vector<double>& values, bool logarithmic, double from, double to)
      : logarithmic_(logarithmic), from_(from), to_(to) {
    if (!values.empty()) {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      low_ = *low;
      high_ = *high;
    }
    if (logarithmic_) {
      low_ = std::log10(low_);
      high_ = std::log10(high_);
      const double margin = std::max(0.05 * (high_ - low_), (0.5 - (high_ - low_)) / 2);
      low_ -= margin;
      high_ += margin;
    } else {
      low_ = std::min(low_, 0.0);
      high_ = high_ > low_ ? high_ + 0.05 * (high_ - low_) : low_ + 1;
    }
  }

  double place(double value) const {
    return from_ + ((logarithmic_ ? std::log10(value) : value) - low_) / (high_ - low_) * (to_ - from_);
  }

  std::vector<double> ticks() const {
    std::vector<double> ticks;
    if (logarithmic_) {
      const bool few = high_ - low_ > 3;
      for (int decade = static_cast<int>(std::floor(low_)); decade <= static_cast<int>(std::ceil(high_));
           ++decade) {
        for (const int digit : {1, 2, 5}) {
          const double value = digit * std::pow(10.0, decade);
          if ((!few || digit == 1) && std::log10(value) >= low_ && std::log10(value) <= high_)
            ticks.push_back(value);
        }
      }
      return ticks;
    }
    const double raw = (high_ - low_) / kWantedTicks, decade = std::pow(10.0, std::floor(std::log10(raw)));
    const double digit = raw / decade;
    const double step = decade * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
    for (double n = std::ceil(low_ / step); n * step <= high_; ++n) ticks.push_back(n * step);
    return ticks;
  }

 private:
  bool logarithmic_;
  double from_, to_;
  double low_ = 0, high_ = 1;
};

class PanelDrawing {
 public:
  PanelDrawing(const LinePanel& panel, double left, double top)
      : panel_(panel),
        left_(left + kLeft),
        right_(left + kPanelWidth - kRight),
        top_(top + kTop),
        bottom_(top + kPanelHeight - kBottom),
        x_(valuesOf(&LinePoint::x), panel.logarithmic_x, left_, right_),
        y_(valuesOf(&LinePoint::y), panel.logarithmic_y, bottom_, top_) {}

  std::string draw() const {
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
    svg += svgPanelFrame({left_, top_, right_, bottom_}, panel_.x_label, panel_.y_label);
    for (std::size_t s = 0; s < panel_.series.size(); ++s) svg += curve(s);
    return svg + legend();
  }

 private:
  bool shown(const LinePoint& point) const {
    return std::isfinite(point.x) && std::isfinite(point.y) && (!panel_.logarithmic_x || point.x > 0) &&
           (!panel_.logarithmic_y || point.y > 0);
  }

  std::vector<double> valuesOf(double LinePoint::*coordinate) const {
    std::vector<double> values;
    for (const LineSeries& series : panel_.series) {
      for (const LinePoint& point : series.points) {
        if (shown(point)) values.push_back(point.*coordinate);
      }
    }
    return values;
  }

  std::string curve(std::size_t number) const {
    const LineSeries& series = panel_.series[number];
    std::string points, markers;
    for (const LinePoint& point : series.points) {
      if (!shown(point)) continue;
      const double x = x_.place(point.x), y = y_.place(point.y);
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x, y);
      markers += svgMarker(number, x, y);
    }
    return points.empty() ? std::string() : svgPolyline(points, svgColor(number), series.dashed) + markers;
  }

  // In the corner of the panel that fewest points lie in.
  std::string legend() const {
    if (panel_.series.size() < 2) return {};
    std::size_t longest = 0;
    for (const LineSeries& series : panel_.series) longest = std::max(longest, series.name.size());
    const double width = 30 + kCharacter * static_cast<double>(longest);
    const double height = 8 + 16 * static_cast<double>(panel_.series.size());
    double left = 0, top = 0;
    std::size_t fewest = static_cast<std::size_t>(-1);
    for (const bool at_bottom : {false, true}) {
      for (const bool at_left : {false, true}) {
        const double x = at_left ? left_ + 6 : right_ - width - 6;
        const double y = at_bottom ? bottom_ - height - 6 : top_ + 6;
        const std::size_t covered = pointsIn(x, y, x + width, y + height);
        if (covered >= fewest) continue;
        fewest = covered;
        left = x;
        top = y;
      }
    }
    std::string svg = fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"white\" "
        "fill-opacity=\"0.85\" stroke=\"#cccccc\"/>\n",
        left, top, width, height);
    for (std::size_t s = 0; s < panel_.series.size(); ++s) {
      const double y = top + 12 + 16 * static_cast<double>(s);
      svg += svgPolyline(fmt::format("{:.1f},{:.1f} {:.1f},{:.1f}", left + 4, y, left + 22, y), svgColor(s),
                         panel_.series[s].dashed);
      svg += svgMarker(s, left + 13, y) + svgText(left + 26, y + 4, "start", panel_.series[s].name);
    }
    return svg;
  }

  std::size_t pointsIn(double left, double top, double right, double bottom) const {
    std::size_t count = 0;
    for (const LineSeries& series : panel_.series) {
      for (const LinePoint& point : series.points) {
        if (!shown(point)) continue;
        const double x = x_.place(point.x), y = y_.place(point.y);
        count += x > left - 5 && x < right + 5 && y > top - 5 && y < bottom + 5 ? 1 : 0;
      }
    }
    return count;
  }

  const LinePanel& panel_;
  double left_, right_, top_, bottom_;
  Axis x_, y_;
};

}  // namespace

std::string lineSvg(const std::string& title, std::span<const LinePanel> panels, int across) {
  const auto columns = std::min(panels.size(), static_cast<std::size_t>(std::max(across, 1)));
  const std::size_t rows = columns == 0 ? 0 : (panels.size() + columns - 1) / columns;
  const double width = kPanelWidth * static_cast<double>(std::max<std::size_t>(columns, 1));
  const double height = kTitleHeight + kPanelHeight * static_cast<double>(rows);
  std::string svg = svgBegin(width, height);
  svg += svgText(width / 2, 26, "middle", title, " font-size=\"15\"");
  for (std::size_t k = 0; k < panels.size(); ++k) {
    svg += PanelDrawing(panels[k], kPanelWidth * static_cast<double>(k % columns),
                        kTitleHeight + kPanelHeight * static_cast<double>(k / columns))
               .draw();
  }
  return svg + kSvgEnd;
}

}  // namespace deltaz
