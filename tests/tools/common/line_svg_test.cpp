#include "tools/common/line_svg.h"

#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <regex>

namespace deltaz {
namespace {

// The points of the first series, whose markers are circles, but for the legend's.
std::vector<std::array<double, 2>> circlesOf(const std::string& svg) {
  std::vector<std::array<double, 2>> circles;
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it)
    circles.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  return circles;
}

LinePanel panelOf(std::vector<LinePoint> points) {
  return {"title", "x", "y", {{"one", std::move(points)}}};
}

TEST(LineSvg, equal_differences_take_equal_distances_from_zero) {
  const LinePanel panels[] = {panelOf({{0, 0}, {10, 1}, {20, 2}})};
  const auto circles = circlesOf(lineSvg("t", panels));
  ASSERT_EQ(circles.size(), 3u);
  EXPECT_NEAR(circles[1][0] - circles[0][0], circles[2][0] - circles[1][0], 0.11);
  EXPECT_NEAR(circles[1][1] - circles[0][1], circles[2][1] - circles[1][1], 0.11);
  EXPECT_GT(circles[1][0], circles[0][0] + 50);
  EXPECT_LT(circles[1][1], circles[0][1] - 50);
}

TEST(LineSvg, equal_ratios_do_on_logarithmic_axes) {
  LinePanel panel = panelOf({{1, 0.1}, {10, 1}, {100, 10}, {0, 1}, {1, -1}});
  panel.logarithmic_x = panel.logarithmic_y = true;
  const LinePanel panels[] = {panel};
  const auto circles = circlesOf(lineSvg("t", panels));
  ASSERT_EQ(circles.size(), 3u);
  EXPECT_NEAR(circles[1][0] - circles[0][0], circles[2][0] - circles[1][0], 0.11);
  EXPECT_NEAR(circles[1][1] - circles[0][1], circles[2][1] - circles[1][1], 0.11);
}

TEST(LineSvg, names_series_and_leaves_out_what_is_not_finite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  LinePanel panel = panelOf({{1, 1}, {2, kNan}, {3, 2}});
  panel.series.push_back({"published & <old>", {{1, 2}, {3, 4}}, true});
  const LinePanel panels[] = {panel, panelOf({})};
  const std::string svg = lineSvg("t", panels);
  EXPECT_EQ(circlesOf(svg).size(), 3u);  // two points and the legend's
  EXPECT_NE(svg.find("published &amp; &lt;old&gt;"), std::string::npos);
  EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg, lineSvg("t", panels));
}

TEST(LineSvg, panels_stand_in_rows) {
  const std::vector<LinePanel> panels(5, panelOf({{1, 1}}));
  const std::string svg = lineSvg("t", panels, 2);
  EXPECT_NE(svg.find("width=\"1120\" height=\"1180\""), std::string::npos);
  const auto circles = circlesOf(svg);
  ASSERT_EQ(circles.size(), 5u);
  EXPECT_EQ(circles[0][1], circles[1][1]);
  EXPECT_EQ(circles[0][0], circles[4][0]);
  EXPECT_GT(circles[4][1], circles[2][1] + 300);
}

}  // namespace
}  // namespace deltaz
