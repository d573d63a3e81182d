#include "tools/dbview/pose_file.h"

#include <gtest/gtest.h>

#include "libdb/access/model.h"
#include "tests/support/model_fixture.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

std::vector<PartPose> parsed(const std::string& text) {
  Result<std::vector<PartPose>> poses = parsePoses(text, "poses.json");
  EXPECT_TRUE(poses.ok()) << (poses.ok() ? "" : poses.error().message());
  return poses.ok() ? std::move(poses).value() : std::vector<PartPose>{};
}

std::string refusal(const std::string& text) {
  const Result<std::vector<PartPose>> poses = parsePoses(text, "poses.json");
  EXPECT_FALSE(poses.ok()) << text;
  if (poses.ok()) return {};
  EXPECT_EQ(exitCode(poses.error().kind), 1);
  return poses.error().message();
}

void expectRefused(const std::string& text, const std::vector<std::string>& words) {
  const std::string message = refusal(text);
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
}

std::string withMembers(const std::string& members) {
  return R"({"poses": [{"model": "engine", "part": "piston")" + members + "}]}";
}

void expectNear(const Vector3& a, const Vector3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(PoseFile, scales_then_rotates_then_translates) {
  const std::vector<PartPose> poses = parsed(withMembers(
      R"(, "translate": [1, 2, 3], "scale": 2, "rotate": {"axis": [0, 0, 5], "degrees": 90}, "instance": 3)"));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].model, "engine");
  EXPECT_EQ(poses[0].part, "piston");
  EXPECT_EQ(poses[0].instance, 3u);
  // East turns to north, north to west.
  expectNear(transformPoint(poses[0].motion, {10, 0, 1}), {1, 22, 5});
  expectNear(transformPoint(poses[0].motion, {0, 10, 0}), {-19, 2, 3});
}

TEST(PoseFile, takes_a_matrix_of_row_vectors) {
  const std::vector<PartPose> poses = parsed(withMembers(R"(, "matrix": [1,2,3, 0,1,0, 0,0,-1, 7,8,9])"));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_FALSE(poses[0].instance.has_value());
  expectNear(transformPoint(poses[0].motion, {1, 10, 100}), {8, 20, -88});
}

TEST(PoseFile, a_pose_without_motion_and_a_file_without_poses_are_allowed) {
  EXPECT_EQ(parsed(withMembers("")).at(0).motion, kIdentityTransform);
  EXPECT_TRUE(parsed(R"({"poses": []})").empty());
}

TEST(PoseFile, unknown_members_are_refused_with_the_nearest_name) {
  expectRefused(withMembers(R"(, "transalte": [1, 2, 3])"),
                {"transalte", "near it: \"translate\"", "poses[0]"});
  expectRefused(withMembers(R"(, "rotate": {"axis": [0, 0, 1], "degree": 4})"),
                {"\"degree\"", "\"degrees\""});
  expectRefused(R"({"pose": []})", {"near it: \"poses\""});
}

TEST(PoseFile, what_is_no_pose_is_refused) {
  expectRefused("", {"poses.json", "no JSON"});
  expectRefused("{\"poses\": [", {"no JSON"});
  expectRefused("[]", {"no object"});
  expectRefused("{}", {"\"poses\" is missing"});
  expectRefused(R"({"poses": [3]})", {"poses[0]", "no object"});
  expectRefused(R"({"poses": [{"model": "engine"}]})", {"\"part\" is missing"});
  expectRefused(R"({"poses": [{"model": 3, "part": "piston"}]})", {"\"model\" is no text"});
  expectRefused(withMembers(R"(, "translate": [1, 2])"), {"3 numbers"});
  expectRefused(withMembers(R"(, "translate": [1, 2, "3"])"), {"translate[2]", "no number"});
  expectRefused(withMembers(R"(, "translate": [1, 2, 1e300])"), {"out of range"});
  expectRefused(withMembers(R"(, "scale": 0)"), {"scale"});
  expectRefused(withMembers(R"(, "rotate": {"axis": [0, 0, 0], "degrees": 1})"), {"no direction"});
  expectRefused(withMembers(R"(, "rotate": {"axis": [0, 0, 1]})"), {"\"degrees\" is missing"});
  expectRefused(withMembers(R"(, "instance": 0)"), {"instance"});
  expectRefused(withMembers(R"(, "instance": 4294967296)"), {"instance"});
  expectRefused(withMembers(R"(, "instance": -1)"), {"instance"});
  expectRefused(withMembers(R"(, "matrix": [1,0,0,0,1,0,0,0,1,0,0,0], "scale": 2)"), {"exclude"});
}

TEST(PoseFile, nothing_may_be_said_twice) {
  expectRefused(withMembers(R"(, "scale": 2, "scale": 3)"), {"\"scale\" stands twice"});
  expectRefused(R"({"poses": [{"model": "a", "part": "b"}, {"model": "a", "part": "b", "scale": 2}]})",
                {"poses[1]", "second pose"});
  EXPECT_EQ(parsed(R"({"poses": [{"model": "a", "part": "b"}, {"model": "a", "part": "b", "instance": 2}]})")
                .size(),
            2u);
}

// A tower is instance 1, a mast, which is built alike, instance 2.
Database towers() {
  MemoryFileSystem files = buildInMemory(syntheticGrid());
  addFixtureModel(files, kMemoryDatabasePath);
  addFixtureModel(files, kMemoryDatabasePath, "mast");
  std::vector<Placement> placements = {placementAt(43.5, -79.5, 100), placementAt(43.5, -79.4, 100)};
  placements[1].model = 1;
  setPlacements(files, kMemoryDatabasePath, placements);
  return Database::open(files, kMemoryDatabasePath).value();
}

TEST(PoseFile, models_parts_and_instances_must_be_there) {
  const Database database = towers();
  const auto check = [&](const PartPose& pose) {
    const Status status = checkPoses(database, {pose}, "poses.json");
    if (status.ok()) return std::string();
    EXPECT_EQ(exitCode(status.error().kind), 2);
    EXPECT_EQ(status.error().where, "poses.json");
    return status.error().message();
  };
  const auto refuses = [&](const PartPose& pose, const std::string& words) {
    const std::string message = check(pose);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  EXPECT_EQ(check({"tower", "head", std::nullopt, kIdentityTransform}), "");
  EXPECT_EQ(check({"tower", "head", 1, kIdentityTransform}), "");
  EXPECT_EQ(check({"mast", "base", 2, kIdentityTransform}), "");
  refuses({"towre", "head", std::nullopt, kIdentityTransform}, "near it: \"tower\"");
  refuses({"tower", "hed", std::nullopt, kIdentityTransform}, "near it: \"head\"");
  refuses({"tower", "head", 2, kIdentityTransform}, "instance 2 is a \"mast\"");
  refuses({"tower", "head", 3, kIdentityTransform}, "nothing is placed as instance 3");
}

}  // namespace
}  // namespace deltaz
