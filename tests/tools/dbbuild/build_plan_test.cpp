#include "tools/dbbuild/build_plan.h"

#include <gtest/gtest.h>

#include "tests/support/memory_file_system.h"

namespace deltaz {
namespace {

const std::vector<PlanSection>& schema() {
  static const std::vector<PlanSection> sections = {
      {"terrain",
       false,
       true,
       {{"sources", KeyKind::kList, true, true, true},
        {"leaf", KeyKind::kValue},
        {"bounds", KeyKind::kValue},
        {"allow-ballpark", KeyKind::kFlag}}},
      {"color", true, false, {{"name", KeyKind::kValue}, {"image", KeyKind::kList, true}}},
      {"place", true, false, {{"at", KeyKind::kList}, {"map", KeyKind::kValue}}},
  };
  return sections;
}

Result<BuildPlan> planOf(const std::string& text) {
  return parseBuildPlan(text, "build.toml", "/maps", schema());
}

// The message of the error that `text` must give.
std::string messageOf(const std::string& text) {
  const Result<BuildPlan> plan = planOf(text);
  EXPECT_FALSE(plan.ok()) << text;
  if (plan.ok()) return {};
  EXPECT_EQ(plan.error().kind, ErrorKind::kUsage);
  return plan.error().message();
}

void expectIn(const std::string& part, const std::string& message) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

constexpr const char* kTerrain = "area = 'a.dz'\n[terrain]\nsources = ['dem.tif', '/other/dem.tif']\n";

TEST(BuildPlan, sections_become_command_lines_with_paths_beside_the_file) {
  const Result<BuildPlan> plan = planOf(
      "area = 'a.dz'\n"
      "[[color]]\nname = 'summer'\nimage = ['w.tif', 'e.tif']\n"
      "[terrain]\nsources = 'dem.tif'\nleaf = 32\nbounds = [-121.5, 46, -121.25, 46.5]\nallow-ballpark = "
      "true\n"
      "[[color]]\nname = 'winter'\nimage = '/abs.tif'\n");
  ASSERT_TRUE(plan.ok()) << plan.error().message();
  EXPECT_EQ(plan.value().area, "/maps/a.dz");
  ASSERT_EQ(plan.value().steps.size(), 3u);
  const PlanStep& terrain = plan.value().steps[0];
  EXPECT_EQ(terrain.section, "terrain");
  EXPECT_EQ(terrain.line, 5u);
  EXPECT_EQ(terrain.positionals, std::vector<std::string>{"/maps/dem.tif"});
  EXPECT_EQ(terrain.options,
            (std::vector<std::string>{"--leaf=32", "--bounds=-121.5,46,-121.25,46.5", "--allow-ballpark"}));
  EXPECT_EQ(plan.value().steps[1].options,
            (std::vector<std::string>{"--name=summer", "--image=/maps/w.tif", "--image=/maps/e.tif"}));
  EXPECT_EQ(plan.value().steps[2].options, (std::vector<std::string>{"--name=winter", "--image=/abs.tif"}));
}

TEST(BuildPlan, numbers_in_a_list_are_one_value_and_lists_of_them_several) {
  const auto options_of = [](const std::string& value) {
    const Result<BuildPlan> plan = planOf(std::string(kTerrain) + "[[place]]\nat = " + value + "\n");
    EXPECT_TRUE(plan.ok()) << plan.error().message();
    return plan.ok() ? plan.value().steps.back().options : std::vector<std::string>{};
  };
  EXPECT_EQ(options_of("[46.5, -121]"), std::vector<std::string>{"--at=46.5,-121"});
  EXPECT_EQ(options_of("'46.5,-121,120agl'"), std::vector<std::string>{"--at=46.5,-121,120agl"});
  EXPECT_EQ(options_of("[[46.5, -121], '47,-122']"),
            (std::vector<std::string>{"--at=46.5,-121", "--at=47,-122"}));
}

TEST(BuildPlan, an_unknown_key_is_named_with_its_place_and_the_nearest_name) {
  const std::string message = messageOf(std::string(kTerrain) + "  laef = 32\n");
  expectIn("build.toml, line 4, column 3", message);
  expectIn("'laef'", message);
  expectIn("Did you mean 'leaf'?", message);
  expectIn("Did you mean 'terrain'?", messageOf("area = 'a.dz'\n[terain]\nsources = 'd.tif'\n"));
  // Nothing is near: all names are listed.
  expectIn("There are: name, image", messageOf(std::string(kTerrain) + "[[color]]\nresolution = 3\n"));
}

TEST(BuildPlan, values_of_the_wrong_kind_are_refused) {
  expectIn("line 4", messageOf(std::string(kTerrain) + "allow-ballpark = 'yes'\n"));
  expectIn("true or false", messageOf(std::string(kTerrain) + "allow-ballpark = 1\n"));
  expectIn("wrong kind", messageOf(std::string(kTerrain) + "leaf = true\n"));
  expectIn("a file's name", messageOf("area = 'a.dz'\n[terrain]\nsources = [3]\n"));
  expectIn("empty list", messageOf("area = 'a.dz'\n[terrain]\nsources = []\n"));
  expectIn("[[color]] with two brackets", messageOf(std::string(kTerrain) + "[color]\nname = 'x'\n"));
  expectIn("is no section", messageOf("area = 'a.dz'\nterrain = 3\n"));
}

TEST(BuildPlan, what_is_missing_is_named) {
  expectIn("'area' is missing", messageOf("[terrain]\nsources = 'd.tif'\n"));
  expectIn("[terrain] is missing", messageOf("area = 'a.dz'\n"));
  expectIn("'sources' is missing", messageOf("area = 'a.dz'\n[terrain]\nleaf = 8\n"));
}

// What checkPlan says of a file whose folder holds dem.tif alone.
std::string faultOf(const std::string& sections) {
  const Result<BuildPlan> plan = planOf("area = 'a.dz'\n[terrain]\nsources = 'dem.tif'\n" + sections);
  EXPECT_TRUE(plan.ok()) << plan.error().message();
  MemoryFileSystem files;
  files.setText("/maps/dem.tif", "posts");
  const Status checked = checkPlan(plan.value(), "build.toml", {{"color", "name", "place", "map"}}, files);
  return checked.ok() ? "" : checked.error().message();
}

TEST(BuildPlan, what_a_later_step_would_find_is_said_before_the_first) {
  EXPECT_EQ(faultOf("[[color]]\nname = 'x'\n[[color]]\nname = 'y'\n[[place]]\nmap = 'y'\n"), "");
  const std::string twice = faultOf("[[color]]\nname = 'x'\n[[color]]\nname = 'x'\n");
  expectIn("line 7, column 8", twice);
  expectIn("'x' is given twice", twice);
  expectIn("no [[color]] called 'sumer'. Did you mean 'summer'?",
           faultOf("[[color]]\nname = 'summer'\n[[place]]\nmap = 'sumer'\n"));
  expectIn("Write a [[color]]", faultOf("[[place]]\nmap = 'x'\n"));
  expectIn("there is no file /maps/no.tif", faultOf("[[color]]\nname = 'x'\nimage = 'no.tif'\n"));
  EXPECT_EQ(faultOf("[[color]]\nname = 'x'\nimage = '/vsizip/maps.zip/no.tif'\n"), "");
}

TEST(BuildPlan, what_is_not_toml_is_refused_with_its_place) {
  const std::string message = messageOf("area = 'a.dz'\n[terrain\n");
  expectIn("line 2", message);
  expectIn("not TOML", message);
  expectIn("not TOML", messageOf("area = 'a.dz'\narea = 'b.dz'\n"));
}

}  // namespace
}  // namespace deltaz
