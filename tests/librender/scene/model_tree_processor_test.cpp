#include "librender/scene/model_tree_processor.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>
#include <set>

#include "libdb/access/model.h"
#include "librender/objects/model_object_processor.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

constexpr double kLatitude = 46.8, kLongitude = -121.7, kHeight = 1500;

ModelTransform moved(double x, double y, double z) {
  return {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z};
}

ModelTransform turned(double degrees, double scale = 1) {
  const double angle = degrees * (std::numbers::pi / 180);
  const double c = scale * std::cos(angle), s = scale * std::sin(angle);
  return {c, s, 0, -s, c, 0, 0, 0, scale, 0, 0, 0};
}

// Blocks of meshes are never read here.
ModelPart partOf(const std::string& name, std::uint32_t parent, const ModelTransform& transform,
                 double radius, const std::vector<float>& errors) {
  ModelPart part;
  part.name = name;
  part.parent = parent;
  part.transform = transform;
  part.radius = radius;
  for (const float error : errors) part.lods.push_back({0, 1, error});
  return part;
}

// The tank of the report's figure 65 on a trailer that shows nothing itself.
enum TankPart : std::uint32_t {
  kTrailer,
  kBody,
  kTurret,
  kTread,
  kLargeGun,
  kSmallGun,
  kAntenna,
  kLight,
  kBarrel
};
ModelTree tank() {
  ModelTree tree;
  tree.parts = {partOf("trailer", kNoParent, kIdentityTransform, 0, {}),
                partOf("body", kTrailer, moved(0, 0, 1), 3, {0, 0.1F, 0.4F}),
                partOf("turret", kBody, moved(0, 0.5, 1.2), 1.5, {0, 0.1F, 0.3F}),
                partOf("tread", kBody, moved(1.5, 0, -0.5), 2.5, {0, 0.2F}),
                partOf("large gun", kTurret, moved(0, 1.5, 0.2), 1, {0, 0.05F}),
                partOf("small gun", kTurret, moved(0.5, 0.6, 0.8), 0.4, {0}),
                partOf("antenna", kTurret, moved(-0.5, -0.6, 1), 1, {0}),
                partOf("light", kTurret, moved(-0.6, 0.8, 0.5), 0.2, {0}),
                partOf("barrel", kLargeGun, moved(0, 2, 0), 1.5, {0, 0.02F})};
  tree.centre = {0, 1, 1.5};
  tree.radius = 8;
  return tree;
}

Placement placed(std::uint32_t instance, double latitude, double longitude, double heading = 0) {
  Placement placement;
  placement.instance = instance;
  placement.latitude = latitude;
  placement.longitude = longitude;
  placement.height = kHeight;
  placement.heading = heading;
  return placement;
}

// A scene of tanks, each on a page of its own.
struct Tanks {
  ModelTree tree = tank();
  std::vector<Placement> placements;
  std::set<std::uint32_t> pages_read;

  ModelScene scene() {
    ModelScene scene;
    scene.trees = {&tree};
    for (const Placement& placement : placements) {
      const ModelTransform m = placementTransform(placement, tree.anchor, scene.ellipsoid);
      const Vector3 centre = transformPoint(m, {tree.centre[0], tree.centre[1], tree.centre[2]});
      scene.pages.push_back({{centre.x, centre.y, centre.z}, tree.radius + 0.01});
    }
    scene.read_page = [this](std::uint32_t page) -> Result<std::vector<Placement>> {
      pages_read.insert(page);
      return std::vector{placements[page]};
    };
    return scene;
  }
};

// Looks from `distance` metres south of the place the tanks stand at, level.
ViewTransform viewFrom(double distance, double pitch = 0, double heading = 0) {
  Camera camera;
  camera.eye = {kLatitude - distance / 111150, kLongitude, kHeight + 1.5};
  camera.heading = heading;
  camera.pitch = pitch;
  camera.width = 320;
  camera.height = 200;
  return makeViewTransform(camera, EllipsoidShape{});
}

ModelSchedule processed(Tanks& tanks, const PoseTable& poses, const ViewTransform& view,
                        const ModelTreeOptions& options, FrameStatistics::Models& statistics) {
  Result<ModelSchedule> schedule = processModelTrees(tanks.scene(), poses, view, options, statistics);
  EXPECT_TRUE(schedule.ok());
  return std::move(schedule).value();
}

TEST(ModelTreeProcessor, a_part_without_data_does_not_block_its_children) {
  Tanks tanks;
  tanks.placements = {placed(4, kLatitude, kLongitude)};
  FrameStatistics::Models statistics;
  const ModelSchedule schedule = processed(tanks, {}, viewFrom(60), {}, statistics);
  ASSERT_EQ(schedule.parts.size(), 8u);
  for (std::uint32_t p = 0; p < 8; ++p) {
    EXPECT_EQ(schedule.parts[p].part, p + 1);
    EXPECT_EQ(schedule.parts[p].instance, 4u);
  }
  EXPECT_EQ(statistics.visited, 1u);
  EXPECT_EQ(statistics.drawn, 1u);
  EXPECT_EQ(statistics.out_of_view, 0u);
}

TEST(ModelTreeProcessor, parts_come_in_the_order_of_their_instances_whatever_the_order_of_pages) {
  Tanks tanks;
  for (const std::uint32_t instance : {9u, 2u, 5u})
    tanks.placements.push_back(placed(instance, kLatitude, kLongitude + instance * 1e-4));
  FrameStatistics::Models statistics;
  const ModelSchedule schedule = processed(tanks, {}, viewFrom(400), {}, statistics);
  ASSERT_EQ(schedule.parts.size(), 24u);
  EXPECT_TRUE(std::is_sorted(schedule.parts.begin(), schedule.parts.end(), [](const auto& a, const auto& b) {
    return std::pair(a.instance, a.part) < std::pair(b.instance, b.part);
  }));
}

TEST(ModelTreeProcessor, takes_the_coarsest_level_of_detail_within_the_tolerance) {
  Tanks tanks;
  tanks.placements = {placed(1, kLatitude, kLongitude)};
  std::set<std::uint32_t> levels_of_the_body;
  for (const double distance : {15.0, 60.0, 150.0, 400.0, 3000.0}) {
    for (const double tolerance : {0.0, 0.3, 1.0, 4.0}) {
      const ViewTransform view = viewFrom(distance);
      FrameStatistics::Models statistics;
      ModelTreeOptions options;
      options.tolerance = tolerance;
      const ModelSchedule schedule = processed(tanks, {}, view, options, statistics);
      ASSERT_FALSE(schedule.parts.empty());
      EXPECT_LE(schedule.projected_error, tolerance);
      for (const DrawnPart& drawn : schedule.parts) {
        const ModelPart& part = tanks.tree.parts[drawn.part];
        if (tolerance == 0) {
          EXPECT_EQ(drawn.lod, 0u);
          continue;
        }
        const auto bound = [&](std::uint32_t lod) {
          return projectedErrorBound(view, transformPoint(drawn.to_earth, {0, 0, 0}), part.radius,
                                     static_cast<double>(part.lods[lod].error));
        };
        EXPECT_LE(bound(drawn.lod), tolerance * (1 + 1e-9));
        if (drawn.lod + 1 < part.lods.size()) {
          EXPECT_GT(bound(drawn.lod + 1), tolerance * (1 - 1e-9));
        }
        if (drawn.part == kBody) levels_of_the_body.insert(drawn.lod);
      }
    }
  }
  EXPECT_EQ(levels_of_the_body.size(), 3u);
}

TEST(ModelTreeProcessor, a_part_that_is_made_larger_is_drawn_finer) {
  Tanks tanks;
  tanks.placements = {placed(1, kLatitude, kLongitude)};
  PoseTable poses;
  poses.add(0, kTread, 0, turned(0, 100));
  const ViewTransform view = viewFrom(3000);
  FrameStatistics::Models statistics;
  const auto level = [&](const PoseTable& table) {
    for (const DrawnPart& drawn : processed(tanks, table, view, {}, statistics).parts)
      if (drawn.part == kTread) return drawn.lod;
    return std::numeric_limits<std::uint32_t>::max();
  };
  EXPECT_EQ(level({}), 1u);
  EXPECT_EQ(level(poses), 0u);
}

TEST(ModelTreeProcessor, a_motion_is_applied_before_the_default_transform_and_moves_what_hangs_under_it) {
  Tanks tanks;
  tanks.tree.anchor = {0.3, -0.2, 0.1};
  tanks.placements = {placed(1, kLatitude, kLongitude, 35)};
  PoseTable poses;
  const ModelTransform motion = concatenate(turned(70), moved(0.1, 0.2, 0.3));
  poses.add(0, kTurret, 0, motion);
  FrameStatistics::Models statistics;
  const ViewTransform view = viewFrom(12);
  const ModelSchedule schedule = processed(tanks, poses, view, {}, statistics);
  // The barrel's point, up the tree one matrix at a time.
  const Vector3 point{0.2, 1.1, -0.3};
  Vector3 p = transformPoint(tanks.tree.parts[kBarrel].transform, point);
  p = transformPoint(tanks.tree.parts[kLargeGun].transform, p);
  p = transformPoint(tanks.tree.parts[kTurret].transform, transformPoint(motion, p));
  p = transformPoint(tanks.tree.parts[kBody].transform, p);
  p = transformPoint(placementTransform(tanks.placements[0], tanks.tree.anchor, EllipsoidShape{}), p);
  const auto barrel = std::find_if(schedule.parts.begin(), schedule.parts.end(),
                                   [](const DrawnPart& drawn) { return drawn.part == kBarrel; });
  ASSERT_NE(barrel, schedule.parts.end());
  const Vector3 seen = transformPoint(viewTransformOf(barrel->to_earth, view), point);
  EXPECT_LT(length(seen - view.toView(p)), 1e-6 * view.pixels);
}

TEST(ModelTreeProcessor, a_pose_of_one_instance_goes_before_one_of_all) {
  Tanks tanks;
  tanks.placements = {placed(1, kLatitude, kLongitude), placed(2, kLatitude, kLongitude)};
  PoseTable poses;
  poses.add(0, kLight, 0, moved(0, 0, 1));
  poses.add(0, kLight, 2, moved(0, 0, 3));
  poses.add(0, kAntenna, 0, moved(0, 0, 7));
  FrameStatistics::Models statistics;
  const ModelSchedule schedule = processed(tanks, poses, viewFrom(60), {}, statistics);
  const auto apart = [&](std::uint32_t part) {
    std::vector<Vector3> at;
    for (const DrawnPart& drawn : schedule.parts)
      if (drawn.part == part) at.push_back(transformPoint(drawn.to_earth, {0, 0, 0}));
    EXPECT_EQ(at.size(), 2u);
    return length(at[1] - at[0]);
  };
  EXPECT_NEAR(apart(kLight), 2, 1e-6);
  EXPECT_NEAR(apart(kAntenna), 0, 1e-6);
}

TEST(ModelTreeProcessor, a_page_out_of_view_is_not_read_unless_a_motion_reaches_the_view) {
  Tanks tanks;
  tanks.placements = {placed(1, kLatitude, kLongitude), placed(2, kLatitude - 0.1, kLongitude)};
  const ViewTransform view = viewFrom(60);
  FrameStatistics::Models statistics;
  ModelSchedule schedule = processed(tanks, {}, view, {}, statistics);
  EXPECT_EQ(tanks.pages_read, std::set<std::uint32_t>{0});
  EXPECT_EQ(statistics.visited, 1u);

  // 0.1 degrees of latitude further north the second one's turret is before the eye.
  PoseTable poses;
  poses.add(0, kTurret, 2, moved(0, 0.1 * 111170, 10));
  statistics = {};
  schedule = processed(tanks, poses, view, {}, statistics);
  EXPECT_EQ(tanks.pages_read, (std::set<std::uint32_t>{0, 1}));
  EXPECT_EQ(statistics.visited, 2u);
  EXPECT_EQ(statistics.drawn, 2u);
}

TEST(ModelTreeProcessor, counts_what_is_on_a_read_page_and_out_of_view) {
  Tanks tanks;
  tanks.placements = {placed(1, kLatitude, kLongitude), placed(2, kLatitude - 0.01, kLongitude)};
  ModelScene scene = tanks.scene();
  scene.pages = {scene.pages[0]};
  scene.read_page = [&](std::uint32_t) -> Result<std::vector<Placement>> { return tanks.placements; };
  FrameStatistics::Models statistics;
  ASSERT_TRUE(processModelTrees(scene, {}, viewFrom(60), {}, statistics).ok());
  EXPECT_EQ(statistics.visited, 2u);
  EXPECT_EQ(statistics.out_of_view, 1u);
  EXPECT_EQ(statistics.drawn, 1u);
}

TEST(ModelTreeProcessor, an_error_of_a_page_is_passed_on) {
  Tanks tanks;
  tanks.placements = {placed(1, kLatitude, kLongitude)};
  ModelScene scene = tanks.scene();
  scene.read_page = [](std::uint32_t) -> Result<std::vector<Placement>> {
    return invalidError(IssueCode::kPlacementRecord, "page", "is damaged");
  };
  FrameStatistics::Models statistics;
  const Result<ModelSchedule> schedule = processModelTrees(scene, {}, viewFrom(60), {}, statistics);
  ASSERT_FALSE(schedule.ok());
  EXPECT_EQ(schedule.error().code, IssueCode::kPlacementRecord);
}

TEST(ModelTreeProcessor, matrices_that_multiply_beyond_all_bounds_are_refused) {
  for (const double scale : {1e6, 1e-7}) {
    for (const bool posed : {false, true}) {
      Tanks tanks;
      tanks.placements = {placed(1, kLatitude, kLongitude)};
      PoseTable poses;
      for (const std::uint32_t part : {kBody, kTurret, kLargeGun}) {
        if (posed) {
          poses.add(0, part, 0, turned(0, scale));
        } else {
          tanks.tree.parts[part].transform = turned(0, scale);
        }
      }
      FrameStatistics::Models statistics;
      const Result<ModelSchedule> schedule =
          processModelTrees(tanks.scene(), poses, viewFrom(60), {}, statistics);
      ASSERT_FALSE(schedule.ok());
      EXPECT_EQ(schedule.error().kind, posed ? ErrorKind::kUsage : ErrorKind::kInvalid);
      EXPECT_NE(schedule.error().message().find("\"turret\""), std::string::npos);
    }
  }
}

// Views of all kinds, tanks in random poses: whatever part culling drops has no point of its sphere in the
// picture. Without culling all parts are there, so what was dropped is known.
TEST(ModelTreeProcessor, culling_drops_only_what_is_out_of_the_picture) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::uint64_t dropped = 0, kept = 0;
  for (int round = 0; round < 300; ++round) {
    Tanks tanks;
    for (std::uint32_t instance = 1; instance <= 3; ++instance)
      tanks.placements.push_back(placed(instance, kLatitude + unit(random) * 3e-4,
                                        kLongitude + unit(random) * 3e-4, 180 + 179 * unit(random)));
    PoseTable poses;
    for (int k = 0; k < round % 3; ++k) {
      ModelTransform motion = turned(180 * unit(random), 1 + 0.9 * unit(random));
      for (std::size_t axis = 9; axis < 12; ++axis) motion[axis] = 60 * unit(random);
      poses.add(0, static_cast<std::uint32_t>(random() % tanks.tree.parts.size()),
                static_cast<std::uint32_t>(random() % 4), motion);
    }
    const ViewTransform view = viewFrom(30 + 28 * unit(random), 30 * unit(random), 90 * unit(random));
    FrameStatistics::Models statistics;
    ModelTreeOptions everything;
    everything.cull = false;
    const ModelSchedule all = processed(tanks, poses, view, everything, statistics);
    ASSERT_EQ(all.parts.size(), 24u);
    const ModelSchedule seen = processed(tanks, poses, view, {}, statistics);
    std::set<std::pair<std::uint32_t, std::uint32_t>> drawn;
    for (const DrawnPart& part : seen.parts) drawn.emplace(part.instance, part.part);
    for (const DrawnPart& part : all.parts) {
      if (drawn.count({part.instance, part.part}) > 0) {
        ++kept;
        continue;
      }
      ++dropped;
      const double radius = tanks.tree.parts[part.part].radius;
      for (int k = 0; k < 40; ++k) {
        const Vector3 direction =
            normalized(Vector3{unit(random), unit(random), unit(random)} + Vector3{1e-9, 0, 0});
        const Vector3 p =
            view.toView(transformPoint(part.to_earth, direction * (radius * std::abs(unit(random)))));
        EXPECT_FALSE(p.x > kHither && std::abs(p.y) < view.width / 2.0 * p.x &&
                     std::abs(p.z) < view.height / 2.0 * p.x);
      }
    }
  }
  EXPECT_GT(dropped, 1000u);
  EXPECT_GT(kept, 1000u);
}

}  // namespace
}  // namespace deltaz
