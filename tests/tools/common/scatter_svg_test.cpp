#include "tools/common/scatter_svg.h"

#include <gtest/gtest.h>
#include <limits>
#include <regex>

namespace deltaz {
namespace {

std::vector<std::array<double, 2>> circlesOf(const std::string& svg) {
  std::vector<std::array<double, 2>> circles;
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it)
    circles.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  return circles;
}

ScatterPanel panel(std::vector<ScatterPoint> points) {
  ScatterPanel panel;
  panel.title = "title";
  panel.groups = {"one"};
  panel.points = std::move(points);
  return panel;
}

// Equal ratios take equal distances, more is to the right and up.
TEST(ScatterSvg, places_points_on_logarithmic_axes) {
  const ScatterPanel panels[] = {panel({{1, 0.1, 0, ""}, {10, 1, 0, ""}, {100, 10, 0, ""}})};
  const auto circles = circlesOf(scatterSvg("t", panels));
  ASSERT_EQ(circles.size(), 3u);
  EXPECT_NEAR(circles[1][0] - circles[0][0], circles[2][0] - circles[1][0], 0.11);
  EXPECT_NEAR(circles[1][1] - circles[0][1], circles[2][1] - circles[1][1], 0.11);
  EXPECT_GT(circles[1][0], circles[0][0] + 50);
  EXPECT_LT(circles[1][1], circles[0][1] - 50);
}

TEST(ScatterSvg, puts_zero_below_every_other_value) {
  const ScatterPanel panels[] = {panel({{1, 0, 0, ""}, {2, 1e-9, 0, ""}, {3, 1, 0, ""}})};
  const std::string svg = scatterSvg("t", panels);
  const auto circles = circlesOf(svg);
  ASSERT_EQ(circles.size(), 3u);
  EXPECT_GT(circles[0][1], circles[1][1]);
  EXPECT_NE(svg.find(">0</text>"), std::string::npos);
}

TEST(ScatterSvg, leaves_out_what_is_not_finite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ScatterPanel all = panel({{1, 1, 0, "a"}, {2, kInfinity, 0, "b"}, {0, 1, 0, "c"}, {3, -1, 0, "d"}});
  all.front = {0, 1, 2, 3};
  const ScatterPanel panels[] = {all};
  const std::string svg = scatterSvg("t", panels);
  EXPECT_EQ(circlesOf(svg).size(), 1u);
  EXPECT_NE(svg.find(">a</text>"), std::string::npos);
  for (const char* word : {">b<", ">c<", ">d<", "inf", "nan"}) EXPECT_EQ(svg.find(word), std::string::npos);
  const ScatterPanel empty[] = {panel({})};
  EXPECT_TRUE(circlesOf(scatterSvg("t", empty)).empty());
}

TEST(ScatterSvg, escapes_what_xml_would_take_for_its_own) {
  ScatterPanel odd = panel({{1, 1, 0, "<a & \"b\">"}});
  odd.front = {0};
  const ScatterPanel panels[] = {odd};
  const std::string svg = scatterSvg("x & <y>", panels);
  EXPECT_NE(svg.find("&lt;a &amp; &quot;b&quot;&gt;"), std::string::npos);
  EXPECT_NE(svg.find("x &amp; &lt;y&gt;"), std::string::npos);
  EXPECT_EQ(svg.find("<y>"), std::string::npos);
}

TEST(ScatterSvg, labels_of_crowded_points_do_not_overlap) {
  ScatterPanel crowded;
  crowded.groups = {"one"};
  for (int k = 0; k < 5; ++k) {
    crowded.points.push_back({10.0 + 0.2 * k, 10.0 - 0.2 * k, 0, "label"});
    crowded.front.push_back(static_cast<std::size_t>(k));
  }
  crowded.points.push_back({1, 100, 0, ""});
  crowded.points.push_back({100, 1, 0, ""});
  const ScatterPanel panels[] = {crowded};
  const std::string svg = scatterSvg("t", panels);
  const std::regex label("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\" text-anchor=\"start\">label<");
  std::vector<std::array<double, 2>> places;
  for (std::sregex_iterator it(svg.begin(), svg.end(), label), end; it != end; ++it)
    places.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  ASSERT_EQ(places.size(), 5u);
  for (std::size_t a = 0; a < places.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_TRUE(std::abs(places[a][1] - places[b][1]) > 10 || std::abs(places[a][0] - places[b][0]) > 25);
    }
  }
}

}  // namespace
}  // namespace deltaz
