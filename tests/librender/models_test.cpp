#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>

#include "libdb/access/ground_query.h"
#include "libdb/access/model.h"
#include "librender/scene/view_volume.h"
#include "tests/librender/test_databases.h"
#include "tests/support/model_fixture.h"

namespace deltaz {
namespace {

constexpr double kPi = std::numbers::pi;

// Around the origin; every triangle of another colour.
ModelMesh box(float width, float depth, float height) {
  ModelMesh mesh;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1) != 0 ? width / 2 : -width / 2,
                             (corner & 2) != 0 ? depth / 2 : -depth / 2,
                             (corner & 4) != 0 ? height / 2 : -height / 2});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (std::uint8_t t = 0; t < 12; ++t) {
    mesh.colors.push_back({static_cast<std::uint8_t>(60 + 15 * t), static_cast<std::uint8_t>(220 - 12 * t),
                           static_cast<std::uint8_t>(90 + 40 * (t % 4))});
  }
  return mesh;
}

// Curve-shaded, coloured by its vertices, centred beside the origin so that a mirror shows.
ModelMesh ball(double radius, std::uint32_t rows, std::uint32_t columns) {
  ModelMesh mesh;
  mesh.colored_by_vertex = true;
  for (std::uint32_t row = 0; row <= rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const double polar = kPi * row / rows, around = 2 * kPi * column / columns;
      const double x = std::sin(polar) * std::cos(around), y = std::sin(polar) * std::sin(around);
      const double z = std::cos(polar);
      mesh.vertices.push_back({static_cast<float>(radius * x + 0.5), static_cast<float>(radius * y),
                               static_cast<float>(radius * z)});
      mesh.normals.push_back({static_cast<std::int16_t>(std::lrint(x * kModelNormalScale)),
                              static_cast<std::int16_t>(std::lrint(y * kModelNormalScale)),
                              static_cast<std::int16_t>(std::lrint(z * kModelNormalScale))});
      mesh.colors.push_back({static_cast<std::uint8_t>(128 + 100 * x),
                             static_cast<std::uint8_t>(128 + 100 * y),
                             static_cast<std::uint8_t>(128 + 100 * z)});
      if (row == rows) continue;
      const std::uint32_t next = (column + 1) % columns;
      const std::uint32_t a = row * columns + column, b = row * columns + next, c = a + columns,
                          d = b + columns;
      if (row > 0) mesh.triangles.push_back({a, c, b});
      if (row + 1 < rows) mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

// How far a ball's facets lie inside the sphere.
double sagOf(double radius, std::uint32_t rows, std::uint32_t columns) {
  return radius * (1 - std::cos(std::hypot(kPi / (2.0 * rows), kPi / columns)));
}

FinishedPart ballPart(const std::string& name, double radius) {
  FinishedPart part;
  part.name = name;
  const std::uint32_t sizes[][2] = {{24, 48}, {12, 24}, {6, 12}, {4, 8}};
  for (const auto& [rows, columns] : sizes) {
    // Both meshes lie between the sphere and their own sags.
    const double error = part.lods.empty() ? 0 : sagOf(radius, 24, 48) + sagOf(radius, rows, columns);
    part.lods.push_back({ball(radius, rows, columns), static_cast<float>(error * 1.001)});
  }
  return part;
}

// A sheet that is bent like a leaf, seen from both sides.
ModelMesh leaf(bool curve_shaded) {
  constexpr std::uint32_t kCells = 6;
  ModelMesh mesh;
  mesh.two_sided = true;
  for (std::uint32_t j = 0; j <= kCells; ++j) {
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const double x = i * (4.0 / kCells) - 2, y = j * (6.0 / kCells) - 3;
      const Vector3 normal = normalized({0.4 * x, 0.2 * y, 1});
      mesh.vertices.push_back(
          {static_cast<float>(x), static_cast<float>(y), static_cast<float>(-0.2 * x * x - 0.1 * y * y)});
      if (curve_shaded) {
        mesh.normals.push_back({static_cast<std::int16_t>(std::lrint(normal.x * kModelNormalScale)),
                                static_cast<std::int16_t>(std::lrint(normal.y * kModelNormalScale)),
                                static_cast<std::int16_t>(std::lrint(normal.z * kModelNormalScale))});
      }
      if (i == kCells || j == kCells) continue;
      const std::uint32_t a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    mesh.colors.push_back({70, static_cast<std::uint8_t>(120 + t), 40});
  return mesh;
}

ModelTransform movedTo(double x, double y, double z) {
  return {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z};
}

ModelTransform aboutX(double degrees) {
  const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
  return {1, 0, 0, 0, c, s, 0, -s, c, 0, 0, 0};
}

ModelTransform scaled(double x, double y, double z) {
  return {x, 0, 0, 0, y, 0, 0, 0, z, 0, 0, 0};
}

// A box, on it a mirrored ball on an arm that shows nothing itself, leaves on the ball, and a box stretched
// and mirrored.
FinishedModel machine() {
  FinishedPart body, arm, head, first_leaf, second_leaf, fin;
  body.name = "body";
  body.lods.push_back({box(6, 4, 2), 0});
  arm.name = "arm";
  arm.parent = 0;
  arm.transform = concatenate(aboutX(25), movedTo(1, 0.5, 2));
  head = ballPart("head", 1.2);
  head.parent = 1;
  head.transform = concatenate(scaled(-1.5, 1.5, 1.5), movedTo(0.4, 0, 1.5));
  first_leaf.name = "first leaf";
  first_leaf.parent = 2;
  first_leaf.transform = concatenate(concatenate(scaled(0.5, 0.5, 0.5), aboutX(70)), movedTo(1.8, 0, 0.6));
  first_leaf.lods.push_back({leaf(false), 0});
  second_leaf.name = "second leaf";
  second_leaf.parent = 0;
  second_leaf.transform = concatenate(aboutX(-100), movedTo(-3.5, 2, 1));
  second_leaf.lods.push_back({leaf(true), 0});
  fin.name = "fin";
  fin.parent = 0;
  fin.transform = concatenate(scaled(0.1, 3, -1.5), movedTo(0, -4, 0.5));
  fin.lods.push_back({box(2, 1, 2), 0});
  return {{body, arm, head, first_leaf, second_leaf, fin}, {0, 0, 0}};
}

FinishedModel globe() {
  FinishedPart part = ballPart("globe", 5);
  part.transform = movedTo(-0.5, 0, 0);
  return {{part}, {0, 0, 0}};
}

struct Scene {
  MemoryDatabase area;
  double latitude = 46.85, longitude = -121.75, ground = 0;  // of the middle

  const Database& database() const { return area.database; }
};

// Metres to degrees near the scene.
double northwards(double metres) {
  return metres / 111170;
}
double eastwards(double metres) {
  return metres / (111320 * std::cos(46.85 * kPi / 180));
}

// One machine in the middle, others around it, some half in the ground, a tower and a globe.
Scene makeScene() {
  Scene scene{makeDatabase(smallArea())};
  MemoryFileSystem& files = scene.area.files;
  const auto put = [&](const std::string& name, const FinishedModel& model) {
    const AssetHeader header{name, "mesh", {{name + ".obj", hash128({})}}, {}};
    const Status status = putModel(files, kMemoryDatabasePath, header, model, false);
    if (!status.ok()) throw std::runtime_error(status.error().message());
  };
  put("machine", machine());
  put("globe", globe());
  addFixtureModel(files, kMemoryDatabasePath);
  const auto groundAt = [&](double latitude, double longitude) {
    return groundHeight(scene.area.database, latitude, longitude).value().value();
  };
  scene.ground = groundAt(scene.latitude, scene.longitude);
  std::vector<Placement> placements;
  const auto place = [&](std::uint32_t model, double east, double north, double above, double heading) {
    const double latitude = scene.latitude + northwards(north), longitude = scene.longitude + eastwards(east);
    placements.push_back(placementAt(latitude, longitude, groundAt(latitude, longitude) + above, heading));
    placements.back().model = model;
  };
  place(0, 0, 0, 1, 0);
  place(1, 30, 10, 1, 70);
  place(2, -25, 15, 0, 30);
  for (int k = 0; k < 12; ++k)
    place(static_cast<std::uint32_t>(k % 3), 60 * std::sin(k * 0.53), 60 * std::cos(k * 0.53), 0.5, 29 * k);
  setPlacements(files, kMemoryDatabasePath, placements);
  Result<Database> reopened = Database::open(files, kMemoryDatabasePath);
  if (!reopened.ok()) throw std::runtime_error(reopened.error().message());
  scene.area.database = std::move(reopened).value();
  return scene;
}

// From a place relative to the middle of the scene, metres, towards another.
RenderOptions lookingFrom(const Scene& scene, const Vector3& eye, const Vector3& at, double fov = 60) {
  RenderOptions options;
  Camera& camera = options.camera;
  camera.eye = {scene.latitude + northwards(eye.y), scene.longitude + eastwards(eye.x), scene.ground + eye.z};
  const Vector3 d = at - eye;
  camera.heading = std::atan2(d.x, d.y) * 180 / kPi;
  camera.pitch = std::atan2(d.z, std::hypot(d.x, d.y)) * 180 / kPi;
  camera.field_of_view = fov;
  camera.width = 240;
  camera.height = 180;
  options.tolerance = 0;
  options.keep_triangle_ids = true;
  return options;
}

std::uint64_t differing(const Picture& a, const Picture& b) {
  std::uint64_t count = 0;
  for (std::size_t pixel = 0; pixel < a.surface.size(); ++pixel) {
    int largest = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      largest = std::max(largest, std::abs(a.rgb[3 * pixel + channel] - b.rgb[3 * pixel + channel]));
    count += largest > 2;
  }
  return count;
}

std::uint64_t modelPixels(const Picture& picture) {
  return static_cast<std::uint64_t>(
      std::count(picture.surface.begin(), picture.surface.end(), Surface::kModel));
}

// Draws with both engines; returns how many pixels show a model.
std::uint64_t expectSame(const Scene& scene, const RenderOptions& options) {
  const Picture fast = draw(EngineKind::kFast, scene.database(), options);
  const Picture reference = draw(EngineKind::kReference, scene.database(), options);
  EXPECT_LE(static_cast<double>(differing(fast, reference)),
            0.001 * static_cast<double>(fast.surface.size()));
  // Where both show the same triangle, they show it at the same depth.
  for (std::size_t pixel = 0; pixel < fast.surface.size(); ++pixel) {
    if (fast.surface[pixel] != Surface::kModel || fast.triangle[pixel] != reference.triangle[pixel]) continue;
    EXPECT_EQ(reference.surface[pixel], Surface::kModel);
    EXPECT_NEAR(static_cast<double>(fast.depth[pixel]), static_cast<double>(reference.depth[pixel]),
                1e-4 + 2e-3 * static_cast<double>(reference.depth[pixel]));
  }
  return modelPixels(reference);
}

// The Earth-centred point a pixel shows.
Vector3 pointAt(const ViewTransform& view, const Picture& picture, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(picture.width);
  return view.eye + view.ray(static_cast<double>(pixel % width), static_cast<double>(pixel / width)) *
                        static_cast<double>(picture.depth[pixel]);
}

TEST(Models, fast_engine_agrees_with_the_reference) {
  const Scene scene = makeScene();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::uint64_t seen = 0;
  for (int round = 0; round < 30; ++round) {
    const double distance = 5 * std::pow(60, (unit(random) + 1) / 2), around = kPi * unit(random);
    const Vector3 eye{distance * std::sin(around), distance * std::cos(around),
                      3 + distance * 0.5 * (unit(random) + 1)};
    RenderOptions options = lookingFrom(scene, eye, {3 * unit(random), 3 * unit(random), 1});
    options.sun = {180 * unit(random), 45 + 40 * unit(random)};
    seen += expectSame(scene, options);
  }
  EXPECT_GT(seen, 30u * 500);
}

// The eye beside a wall, so that it reaches through the hither plane; inside a box, which then shows nothing;
// and before and behind a leaf.
TEST(Models, fast_engine_agrees_with_the_reference_near_the_hither_plane) {
  const Scene scene = makeScene();
  EXPECT_GT(expectSame(scene, lookingFrom(scene, {3.04, -1.9, 1.3}, {3.4, 4, 1.2}, 100)), 2000u);
  EXPECT_GT(expectSame(scene, lookingFrom(scene, {3.12, 0, 1.3}, {2, 0.3, 1.2}, 80)), 20000u);
  EXPECT_GT(expectSame(scene, lookingFrom(scene, {1, 2.05, 1.2}, {-2, 1.9, 1.4}, 110)), 2000u);
  expectSame(scene, lookingFrom(scene, {0.3, 0.1, 0.9}, {8, 3, 1.2}, 90));
  for (const double side : {-0.3, 0.3})
    EXPECT_GT(expectSame(scene, lookingFrom(scene, {-3.5, 2 + side, 2}, {-3.4, 2 - side, 2.2}, 90)), 2000u);
}

// A part that has gone far, one that is large, and one that is turned over in a mirror.
TEST(Models, fast_engine_agrees_with_the_reference_in_poses) {
  const Scene scene = makeScene();
  PartPose gone, grown, mirrored;
  gone.model = "tower";
  gone.part = "head";
  gone.motion = concatenate(aboutX(40), movedTo(0, 150, 30));
  grown.model = "machine";
  grown.part = "arm";
  grown.instance = 1;
  grown.motion = scaled(4, 4, 4);
  mirrored.model = "machine";
  mirrored.part = "second leaf";
  mirrored.motion = scaled(1, -2, 1);
  for (const Vector3& eye : {Vector3{10, -60, 30}, {-40, -20, 12}, {0, 120, 60}, {70, 70, 5}}) {
    RenderOptions options = lookingFrom(scene, eye, {0, 0, 5});
    options.poses = {gone, grown, mirrored};
    EXPECT_GT(expectSame(scene, options), 100u);
    RenderOptions still = options;
    still.poses.clear();
    EXPECT_GT(differing(draw(EngineKind::kFast, scene.database(), options),
                        draw(EngineKind::kFast, scene.database(), still)),
              100u);
  }
}

// Towards where the heads have gone no tower stands by default, so spheres of towers say nothing is there.
TEST(Models, a_part_that_has_moved_into_the_picture_is_seen) {
  const Scene scene = makeScene();
  RenderOptions options = lookingFrom(scene, {0, -40, 400}, {0, -300, 450});
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference})
    EXPECT_EQ(modelPixels(draw(kind, scene.database(), options)), 0u);
  PartPose pose;
  pose.model = "globe";
  pose.part = "globe";
  pose.instance = 2;
  // Its heading is 70 degrees: 0.34 of the y axis goes north, 0.94 of the x axis south.
  pose.motion = movedTo(290 * std::sin(70 * kPi / 180), -290 * std::cos(70 * kPi / 180), 445);
  options.poses = {pose};
  EXPECT_GT(expectSame(scene, options), 20u);
}

// Every pixel of a globe lies on its sphere, before and after it has moved.
TEST(Models, a_part_moves_by_as_much_as_its_pose_says) {
  const Scene scene = makeScene();
  const std::uint32_t instance = 2;
  const PlacementSet& placements = *scene.database().placements();
  const std::vector<Placement> all = placements.all().value();
  const auto placed = std::find_if(
      all.begin(), all.end(), [&](const Placement& placement) { return placement.instance == instance; });
  ASSERT_NE(placed, all.end());
  const ModelTransform to_earth = placementTransform(*placed, {0, 0, 0}, EllipsoidShape{});
  const Vector3 motion{3, -4, 9};
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    for (const bool moved : {false, true}) {
      RenderOptions options = lookingFrom(scene, {20, -40, 25}, {30, 10, 5});
      if (moved) options.poses = {{"globe", "globe", instance, movedTo(motion.x, motion.y, motion.z)}};
      const ViewTransform view = makeViewTransform(options.camera, EllipsoidShape{});
      const Picture picture = draw(kind, scene.database(), options);
      const Vector3 centre = transformPoint(to_earth, moved ? motion : Vector3{});
      std::uint64_t seen = 0;
      for (std::size_t pixel = 0; pixel < picture.surface.size(); ++pixel) {
        if (picture.surface[pixel] != Surface::kModel || picture.triangle[pixel] >> 32 != instance) continue;
        ++seen;
        const double distance = length(pointAt(view, picture, pixel) - centre);
        EXPECT_LE(distance, 5 + 0.001);
        EXPECT_GE(distance, 5 - sagOf(5, 24, 48) - 0.001);
      }
      EXPECT_GT(seen, 500u);
    }
  }
}

// Every pixel of one picture that shows a model has one of the other near it.
void expectNear(const Picture& a, const Picture& b, int pixels) {
  for (int i = 0; i < a.height; ++i) {
    for (int j = 0; j < a.width; ++j) {
      const auto at = [&](const Picture& picture, int x, int y) {
        return picture.surface[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                               static_cast<std::size_t>(x)];
      };
      if (at(a, j, i) != Surface::kModel) continue;
      bool found = false;
      for (int y = std::max(0, i - pixels); y <= std::min(a.height - 1, i + pixels); ++y) {
        for (int x = std::max(0, j - pixels); x <= std::min(a.width - 1, j + pixels); ++x)
          found = found || at(b, x, y) == Surface::kModel;
      }
      EXPECT_TRUE(found) << j << ", " << i;
    }
  }
}

TEST(Models, levels_of_detail_displace_a_picture_by_little) {
  const Scene scene = makeScene();
  for (const double distance : {40.0, 90.0, 250.0}) {
    RenderOptions options = lookingFrom(scene, {-distance * 0.3, -distance, 10 + distance * 0.7}, {0, 0, 3});
    FrameStatistics finest_statistics, statistics;
    const Picture finest = draw(EngineKind::kFast, scene.database(), options, finest_statistics);
    // The terrain stays as it is.
    options.tolerance = 1;
    const Picture picture = draw(EngineKind::kFast, scene.database(), options, statistics);
    EXPECT_LE(statistics.projected_error, 1);
    EXPECT_LT(statistics.triangles.in, finest_statistics.triangles.in);
    ASSERT_GT(modelPixels(finest), 100u);
    expectNear(finest, picture, 3);
    expectNear(picture, finest, 3);
  }
}

TEST(Models, statistics_count_models_and_their_triangles) {
  const Scene scene = makeScene();
  RenderOptions options = lookingFrom(scene, {0, -30, 6}, {0, 0, 2});
  FrameStatistics with, without;
  draw(EngineKind::kFast, scene.database(), options, with);
  EXPECT_EQ(with.models.visited, 15u);
  EXPECT_GT(with.models.drawn, 1u);
  EXPECT_GT(with.models.out_of_view, 1u);
  EXPECT_EQ(with.models.visited, with.models.drawn + with.models.out_of_view + with.models.occluded);
  EXPECT_EQ(with.triangles.in, with.triangles.back_facing + with.triangles.clipped +
                                   with.triangles.no_sample + with.triangles.drawn);
  const MemoryDatabase bare = makeDatabase(smallArea());
  draw(EngineKind::kFast, bare.database, options, without);
  EXPECT_EQ(without.models.visited, 0u);
  EXPECT_GT(with.triangles.in, without.triangles.in + 1000);
  EXPECT_GT(with.bytes_read, without.bytes_read);
}

TEST(Models, a_mesh_is_read_once_however_many_instances_show_it) {
  const Scene scene = makeScene();
  const RenderOptions options = lookingFrom(scene, {0, -200, 150}, {0, 0, 2});
  const auto bytes = [&] {
    std::uint64_t sum = 0;
    for (const Model& model : scene.database().models()) sum += model.file().bytesRead();
    return sum;
  };
  const auto read_each = [&] {
    for (const Model& model : scene.database().models()) {
      for (const ModelPart& part : model.tree().parts) {
        if (part.lods.empty()) continue;
        EXPECT_TRUE(model.mesh(part.lods.front()).ok());
      }
    }
  };
  // Pages of the files' indexes are read once and kept; meshes are not.
  read_each();
  const std::uint64_t before = bytes();
  FrameStatistics statistics;
  draw(EngineKind::kFast, scene.database(), options, statistics);
  const std::uint64_t after = bytes();
  EXPECT_EQ(statistics.models.drawn, 15u);
  read_each();
  EXPECT_GT(after, before);
  EXPECT_EQ(after - before, bytes() - after);
}

TEST(Models, picture_does_not_depend_on_the_number_of_threads) {
  const Scene scene = makeScene();
  RenderOptions options = lookingFrom(scene, {12, -25, 9}, {0, 0, 2});
  options.tolerance = 1;
  options.threads = 1;
  for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
    options.threads = 1;
    const Picture first = draw(kind, scene.database(), options);
    options.threads = 2;
    const Picture second = draw(kind, scene.database(), options);
    EXPECT_GT(modelPixels(first), 500u);
    EXPECT_EQ(first.rgb, second.rgb);
    EXPECT_EQ(first.depth, second.depth);
    EXPECT_EQ(first.triangle, second.triangle);
  }
}

TEST(Models, poses_of_what_is_not_there_are_refused_with_near_names) {
  const Scene scene = makeScene();
  RenderOptions options = lookingFrom(scene, {12, -25, 9}, {0, 0, 2});
  const auto expectRefused = [&](const PartPose& pose, const std::string& words) {
    options.poses = {pose};
    for (const EngineKind kind : {EngineKind::kFast, EngineKind::kReference}) {
      FrameStatistics statistics;
      const Result<Picture> picture = makeEngine(kind)->render(scene.database(), options, statistics);
      ASSERT_FALSE(picture.ok());
      EXPECT_EQ(picture.error().kind, ErrorKind::kUsage);
      EXPECT_NE(picture.error().message().find(words), std::string::npos) << picture.error().message();
    }
  };
  expectRefused({"machin", "body", std::nullopt, kIdentityTransform}, "near it: \"machine\"");
  expectRefused({"machine", "bodi", std::nullopt, kIdentityTransform}, "near it: \"body\"");
  expectRefused({"machine", "body", 0, kIdentityTransform}, "instance 0");
  expectRefused({"machine", "body", std::nullopt, scaled(1, 1, 0)}, "flattens");
  expectRefused({"machine", "body", std::nullopt, movedTo(std::nan(""), 0, 0)}, "out of range");
}

}  // namespace
}  // namespace deltaz
