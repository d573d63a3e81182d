#include "librender/objects/model_object_processor.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "libdb/access/model.h"
#include "librender/objects/terrain_object_processor.h"

namespace deltaz {
namespace {

constexpr double kLatitude = 46.8, kLongitude = -121.7, kHeight = 1500;

ViewTransform viewAt(double latitude, double longitude, double height, double heading, double pitch) {
  Camera camera;
  camera.eye = {latitude, longitude, height};
  camera.heading = heading;
  camera.pitch = pitch;
  camera.width = 320;
  camera.height = 200;
  return makeViewTransform(camera, EllipsoidShape{});
}

Light lightFrom(const Vector3& direction) {
  Light light;
  light.to_sun = normalized(direction);
  return light;
}

Vector3 rowOf(const ModelTransform& m, std::size_t row) {
  return {m[3 * row], m[3 * row + 1], m[3 * row + 2]};
}

Vector3 linear(const ModelTransform& m, const Vector3& p) {
  return rowOf(m, 0) * p.x + rowOf(m, 1) * p.y + rowOf(m, 2) * p.z;
}

// Part's space -> Earth-centred near the place, turned at random.
class RandomPlaces {
 public:
  double unit() { return uniform_(random_); }
  Vector3 vector() { return {unit(), unit(), unit()}; }
  ModelTransform place(const Vector3& scale) {
    const Vector3 x = normalized(vector()), y = normalized(cross(x, vector())), z = cross(x, y);
    const ModelTransform turn = {x.x * scale.x, x.y * scale.x, x.z * scale.x, y.x * scale.y,
                                 y.y * scale.y, y.z * scale.y, z.x * scale.z, z.y * scale.z,
                                 z.z * scale.z, 5 * unit(),    5 * unit(),    5 * unit()};
    Placement placement;
    placement.latitude = kLatitude;
    placement.longitude = kLongitude;
    placement.height = kHeight;
    return concatenate(turn, placementTransform(placement, {0, 0, 0}, EllipsoidShape{}));
  }
  // Triangles that share no vertex, with normals and colours.
  ModelMesh soup(bool curve_shaded, bool colored_by_vertex, bool two_sided) {
    ModelMesh mesh;
    mesh.two_sided = two_sided;
    mesh.colored_by_vertex = colored_by_vertex;
    for (std::uint32_t t = 0; t < 40; ++t) {
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
      if (!colored_by_vertex) mesh.colors.push_back(color());
      for (int k = 0; k < 3; ++k) {
        const Vector3 p = vector() * 4;
        mesh.vertices.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        if (colored_by_vertex) mesh.colors.push_back(color());
        if (!curve_shaded) continue;
        const Vector3 n = normalized(vector()) * kModelNormalScale;
        mesh.normals.push_back({static_cast<std::int16_t>(std::lrint(n.x)),
                                static_cast<std::int16_t>(std::lrint(n.y)),
                                static_cast<std::int16_t>(std::lrint(n.z))});
      }
    }
    return mesh;
  }

 private:
  std::array<std::uint8_t, 3> color() {
    return {static_cast<std::uint8_t>(random_() % 256), static_cast<std::uint8_t>(random_() % 256),
            static_cast<std::uint8_t>(random_() % 256)};
  }
  std::mt19937 random_{5};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

template <typename T>
Vector3 toVector(const std::array<T, 3>& a) {
  return {static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
}

// Earth-centred normal of a surface whose normal in the part's space is n: across two directions in it.
Vector3 earthNormal(const ModelTransform& m, const Vector3& n) {
  const Vector3 first = cross(n, std::abs(n.x) < 0.5 * length(n) ? Vector3{1, 0, 0} : Vector3{0, 1, 0});
  const Vector3 second = cross(n, first);
  const double sign = dot(cross(rowOf(m, 0), rowOf(m, 1)), rowOf(m, 2)) < 0 ? -1 : 1;
  return normalized(cross(linear(m, first), linear(m, second))) * sign;
}

// Rotations with equal scales, mirrored, and with unequal scales.
const Vector3 kScales[] = {{1, 1, 1},    {0.01, 0.01, 0.01}, {-1, 1, 1},  {2.5, -2.5, 2.5},
                           {-3, -3, -3}, {1, 1, 4},          {0.2, 3, -1}};

TEST(ModelObjectProcessor, light_in_the_parts_space_is_light_in_earth_centred_axes) {
  RandomPlaces random;
  const ViewTransform view = viewAt(kLatitude - 2e-4, kLongitude, kHeight, 0, 0);
  std::uint64_t faces_seen = 0;
  for (const Vector3& scale : kScales) {
    for (const bool curve_shaded : {false, true}) {
      for (const bool colored_by_vertex : {false, true}) {
        for (const bool two_sided : {false, true}) {
          const ModelMesh mesh = random.soup(curve_shaded, colored_by_vertex, two_sided);
          const ModelTransform m = random.place(scale);
          const Light light = lightFrom(random.vector());
          for (const ModelFace& face : modelFaces(mesh, m, view, light).front) {
            ++faces_seen;
            const auto& corners = mesh.triangles[face.identity];
            const Vector3 a = toVector(mesh.vertices[corners[0]]);
            const Vector3 across =
                cross(toVector(mesh.vertices[corners[1]]) - a, toVector(mesh.vertices[corners[2]]) - a);
            const Vector3 outwards = earthNormal(m, across);
            const bool behind = dot(outwards, view.eye - transformPoint(m, a)) < 0;
            for (std::size_t k = 0; k < 3; ++k) {
              const Vector3 normal =
                  curve_shaded ? earthNormal(m, toVector(mesh.normals[face.vertex[k]])) : outwards;
              const double intensity = light.intensity(behind ? normal * -1 : normal);
              const auto& code = mesh.colors[colored_by_vertex ? face.vertex[k] : face.identity];
              EXPECT_NEAR(face.color[k].red, decodeSrgb(code[0]) * intensity, 1e-7);
              EXPECT_NEAR(face.color[k].green, decodeSrgb(code[1]) * intensity, 1e-7);
              EXPECT_NEAR(face.color[k].blue, decodeSrgb(code[2]) * intensity, 1e-7);
            }
          }
        }
      }
    }
  }
  EXPECT_GT(faces_seen, 1000u);
}

TEST(ModelObjectProcessor, back_faces_of_the_parts_space_are_those_of_view_space) {
  RandomPlaces random;
  const ViewTransform view = viewAt(kLatitude - 2e-4, kLongitude, kHeight, 0, 0);
  for (const Vector3& scale : kScales) {
    const bool mirrored = scale.x * scale.y * scale.z < 0;
    const ModelTransform m = random.place(scale);
    ModelMesh mesh = random.soup(false, false, false);
    const ModelFaces one_sided = modelFaces(mesh, m, view, Light{});
    EXPECT_EQ(one_sided.in, mesh.triangles.size());
    EXPECT_EQ(one_sided.in, one_sided.back_facing + one_sided.front.size());
    std::vector<std::uint32_t> front;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const auto& p = one_sided.position;
      if (mirrored != !isBackFacing(p[a], p[b], p[c])) front.push_back(t);
    }
    ASSERT_EQ(one_sided.front.size(), front.size());
    EXPECT_GT(front.size(), 5u);
    EXPECT_LT(front.size(), 35u);
    for (std::size_t f = 0; f < front.size(); ++f) EXPECT_EQ(one_sided.front[f].identity, front[f]);

    mesh.two_sided = true;
    const ModelFaces two_sided = modelFaces(mesh, m, view, Light{});
    EXPECT_EQ(two_sided.front.size(), mesh.triangles.size());
    for (const ModelFaces& faces : {one_sided, two_sided}) {
      for (const ModelFace& face : faces.front) {
        EXPECT_FALSE(isBackFacing(faces.position[face.vertex[0]], faces.position[face.vertex[1]],
                                  faces.position[face.vertex[2]]));
      }
    }
  }
}

TEST(ModelObjectProcessor, faces_of_no_extent_are_not_drawn) {
  ModelMesh mesh;
  mesh.two_sided = true;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 1}};
  mesh.colors = {{1, 2, 3}, {1, 2, 3}};
  RandomPlaces random;
  const ModelFaces faces =
      modelFaces(mesh, random.place({1, 1, 1}), viewAt(kLatitude - 2e-4, kLongitude, kHeight, 0, 0), Light{});
  EXPECT_EQ(faces.front.size(), 0u);
  EXPECT_EQ(faces.back_facing, 2u);
}

// A point of a mast stands over its foot as GeographicLib says, to a thousandth of a millimetre of what is
// promised, however near the eye it is.
TEST(ModelObjectProcessor, a_model_near_the_eye_is_right_to_a_millimetre) {
  for (const auto& [latitude, longitude] : {std::pair{46.8, -121.7}, {89.9999, 10.0}, {-17.0, 179.99999}}) {
    const double eye_latitude = latitude - 10 / 111150.0;
    const ViewTransform view = viewAt(eye_latitude, longitude, kHeight + 2, 0, 0);
    Placement placement;
    placement.latitude = latitude;
    placement.longitude = longitude;
    placement.height = kHeight;
    placement.heading = 77;
    ModelMesh mast;
    mast.vertices = {{0, 0, 0}, {0, 0, 1.5F}, {0, 0, 30}};
    mast.triangles = {{0, 1, 2}};
    mast.colors = {{1, 2, 3}};
    const ModelFaces faces =
        modelFaces(mast, placementTransform(placement, {0, 0, 0}, EllipsoidShape{}), view, Light{});
    for (std::size_t v = 0; v < 3; ++v) {
      const Vector3 exact = toEarthCentred(
          EllipsoidShape{}, {latitude, longitude, kHeight + static_cast<double>(mast.vertices[v][2])});
      const Vector3 p = faces.position[v];
      const Vector3 metres{p.x, p.y / view.pixels, p.z / view.pixels};
      const Vector3 d = exact - view.eye;
      EXPECT_LT(length(metres - Vector3{dot(view.forward, d), dot(view.right, d), dot(view.down, d)}), 1e-6);
    }
  }
}

}  // namespace
}  // namespace deltaz
