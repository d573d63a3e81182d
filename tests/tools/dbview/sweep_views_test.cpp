#include "tools/dbview/sweep_views.h"

#include <gtest/gtest.h>

#include "tests/librender/test_databases.h"

namespace deltaz {
namespace {

Result<std::vector<NamedCameraRequest>> parsed(const std::string& text) {
  CameraText common;
  common.size = "320x200";
  common.field_of_view = "45";
  return parseViews(text, "views.json", common);
}

void expectRefused(const std::string& text, const std::vector<std::string>& words) {
  const auto views = parsed(text);
  ASSERT_FALSE(views.ok()) << text;
  EXPECT_EQ(exitCode(views.error().kind), 1);
  for (const std::string& word : words)
    EXPECT_NE(views.error().message().find(word), std::string::npos) << views.error().message();
}

TEST(SweepViews, are_cameras_as_on_the_command_line) {
  const auto views = parsed(R"({"views": [
    {"name": "a", "eye": "46.5,7.25,100agl", "look": "10,-5,2", "fov": 30.5, "size": "64x48"},
    {"name": "b"}]})");
  ASSERT_TRUE(views.ok()) << views.error().message();
  ASSERT_EQ(views.value().size(), 2u);
  const CameraRequest &a = views.value()[0].camera, &b = views.value()[1].camera;
  EXPECT_TRUE(a.above_ground && !a.whole_area && b.whole_area);
  EXPECT_EQ(a.camera.eye.latitude, 46.5);
  EXPECT_EQ(a.camera.eye.longitude, 7.25);
  EXPECT_EQ(a.camera.eye.height, 100);
  EXPECT_EQ(a.camera.roll, 2);
  EXPECT_EQ(a.camera.field_of_view, 30.5);
  EXPECT_EQ(a.camera.height, 48);
  EXPECT_EQ(b.camera.width, 320);
  EXPECT_EQ(b.camera.field_of_view, 45);
}

TEST(SweepViews, that_make_no_sense_are_refused_with_their_place) {
  expectRefused("[]", {"views.json", "no object"});
  expectRefused(R"({"views": []})", {"views"});
  expectRefused(R"({"view": []})", {"near it: \"views\""});
  expectRefused(R"({"views": [{"eye": "1,2,3", "look": "0,0"}]})", {"views[0]", "name"});
  expectRefused(R"({"views": [{"name": "a", "eye": "1,2,3"}]})", {"views[0]", "--look"});
  expectRefused(R"({"views": [{"name": "a", "eye": "1,2", "look": "0,0"}]})", {"--eye", "LAT,LON,ALT"});
  expectRefused(R"({"views": [{"name": "a", "fov": "wide"}]})", {"fov"});
  expectRefused(R"({"views": [{"name": "a", "fov": 180}]})", {"--fov"});
  expectRefused(R"({"views": [{"name": "a"}, {"name": "a"}]})", {"views[1]", "two views"});
  expectRefused(R"({"views": [{"name": "a", "name": "b"}]})", {"stands twice"});
  expectRefused(R"({"views": [{"name": "a", "eyes": "1,2,3"}]})", {"near it: \"eye\""});
}

TEST(SweepViews, of_an_area_show_it_from_everywhere) {
  const MemoryDatabase area = makeDatabase(smallArea());
  Camera like;
  like.width = 160;
  like.height = 100;
  const auto views = defaultViews(area.database, like);
  ASSERT_TRUE(views.ok());
  std::vector<std::string> names;
  for (const SweepView& view : views.value()) {
    names.push_back(view.name);
    RenderOptions options;
    options.camera = view.camera;
    EXPECT_EQ(view.camera.width, 160);
    const Picture picture = draw(EngineKind::kFast, area.database, options);
    const auto terrain = std::count(picture.surface.begin(), picture.surface.end(), Surface::kTerrain);
    EXPECT_GT(terrain, 160 * 100 / 10) << view.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"whole area", "eye level", "oblique", "zenith"}));
}

// All posts void but a corner's: no ground at the middle meridian.
TEST(SweepViews, of_an_area_without_ground_in_its_middle_leave_out_eye_level) {
  RawGrid grid = syntheticGrid(smallArea());
  grid.valid.assign(grid.heights.size(), 0);
  for (std::int64_t row = 0; row < 4; ++row) {
    for (std::int64_t column = 0; column < 4; ++column)
      grid.valid[static_cast<std::size_t>(row * grid.header.x_axis.count + column)] = 1;
  }
  grid.header.sentinels = {-9999};
  const MemoryDatabase area = makeDatabaseOf(grid, 16);
  const auto views = defaultViews(area.database, Camera{});
  ASSERT_TRUE(views.ok());
  EXPECT_EQ(views.value().size(), 3u);
}

}  // namespace
}  // namespace deltaz
