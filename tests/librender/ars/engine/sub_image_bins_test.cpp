#include "librender/ars/engine/sub_image_bins.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "librender/ars/words/triangle_stream.h"
#include "librender/scene/view_volume.h"

namespace deltaz::ars {
namespace {

ViewTransform viewOf(int width, int height) {
  ViewTransform view;
  view.width = width;
  view.height = height;
  view.centre_i = (height - 1) / 2.0;
  view.centre_j = (width - 1) / 2.0;
  return view;
}

std::vector<ViewTriangle> someTriangles(const ViewTransform& view, int count) {
  std::mt19937 random(7);
  const auto uniform = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(random()) / 4294967296.0;
  };
  std::vector<ViewTriangle> triangles;
  for (int n = 0; n < count; ++n) {
    const double i = uniform(-300, view.height + 300) - view.centre_i,
                 j = uniform(-300, view.width + 300) - view.centre_j, size = std::exp(uniform(0, 6));
    ViewTriangle triangle;
    for (ViewVertex& vertex : triangle.vertex) {
      vertex.u = n % 9 == 0 ? uniform(-1, 2) : uniform(1, 100);
      vertex.v = (j + uniform(-size, size)) * vertex.u;
      vertex.w = (i + uniform(-size, size)) * vertex.u;
    }
    // Corners on the joints of sub-images.
    if (n % 5 == 0) triangle.vertex[0].v = (512 - view.centre_j) * triangle.vertex[0].u;
    if (n % 7 == 0) triangle.vertex[1].w = (511 - view.centre_i) * triangle.vertex[1].u;
    if (n % 101 == 0) triangle.vertex[2].v = std::numeric_limits<double>::quiet_NaN();
    triangles.push_back(triangle);
  }
  return triangles;
}

// What each sub-image shows, and all counts, are as if its pretiler had looked at every triangle.
TEST(SubImageBins, leave_out_only_what_a_sub_image_does_not_show) {
  for (const auto& [width, height] : {std::pair(1200, 700), std::pair(513, 512), std::pair(400, 300)}) {
    const ViewTransform view = viewOf(width, height);
    const std::vector<ViewTriangle> triangles = someTriangles(view, 4000);
    const SubImageBins bins = binTriangles(triangles, view);
    PretilerCounts all, binned = bins.left_out;
    std::size_t looked_at = 0;
    for (std::uint32_t n = 0; n < bins.triangles.size(); ++n) {
      const SubImageOrigin origin = subImageOrigin(n, width);
      ScreenView screen;
      screen.centre_i = view.centre_i - origin.i;
      screen.centre_j = view.centre_j - origin.j;
      screen.lines = std::min(512, height - origin.i);
      screen.pixels = std::min(512, width - origin.j);
      screen.hither = kHither;
      const Pretiler pretiler(screen);
      std::vector<ScreenTriangle> of_all, of_bin;
      for (const ViewTriangle& triangle : triangles) pretiler.process(triangle, of_all, all);
      for (const std::uint32_t t : bins.triangles[n]) pretiler.process(triangles[t], of_bin, binned);
      looked_at += bins.triangles[n].size();
      ASSERT_EQ(of_bin.size(), of_all.size());
      for (std::size_t k = 0; k < of_all.size(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_EQ(of_bin[k].corner[c].i, of_all[k].corner[c].i);
          ASSERT_EQ(of_bin[k].corner[c].j, of_all[k].corner[c].j);
        }
      }
    }
    EXPECT_EQ(binned, all);
    if (bins.triangles.size() > 4) {
      EXPECT_LT(2 * looked_at, bins.triangles.size() * triangles.size());
    }
  }
}

}  // namespace
}  // namespace deltaz::ars
