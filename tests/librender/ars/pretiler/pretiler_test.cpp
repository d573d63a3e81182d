#include "librender/ars/pretiler/pretiler.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace deltaz::ars {
namespace {

// 512 x 512 pixels, 90 degrees.
ScreenView view() {
  return {255.5, 255.5, 512, 512, 1};
}

ViewVertex at(double u, double i, double j, double gray = 100) {
  return {u, (j - 255.5) * u, (i - 255.5) * u, {gray, gray + 1, gray + 2}};
}

struct Pretiled {
  std::vector<ScreenTriangle> triangles;
  PretilerCounts counts;
};

Pretiled pretiled(const ViewTriangle& triangle, const ScreenView& screen = view()) {
  Pretiled result;
  Pretiler(screen).process(triangle, result.triangles, result.counts);
  const PretilerCounts& n = result.counts;
  EXPECT_EQ(n.in, n.beyond_yon + n.before_hither + n.beside + n.edge_on + n.drawn);
  EXPECT_EQ(n.out, result.triangles.size());
  return result;
}

double areaOf(const ScreenTriangle& t) {
  const auto& [a, b, c] = t.corner;
  return 0.5 * ((b.i - a.i) * (c.j - a.j) - (c.i - a.i) * (b.j - a.j));
}

double sumOfAreas(const Pretiled& result) {
  double sum = 0;
  for (const ScreenTriangle& t : result.triangles) sum += areaOf(t);
  return sum;
}

TEST(ArsPretiler, leaves_what_stands_on_the_screen_as_it_is) {
  const Pretiled result = pretiled({at(10, 20, 30, 50), at(20, 120, 40, 60), at(40, 60, 200, 90)});
  ASSERT_EQ(result.triangles.size(), 1);
  EXPECT_EQ(result.counts.cut_by_hither + result.counts.cut_by_screen, 0);
  const ScreenTriangle& t = result.triangles[0];
  const double inverse_u[3] = {1 / 10.0, 1 / 20.0, 1 / 40.0}, gray[3] = {50, 60, 90};
  for (std::size_t k = 0; k < 3; ++k) {
    const double di = t.corner[k].i - t.planes.anchor.i, dj = t.corner[k].j - t.planes.anchor.j;
    EXPECT_NEAR(t.planes.inverse_u.at(di, dj), inverse_u[k], 1e-15);
    for (std::size_t c = 0; c < kColors; ++c)
      EXPECT_NEAR(t.planes.color[c].at(di, dj), gray[k] + static_cast<double>(c), 1e-12);
  }
  EXPECT_EQ(t.planes.least_inverse_u, 1 / 40.0);
  EXPECT_EQ(t.planes.greatest_inverse_u, 1 / 10.0);
}

// Report 4.2.2.2: 1/U is linear on the screen, so a rod from U = 1 to 3 shows its middle three quarters
// along.
TEST(ArsPretiler, planes_are_linear_in_the_inverse_of_depth) {
  const Pretiled result = pretiled({at(1, 100, 100), at(3, 100, 300), at(1, 200, 100)});
  ASSERT_EQ(result.triangles.size(), 1);
  const ScreenPlanes& planes = result.triangles[0].planes;
  const double along = 0.75 * 200 - (planes.anchor.j - 100);
  EXPECT_NEAR(1 / planes.inverse_u.at(100 - planes.anchor.i, along), 2, 1e-12);
}

// Digest section 5: interpolating 1/U from U = 2 to U = -3 would give 3 at the hither plane.
TEST(ArsPretiler, cuts_at_the_hither_plane_in_three_dimensions) {
  // The colour where the edge meets the plane: a fifth of the way from U = 2 to U = -3.
  const Pretiled wide =
      pretiled({at(2, 250, 250, 0), ViewVertex{-3, -300, -200, {250, 251, 252}}, at(2, 300, 100, 0)});
  ASSERT_EQ(wide.counts.cut_by_hither, 1);
  double brightest = 0;
  for (const ScreenTriangle& t : wide.triangles) {
    EXPECT_DOUBLE_EQ(t.planes.greatest_inverse_u, 1);
    EXPECT_DOUBLE_EQ(t.planes.least_inverse_u, 0.5);
    for (const ScreenPosition& p : t.corner)
      brightest = std::max(brightest, t.planes.color[0].at(p.i - t.planes.anchor.i, p.j - t.planes.anchor.j));
  }
  EXPECT_NEAR(brightest, 50, 1e-9);
}

TEST(ArsPretiler, drops_what_is_not_seen_and_says_why) {
  EXPECT_EQ(pretiled({at(0.5, 1, 1), at(0.6, 100, 1), at(0.9, 50, 50)}).counts.before_hither, 1);
  EXPECT_EQ(pretiled({at(5, 1, 600), at(5, 100, 700), at(5, 50, 650)}).counts.beside, 1);
  EXPECT_EQ(pretiled({at(5, 600, 1), at(5, 700, 1), at(5, 650, 50)}).counts.beside, 1);
  EXPECT_EQ(pretiled({at(5, 10, 10), at(5, 20, 20), at(5, 30, 30)}).counts.edge_on, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pretiled({ViewVertex{nan, 0, 0, {}}, at(5, 20, 20), at(5, 30, 30)}).counts.edge_on, 1);
  ScreenView near_sighted = view();
  near_sighted.yon = 100;
  EXPECT_EQ(pretiled({at(101, 10, 10), at(200, 20, 20), at(101, 30, 10)}, near_sighted).counts.beyond_yon, 1);
  // Trivial reject only: one vertex within is enough.
  EXPECT_EQ(pretiled({at(99, 10, 10), at(200, 20, 20), at(101, 30, 10)}, near_sighted).counts.drawn, 1);
}

// A corner of the screen may cut a triangle into a polygon of seven corners, five triangles.
TEST(ArsPretiler, cuts_to_the_screen_without_loss_and_keeps_the_planes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-600, 1100), depth(1, 50);
  std::size_t most = 0, cut = 0;
  for (int n = 0; n < 2000; ++n) {
    const ViewTriangle triangle{{at(depth(random), place(random), place(random)),
                                 at(depth(random), place(random), place(random)),
                                 at(depth(random), place(random), place(random))}};
    const Pretiled result = pretiled(triangle);
    most = std::max(most, result.triangles.size());
    cut += result.counts.cut_by_screen;
    double sign = 0;
    for (const ScreenTriangle& t : result.triangles) {
      for (const ScreenPosition& p : t.corner) {
        ASSERT_GE(p.i, 0);
        ASSERT_LE(p.i, 511);
        ASSERT_GE(p.j, 0);
        ASSERT_LE(p.j, 511);
      }
      // All pieces turn the same way.
      if (sign == 0) sign = areaOf(t);
      ASSERT_GE(areaOf(t) * sign, -1e-9);
    }
    // A coarse count of pixel centres inside the triangle is the pieces' area.
    double inside = 0;
    for (double i = 3.5; i < 511; i += 7) {
      for (double j = 3.5; j < 511; j += 7) {
        int positive = 0, negative = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const ViewVertex &a = triangle.vertex[k], &b = triangle.vertex[(k + 1) % 3];
          const double ai = 255.5 + a.w / a.u, aj = 255.5 + a.v / a.u;
          const double bi = 255.5 + b.w / b.u, bj = 255.5 + b.v / b.u;
          const double side = (bi - ai) * (j - aj) - (i - ai) * (bj - aj);
          positive += side > 0;
          negative += side < 0;
        }
        inside += (positive == 3 || negative == 3) ? 49 : 0;
      }
    }
    ASSERT_NEAR(std::abs(sumOfAreas(result)), inside, 0.02 * inside + 14000) << n;
  }
  EXPECT_GE(most, 3);
  EXPECT_GT(cut, 1000);
}

}  // namespace
}  // namespace deltaz::ars
