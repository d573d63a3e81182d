#include "librender/scene/projected_error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <random>

#include "librender/scene/view_volume.h"
#include "tests/librender/scene/node_samples.h"

namespace deltaz {
namespace {

// Views from everywhere around a node, near and far, that have its centre about in the picture.
ViewTransform viewOf(const NodeVolume& volume, std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Camera camera;
  camera.field_of_view = uniform(2, 120);
  camera.width = 640;
  camera.height = 400;
  const Vector3 aside = normalized(cross(volume.up, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}));
  const double distance = volume.radius * std::pow(10.0, uniform(-0.7, 2));
  const double rise = random() % 3 == 0 ? 1.57 : uniform(-0.2, 1.57);  // every third from above
  ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  view.eye = volume.centre + volume.up * (distance * std::sin(rise)) + aside * (distance * std::cos(rise));
  const Vector3 target = volume.centre + aside * (volume.radius * uniform(-1, 1)) +
                         cross(volume.up, aside) * (volume.radius * uniform(-1, 1));
  view.forward = normalized(target - view.eye);
  view.right = normalized(cross(view.forward, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}));
  view.down = cross(view.forward, view.right);
  return view;
}

bool inPicture(const ViewTransform& view, const Vector3& p) {
  return p.x > kHither && std::abs(p.y / p.x) <= view.width / 2.0 && std::abs(p.z / p.x) <= view.height / 2.0;
}

// The largest movement on the screen when the posts are displaced; infinite for what passes the eye.
double largestMovement(const ViewTransform& view, const std::vector<SamplePost>& posts, double error,
                       bool along_normals, std::mt19937& random) {
  std::normal_distribution<double> normal;
  double largest = 0;
  const std::size_t step = std::max<std::size_t>(1, posts.size() / 300);
  for (std::size_t k = random() % step; k < posts.size(); k += step) {
    const SamplePost& post = posts[k];
    const Vector3 a = view.toView(post.position);
    if (!inPicture(view, a)) continue;
    const Vector3 direction =
        along_normals ? post.up : normalized({normal(random), normal(random), normal(random)});
    for (const double share : {-1.0, -0.4, 0.7, 1.0}) {
      const Vector3 b = view.toView(post.position + direction * (error * share));
      largest =
          std::max(largest, b.x > 0 ? std::hypot(a.y / a.x - b.y / b.x, a.z / a.x - b.z / b.x) : HUGE_VAL);
    }
  }
  return largest;
}

TEST(ProjectedErrors, are_never_too_small_and_not_much_too_large) {
  std::mt19937 random(21);
  double tightest = 0;
  std::uint64_t finite = 0, all = 0;
  std::vector<double> gains;
  for (const SyntheticGridOptions& options : areasOfAllSorts()) {
    const MemoryDatabase area = makeDatabase(options, 8);
    forEachNode(area.database, [&](const Node& node, const std::vector<SamplePost>& posts) {
      const NodeVolume volume = volumeOf(node, area.database.grid(0), true);
      for (int n = 0; n < 12; ++n) {
        const ViewTransform view = viewOf(volume, random);
        const double error = volume.radius * std::pow(10.0, -0.5 * static_cast<double>(random() % 8));
        const double heights = projectedHeightErrorBound(view, volume, error),
                     any = projectedErrorBound(view, volume, error),
                     of_ball = projectedErrorBound(view, volume.centre, volume.radius, error);
        const double moved = largestMovement(view, posts, error, true, random);
        ASSERT_LE(moved, heights);
        ASSERT_LE(largestMovement(view, posts, error, false, random), any);
        ASSERT_LE(heights, any * (1 + 1e-6));
        ++all;
        if (!std::isfinite(heights)) continue;
        ++finite;
        tightest = std::max(tightest, moved / heights);
        if (std::isfinite(of_ball)) gains.push_back(of_ball / heights);
      }
    });
  }
  std::sort(gains.begin(), gains.end());
  std::printf("%llu of %llu bounds finite, tightest %.3f; of the ball's bound a median of %.2f times\n",
              static_cast<unsigned long long>(finite), static_cast<unsigned long long>(all), tightest,
              gains[gains.size() / 2]);
  EXPECT_GT(finite, 2000u);
  EXPECT_GT(tightest, 0.9);
  EXPECT_GT(gains[gains.size() / 2], 1.1);
}

TEST(ProjectedErrors, heights_seen_from_straight_above_hardly_move) {
  const MemoryDatabase area = makeDatabase(smallArea(), 8);
  const Node leaf = nodesOfLevel(area.database, 0, 0).value().front();
  const NodeVolume volume = volumeOf(leaf, area.database.grid(0), true);
  Camera camera;
  camera.eye = toGeodetic(EllipsoidShape{}, volume.centre);
  camera.eye.height += 100000;
  camera.pitch = -90;
  const ViewTransform view = makeViewTransform(camera, EllipsoidShape{});
  const double any = projectedErrorBound(view, volume, 10),
               heights = projectedHeightErrorBound(view, volume, 10);
  EXPECT_GT(any, 0.05);
  EXPECT_LT(heights, any * 0.02);
  // The same from the side.
  camera.eye.height -= 100000;
  camera.eye.latitude -= 1;
  camera.pitch = 0;
  const ViewTransform side = makeViewTransform(camera, EllipsoidShape{});
  EXPECT_GT(projectedHeightErrorBound(side, volume, 10), projectedErrorBound(side, volume, 10) * 0.9);
}

TEST(ProjectedErrors, of_none_are_none_and_of_unknown_ones_unknown) {
  const MemoryDatabase area = makeDatabase(smallArea(), 8);
  const NodeVolume volume =
      volumeOf(nodesOfLevel(area.database, 0, 0).value().front(), area.database.grid(0), true);
  const ViewTransform view = makeViewTransform(Camera{}, EllipsoidShape{});
  EXPECT_EQ(projectedErrorBound(view, volume, 0), 0);
  EXPECT_EQ(projectedHeightErrorBound(view, volume, 0), 0);
  EXPECT_EQ(projectedErrorBound(view, volume, HUGE_VAL), HUGE_VAL);
  EXPECT_EQ(projectedHeightErrorBound(view, volume, HUGE_VAL), HUGE_VAL);
  ViewTransform inside = view;
  inside.eye = volume.centre;
  EXPECT_EQ(projectedHeightErrorBound(inside, volume, 1), HUGE_VAL);
}

}  // namespace
}  // namespace deltaz
