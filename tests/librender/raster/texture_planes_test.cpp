#include "librender/raster/texture_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "librender/scene/view_volume.h"

#include "binned_triangles.h"

namespace deltaz {
namespace {

constexpr double kRelative = 1e-12;

// Report 6.4: texture coordinates are an orthographic image of space, (X, Y, Z) R, and view space is (X, Y,
// Z) S. So they are (U, V, W, 1) T with T = S^-1 R; this is one column of T.
struct MappingColumn {
  Vector3 r;  // of R
  double shift = 0;
  double t1 = 0, t2 = 0, t3 = 0, t4 = 0;

  MappingColumn(const ViewTransform& view, const Vector3& of_r, double shifted) : r(of_r), shift(shifted) {
    t1 = dot(r, view.forward);
    t2 = dot(r, view.right) / view.pixels;
    t3 = dot(r, view.down) / view.pixels;
    t4 = dot(r, view.eye) + shift;
  }
  double at(const Vector3& p) const { return dot(r, p) + shift; }
};

// The report's constants of one coordinate: i_m0, i_mi, i_mj and the i_m and derivatives that follow.
struct Expected {
  Expected(const MappingColumn& t, double t4, const FacePlanes& face, const ViewTransform& view) {
    const ScreenPlane& d = face.inverse_u;
    const double across = face.anchor_j - view.centre_j, downward = face.anchor_i - view.centre_i;
    value = t.t1 + t.t2 * across + t.t3 * downward + t4 * d.value;
    scale = std::abs(t.t1) + std::abs(t.t2 * across) + std::abs(t.t3 * downward) + std::abs(t4 * d.value);
    per_j = t.t2 + t4 * d.per_j;
    per_i = t.t3 + t4 * d.per_i;
    gradient_scale = std::abs(t.t2) + std::abs(t.t3) + std::abs(t4 * d.per_j) + std::abs(t4 * d.per_i);
  }
  double value, per_j, per_i, scale, gradient_scale;
};

void expectPlane(const ScreenPlane& plane, const Expected& expected) {
  EXPECT_NEAR(plane.value, expected.value, kRelative * expected.scale);
  EXPECT_NEAR(plane.per_j, expected.per_j, kRelative * expected.gradient_scale);
  EXPECT_NEAR(plane.per_i, expected.per_i, kRelative * expected.gradient_scale);
}

class TexturePlanesOfFaces : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  static Camera camera() {
    Camera result;
    result.eye = {46.2, 7.1, 2500};
    result.heading = 37;
    result.pitch = -24;
    result.roll = 11;
    result.width = 800;
    result.height = 600;
    return result;
  }
  double random(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator_);
  }

  // A front face with its corners near the picture's, at random distances, mapped at random.
  void make() {
    view_ = makeViewTransform(camera(), EllipsoidShape{});
    // The eye is the origin of this space, as the centre of the Earth is too far away for twelve digits.
    view_.eye = {random(-3000, 3000), random(-3000, 3000), random(-3000, 3000)};
    const auto vector = [&] { return Vector3{random(-1, 1), random(-1, 1), random(-1, 1)} * 0.03; };
    columns_.emplace_back(view_, vector(), random(-50, 50));
    columns_.emplace_back(view_, vector(), random(-50, 50));
    const std::array<std::array<double, 2>, 3> corners{{{40, 560}, {760, 520}, {420, 30}}};
    vertices_ = {};
    for (const auto& corner : corners) {
      const double u = random(50, 4000);
      const double j = corner[0] + random(-40, 40), i = corner[1] + random(-25, 25);
      const Vector3 p = view_.eye + view_.ray(j, i) * u;
      vertices_.append({view_.toView(p), {}, 1, {columns_[0].at(p), columns_[1].at(p)}});
    }
    TerrainFaces faces;
    addFace(faces, vertices_.position, {{0, 1, 2}, 0});
    ASSERT_EQ(faces.front.size(), 1u);
    node_ = PretiledNode::ofTerrain(0, 1, vertices_, faces.front);
    bins_.reset(view_.width, view_.height, 1);
    bins_.writer(0).begin(0);
    Pretiler(view_).process(node_, 0, bins_.writer(0));
    bins_.finish();
    face_ = facePlanes(view_, node_, 0);
  }

  std::mt19937 generator_{GetParam()};
  ViewTransform view_;
  std::vector<MappingColumn> columns_;
  TerrainVertices vertices_;
  PretiledNode node_;
  TileBins bins_;
  FacePlanes face_;
};

TEST_P(TexturePlanesOfFaces, are_those_of_the_reports_mapping_matrix) {
  make();
  const FacePlanes& face = face_;
  const TexturePlanes planes = texturePlanes(face);
  EXPECT_EQ(planes.origin.column, vertices_.texture(0).column);
  EXPECT_EQ(planes.origin.row, vertices_.texture(0).row);
  expectPlane(planes.column, Expected(columns_[0], columns_[0].t4 - planes.origin.column, face, view_));
  expectPlane(planes.row, Expected(columns_[1], columns_[1].t4 - planes.origin.row, face, view_));
}

TEST_P(TexturePlanesOfFaces, lead_to_the_place_that_is_seen_and_to_its_derivatives) {
  make();
  const FacePlanes& face = face_;
  int seen = 0;
  const auto visit_sample = [&](std::int32_t j, std::int32_t i) {
    if ((j + i) % 97 != 0) return;
    ++seen;
    const double d = face.inverseDepthAt(j, i);
    const TextureFootprint footprint = footprintAt(face, j, i, d);
    const Vector3 p = view_.eye + view_.ray(j, i) * (1 / d);
    const auto expect = [&](const MappingColumn& t, double origin, double place, double per_j, double per_i) {
      const Expected at(t, t.t4 - origin, face, view_);
      EXPECT_NEAR(place, t.at(p), 10 * kRelative * (std::abs(t.at(p)) + at.scale / d));
      const double scale = at.gradient_scale / d;
      EXPECT_NEAR(per_j, (at.per_j - (t.at(p) - origin) * face.inverse_u.per_j) / d,
                  10 * kRelative * (scale + std::abs(per_j)));
      EXPECT_NEAR(per_i, (at.per_i - (t.at(p) - origin) * face.inverse_u.per_i) / d,
                  10 * kRelative * (scale + std::abs(per_i)));
    };
    const GridCoordinates origin = vertices_.texture(0);
    expect(columns_[0], origin.column, footprint.place.column, footprint.per_j.column,
           footprint.per_i.column);
    expect(columns_[1], origin.row, footprint.place.row, footprint.per_j.row, footprint.per_i.row);
  };
  forEachBinnedTriangle(bins_, view_.width, view_.height,
                        [&](const RasterTriangle&, const SnappedTriangle& triangle,
                            const SampleBounds& pixels) { forEachSample(triangle, pixels, visit_sample); });
  EXPECT_GT(seen, 100);
}

INSTANTIATE_TEST_SUITE_P(Random, TexturePlanesOfFaces, ::testing::Range(1u, 21u));

TEST(TextureFootprint, size_is_the_larger_of_its_two_steps) {
  TextureFootprint footprint;
  footprint.per_j = {3, 4};
  footprint.per_i = {-1, 2};
  EXPECT_DOUBLE_EQ(footprint.size(), 5);
  footprint.per_i = {0, -6};
  EXPECT_DOUBLE_EQ(footprint.size(), 6);
}

TEST(TextureFootprint, stays_within_the_face) {
  FacePlanes face;
  face.anchor_j = 10;
  face.anchor_i = 20;
  face.inverse_u = {0.01, 0, 0};
  face.weight1 = {0, 0.01, 0};
  face.weight2 = {0, 0, 0.01};
  face.texture = {1000, 2000};
  face.texture_steps = {{{2, 0}, {0, 3}}};
  const TextureFootprint inside = footprintAt(face, 10, 20, 0.01);
  EXPECT_DOUBLE_EQ(inside.place.column, 1000);
  EXPECT_DOUBLE_EQ(inside.place.row, 2000);
  const TextureFootprint outside = footprintAt(face, 13, 14, 0.01);
  EXPECT_DOUBLE_EQ(outside.place.column, 1002);
  EXPECT_DOUBLE_EQ(outside.place.row, 2000);
  EXPECT_DOUBLE_EQ(outside.per_j.column, 2);
  EXPECT_DOUBLE_EQ(outside.per_i.row, 3);
}

}  // namespace
}  // namespace deltaz
