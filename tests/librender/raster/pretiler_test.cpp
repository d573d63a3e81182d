#include "librender/raster/pretiler.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <rapidcheck.h>
#include <set>
#include <vector>

#include "librender/scene/view_volume.h"

#include "binned_triangles.h"

namespace deltaz {
namespace {

constexpr int kWidth = 160, kHeight = 120;

ViewTransform smallView() {
  Camera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.field_of_view = 70;
  return makeViewTransform(camera, EllipsoidShape{});
}

// View-space position of a point given in metres forward, right, down.
Vector3 inView(const ViewTransform& view, double forward, double right, double down) {
  return {forward, right * view.pixels, down * view.pixels};
}

struct Drawn {
  PretiledNode node;
  std::set<std::uint32_t> kept;  // faces in the bins
  std::vector<int> count = std::vector<int>(kWidth * kHeight, 0);
  std::vector<double> inverse_u = std::vector<double>(kWidth * kHeight, 0);
};

// All faces, whatever side they show.
Drawn drawAll(const ViewTransform& view, const std::vector<Vector3>& position,
              const std::vector<std::array<std::uint32_t, 3>>& faces) {
  TerrainVertices vertices;
  vertices.position = position;
  vertices.light.resize(position.size());
  vertices.appended_texture.resize(position.size());
  TerrainFaces front;
  for (const auto& face : faces) {
    TerrainFace next;
    next.vertex = face;
    if (isBackFacing(position[face[0]], position[face[1]], position[face[2]]))
      next.vertex = {face[0], face[2], face[1]};
    front.front.push_back(next);
  }
  Drawn drawn;
  drawn.node = PretiledNode::ofTerrain(0, 1, vertices, front.front);
  TileBins bins;
  bins.reset(kWidth, kHeight, 1);
  bins.writer(0).begin(0);
  Pretiler(view).process(drawn.node, 0, bins.writer(0));
  bins.finish();
  forEachBinnedTriangle(
      bins, kWidth, kHeight,
      [&](const RasterTriangle& triangle, const SnappedTriangle& t, const SampleBounds& pixels) {
        drawn.kept.insert(triangle.face);
        const FacePlanes planes = facePlanes(view, drawn.node, triangle.face);
        forEachSample(t, pixels, [&](std::int32_t j, std::int32_t i) {
          const auto pixel = static_cast<std::size_t>(i * kWidth + j);
          ++drawn.count[pixel];
          drawn.inverse_u[pixel] = planes.inverseDepthAt(j, i);
        });
      });
  return drawn;
}

// A ground plane 1.7 m below the eye, reaching far behind it and far beyond the picture on all sides: hither
// clip and guard band at once. Each pixel whose ray meets the plane beyond the hither plane is covered
// exactly once.
TEST(Pretiler, clipped_ground_is_covered_exactly_once) {
  const ViewTransform view = smallView();
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::uniform_real_distribution<double> slope(-0.05, 0.05), move(-0.3, 0.3);
    const double a = slope(random), b = slope(random);
    const double cell = round % 2 == 0 ? 90 : 3;
    constexpr std::uint32_t kCells = 16;
    std::vector<Vector3> position;
    for (std::uint32_t y = 0; y <= kCells; ++y) {
      for (std::uint32_t x = 0; x <= kCells; ++x) {
        const double forward = (y - kCells / 2.0 + move(random)) * cell;
        const double right = (x - kCells / 2.0 + move(random)) * cell;
        position.push_back(inView(view, forward, right, 1.7 + a * forward + b * right));
      }
    }
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t y = 0; y < kCells; ++y) {
      for (std::uint32_t x = 0; x < kCells; ++x) {
        const std::uint32_t at = y * (kCells + 1) + x;
        faces.push_back({at, at + 1, at + kCells + 2});
        faces.push_back({at, at + kCells + 2, at + kCells + 1});
      }
    }
    const Drawn drawn = drawAll(view, position, faces);
    for (int i = 0; i < kHeight; ++i) {
      for (int j = 0; j < kWidth; ++j) {
        // down = 1.7 + a forward + b right on the ray (1, x, y).
        const double x = (j - view.centre_j) / view.pixels, y = (i - view.centre_i) / view.pixels;
        const double inverse_u = (y - a - b * x) / 1.7;
        const double u = 1 / inverse_u;
        // The mesh's outline is ragged: judge only what is well inside, or surely outside.
        const bool inside = inverse_u > 0 && u > kHither && u < 7 * cell && std::abs(u * x) < 7 * cell;
        const bool outside = inverse_u < 0 || u > 9 * cell || std::abs(u * x) > 9 * cell;
        const auto pixel = static_cast<std::size_t>(i * kWidth + j);
        if (inside) {
          ASSERT_EQ(drawn.count[pixel], 1) << "round " << round << " at " << j << " " << i;
          // Exact but where the sample lies outside the unsnapped face, by at most the snap, and is clamped.
          const double per_pixel = (1 + std::abs(a) + std::abs(b)) / 1.7 / view.pixels;
          ASSERT_NEAR(drawn.inverse_u[pixel], inverse_u, per_pixel / 256 + 1e-12);
        } else if (outside) {
          ASSERT_EQ(drawn.count[pixel], 0) << "round " << round << " at " << j << " " << i;
        }
      }
    }
  }
}

// Random triangles through, before and behind the eye, against the homogeneous edge functions.
TEST(Pretiler, clipping_covers_what_the_unclipped_triangle_covers) {
  const ViewTransform view = smallView();
  EXPECT_TRUE(rc::check([&] {
    const auto metres = [](int limit) { return *rc::gen::inRange(-limit * 100, limit * 100) / 100.0; };
    const int near = *rc::gen::element(1, 20, 500);
    const std::vector<Vector3> p = {inView(view, metres(near), metres(40), metres(30)),
                                    inView(view, metres(40), metres(40), metres(30)),
                                    inView(view, metres(40), metres(40), metres(30))};
    const double volume = dot(p[0], cross(p[1], p[2]));
    if (std::abs(volume) < 1e-3) return;
    const Drawn drawn = drawAll(view, p, {{0, 1, 2}});
    for (int i = 0; i < kHeight; ++i) {
      for (int j = 0; j < kWidth; ++j) {
        const Vector3 ray{1, j - view.centre_j, i - view.centre_i};
        const Vector3 normals[3] = {cross(p[1], p[2]), cross(p[2], p[0]), cross(p[0], p[1])};
        double least = 1e300, inverse_u = 0;
        for (const Vector3& normal : normals) {
          // Signed distance, in pixels, from the edge's line on the screen.
          const double side = dot(normal, ray) / std::hypot(normal.y, normal.z) * (volume > 0 ? 1 : -1);
          least = std::min(least, side);
          inverse_u += dot(normal, ray) / volume;
        }
        const bool near_hither = std::abs(inverse_u * kHither - 1) < 1e-2;
        if (std::abs(least) < 1.0 / 128 || near_hither) continue;
        const bool covered = least > 0 && inverse_u > 0 && inverse_u < 1 / kHither;
        RC_ASSERT((drawn.count[static_cast<std::size_t>(i * kWidth + j)] > 0) == covered);
      }
    }
  }));
}

TEST(Pretiler, counts_what_is_outside_and_what_falls_between_samples) {
  const ViewTransform view = smallView();
  const std::vector<Vector3> position = {inView(view, 100, 500, 0),  inView(view, 100, 600, 0),
                                         inView(view, 100, 500, 90),  // beside the picture
                                         inView(view, -5, 0, 0),     inView(view, -5, 1, 0),
                                         inView(view, -5, 0, 1),  // behind the eye
                                         inView(view, 1e5, 100, 0),  inView(view, 1e5, 120, 0),
                                         inView(view, 1e5, 100, 20),  // smaller than a pixel
                                         inView(view, 10, -1, -1),   inView(view, 10, 1, -1),
                                         inView(view, 10, 0, 1)};  // in the middle
  const Drawn drawn = drawAll(view, position, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}});
  EXPECT_EQ(drawn.node.clipped, 2u);
  EXPECT_EQ(drawn.node.no_sample, 1u);
  EXPECT_EQ(drawn.kept, std::set<std::uint32_t>{3});
}

// Gradients come from the unsnapped vertices: the planes give back the vertices' own values.
TEST(Pretiler, planes_reproduce_the_vertices) {
  const ViewTransform view = smallView();
  EXPECT_TRUE(rc::check([&] {
    const auto at = [&](int low, int high) { return *rc::gen::inRange(low * 1000, high * 1000) / 1000.0; };
    const std::vector<Vector3> p = {inView(view, at(20, 90), at(-30, 30), at(-20, 20)),
                                    inView(view, at(20, 90), at(-30, 30), at(-20, 20)),
                                    inView(view, at(20, 90), at(-30, 30), at(-20, 20))};
    const Drawn drawn = drawAll(view, p, {{0, 1, 2}});
    if (drawn.kept.empty()) return;
    const FacePlanes face = facePlanes(view, drawn.node, 0);
    if (std::abs(face.inverse_u.per_j) + std::abs(face.inverse_u.per_i) > 1) return;
    for (const Vector3& vertex : p) {
      const ScreenVertex screen = project(view, vertex);
      RC_ASSERT(std::abs(face.inverse_u.at(screen.j - face.anchor_j, screen.i - face.anchor_i) * vertex.x -
                         1) < 1e-7);
      RC_ASSERT(screen.inverse_u >= face.least && screen.inverse_u <= face.greatest);
    }
  }));
}

TEST(Pretiler, depth_of_a_sliver_stays_within_its_vertices) {
  const ViewTransform view = smallView();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> across(-40, 40), thin(-1e-3, 1e-3), deep(10, 2000);
  for (int round = 0; round < 3000; ++round) {
    std::vector<Vector3> p;
    const double x0 = across(random), x1 = across(random), y0 = across(random), y1 = across(random);
    for (const double t : {0.0, 0.4, 1.0}) {
      const double u = deep(random);
      const double j = x0 + (x1 - x0) * t + thin(random), i = y0 + (y1 - y0) * t + thin(random);
      p.push_back({u, j * u, i * u});
    }
    const Drawn drawn = drawAll(view, p, {{0, 1, 2}});
    for (std::size_t pixel = 0; pixel < drawn.count.size(); ++pixel) {
      if (drawn.count[pixel] == 0) continue;
      ASSERT_GE(1 / drawn.inverse_u[pixel], std::min({p[0].x, p[1].x, p[2].x}) * (1 - 1e-12));
      ASSERT_LE(1 / drawn.inverse_u[pixel], std::max({p[0].x, p[1].x, p[2].x}) * (1 + 1e-12));
    }
  }
}

}  // namespace
}  // namespace deltaz
