#include "formats/area.h"

#include <functional>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/database_editor.h"

namespace deltaz {
namespace {

AreaHeader sampleArea() {
  AreaHeader area;
  area.west = -122;
  area.south = 46;
  area.east = -121;
  area.north = 47;
  area.centroid = {-150000000, -230000000, 300000000};
  area.lowest_height = 263;
  area.highest_height = 4371;
  area.sea_drop = 0.328125;
  area.node_count = 554;
  area.nodes_per_page = 16;
  GridHeader grid;
  grid.crs_wkt = "GEOGCRS[\"WGS 84\"]";
  grid.horizontal_datum = "WGS_1984";
  grid.vertical_datum = "unknown";
  grid.unit = "metre";
  grid.quantum = {1200, 3937};
  grid.x_axis = {3.0 / 3600, Rational{3, 1}, 0, 69600, 1201};
  grid.y_axis = {0.00083, std::nullopt, 0.25, 163200, 1201};
  grid.level_count = 6;
  SourceDescription source;
  source.name = "mt_rainier.tif";
  source.driver = "GTiff";
  source.geotransform = {-122.00041666666667, 0.1 + 0.2, 0, 47.000416666666666, 0, -1e-3};
  source.data_type = "Int16";
  source.nodata = -32768;
  source.columns = source.rows = 1201;
  grid.sources.push_back(source);
  area.grids.push_back(grid);
  area.files = {{FileRole::kNodes, 0, "nodes-000001.dzn", 53808, {}},
                {FileRole::kTerrain, 0, "terrain-000001-000.dzt", 1, {}}};
  area.tool_version = "deltaz 0.1.0";
  area.options = {{"leaf", "64"}};
  return area;
}

TEST(Area, reads_back_exactly_doubles_included) {
  const std::string text = serializeArea(sampleArea());
  const Result<AreaHeader> back = parseArea(text, "area.json");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), sampleArea());
  EXPECT_EQ(serializeArea(back.value()), text);
}

TEST(Area, every_single_bit_flip_is_refused) {
  const std::string text = serializeArea(sampleArea());
  for (std::size_t k = 0; k < text.size() * 8; ++k) {
    std::string flipped = text;
    flipped[k / 8] = static_cast<char>(flipped[k / 8] ^ (1 << (k % 8)));
    ASSERT_FALSE(parseArea(flipped, "area.json").ok()) << "bit " << k;
  }
}

TEST(Area, every_truncation_and_every_extra_byte_is_refused) {
  const std::string text = serializeArea(sampleArea());
  for (std::size_t length = 0; length < text.size(); ++length) {
    ASSERT_FALSE(parseArea(text.substr(0, length), "area.json").ok()) << length;
  }
  EXPECT_FALSE(parseArea(text + "\n", "area.json").ok());
  EXPECT_FALSE(parseArea(" " + text, "area.json").ok());
}

std::string withReplaced(const std::string& from, const std::string& to) {
  std::string text = serializeArea(sampleArea());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return sealAreaText(text.replace(at, from.size(), to));
}

TEST(Area, a_newer_version_or_required_feature_is_refused_as_newer) {
  EXPECT_EQ(parseArea(withReplaced("\"version\": 1", "\"version\": 2"), "a").error().kind,
            ErrorKind::kNewerFormat);
  const Result<AreaHeader> feature =
      parseArea(withReplaced("\"packed_nodes\"\n", "\"packed_nodes\",\n    \"tin\"\n"), "a");
  ASSERT_FALSE(feature.ok());
  EXPECT_EQ(feature.error().kind, ErrorKind::kNewerFormat);
  EXPECT_NE(feature.error().message().find("tin"), std::string::npos);
}

TEST(Area, an_optional_feature_may_bring_members_this_version_does_not_know) {
  EXPECT_TRUE(parseArea(withReplaced("\"optional_features\": []",
                                     "\"optional_features\": [\n    \"notes\"\n  ],\n  \"notes\": 1"),
                        "a")
                  .ok());
  EXPECT_EQ(
      parseArea(withReplaced("\"generation\": 1", "\"generation\": 1,\n  \"notes\": 1"), "a").error().code,
      IssueCode::kManField);
}

TEST(Area, values_out_of_range_are_named) {
  const auto fault = [](const std::string& from, const std::string& to) {
    const Result<AreaHeader> area = parseArea(withReplaced(from, to), "a");
    return area.ok() ? std::string("accepted")
                     : std::string(issueCodeName(area.error().code)) + " " + area.error().what;
  };
  EXPECT_EQ(fault("\"leaf_cells\": 64", "\"leaf_cells\": 63"),
            "MAN_FIELD member grids[0].leaf_cells is not a power of two");
  EXPECT_EQ(fault("\"count\": 554", "\"count\": -1"), "MAN_FIELD member nodes.count is out of range");
  EXPECT_EQ(fault("\"count\": 554", "\"count\": 18446744073709551615"),
            "MAN_FIELD member nodes.count is out of range");
  EXPECT_EQ(fault("\"count\": 554", "\"count\": \"many\""), "MAN_FIELD member nodes.count is not an integer");
  EXPECT_EQ(fault("\"north\": 47.0", "\"north\": 45.0"), "MAN_FIELD member bounds. are empty");
  EXPECT_EQ(fault("nodes-000001.dzn", "../nodes.dzn"),
            "MAN_FIELD member files[0].name is not a plain file name");
  EXPECT_EQ(fault("\"phase\": 0.25", "\"phase\": 1.0"),
            "MAN_FIELD member grids[0].y_axis.phase is out of range");
  EXPECT_EQ(fault("\"diagonal\": \"SW-NE\"", "\"diagonal\": \"NW-SE\""),
            "MAN_FIELD member grids[0].diagonal is not SW-NE");
}

TEST(Area, a_name_that_is_not_utf8_stays_readable) {
  AreaHeader area = sampleArea();
  area.grids[0].sources[0].name = "caf\xE9.tif";
  EXPECT_TRUE(parseArea(serializeArea(area), "a").ok());
}

AreaHeader areaWithAssets() {
  AreaHeader area = sampleArea();
  area.color_maps = {{"summer",
                      "image",
                      {{"ortho.tif", Hash128{{std::byte{1}, std::byte{2}}}}, {"b.tif", {}}},
                      {{"texel", "30m"}}},
                     {"winter", "synthetic", {}, {}}};
  area.models = {{"tower", "mesh", {{"tower.glb", {}}}, {}}, {"a.b_c-2", "mesh", {}, {{"units", "ft"}}}};
  area.files.push_back({FileRole::kColors, 0, "colors-000002-000.dzc", 5, {}});
  area.files.push_back({FileRole::kColors, 1, "colors-000003-001.dzc", 5, {}});
  area.files.push_back({FileRole::kModel, 0, "model-000004-000.dzm", 5, {}});
  area.files.push_back({FileRole::kModel, 1, "model-000004-001.dzm", 5, {}});
  area.files.push_back({FileRole::kPlacements, 0, "placements-000005.dzl", 5, {}});
  return area;
}

TEST(Area, colour_maps_and_models_read_back) {
  const std::string text = serializeArea(areaWithAssets());
  const Result<AreaHeader> back = parseArea(text, "area.json");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), areaWithAssets());
  for (std::size_t k = 0; k < text.size(); ++k) {
    std::string flipped = text;
    flipped[k] = static_cast<char>(flipped[k] ^ (1 << (k % 8)));
    ASSERT_FALSE(parseArea(flipped, "area.json").ok()) << "byte " << k;
  }
}

// Programs that know no colours or models are told by a required feature, and only where there are any.
TEST(Area, features_are_named_where_they_are_used_and_nowhere_else) {
  const auto features = [](const AreaHeader& area) {
    const std::string text = serializeArea(area);
    const std::size_t begin = text.find("\"required_features\"");
    return text.substr(begin, text.find(']', begin) - begin);
  };
  const std::string plain = serializeArea(sampleArea());
  EXPECT_NE(plain.find("\"required_features\": [\n    \"packed_nodes\"\n  ],"), std::string::npos);
  for (const char* const word : {"colors", "color_maps", "models", "placements"})
    EXPECT_EQ(plain.find(word), std::string::npos) << word;
  AreaHeader colored = areaWithAssets();
  colored.models.clear();
  std::erase_if(colored.files, [](const FileReference& file) {
    return file.role == FileRole::kModel || file.role == FileRole::kPlacements;
  });
  EXPECT_NE(features(colored).find("colors"), std::string::npos);
  EXPECT_EQ(features(colored).find("models"), std::string::npos);
  AreaHeader placed = sampleArea();
  placed.files.push_back(areaWithAssets().files.back());
  EXPECT_EQ(features(placed).find("colors"), std::string::npos);
  EXPECT_NE(features(placed).find("models"), std::string::npos) << "placements outlast models";
  for (const AreaHeader& area : {colored, placed})
    EXPECT_EQ(parseArea(serializeArea(area), "a").value(), area);
}

TEST(Area, a_feature_that_is_not_used_is_not_canonical) {
  EXPECT_EQ(
      parseArea(withReplaced("\"packed_nodes\"\n", "\"packed_nodes\",\n    \"colors\"\n"), "a").error().code,
      IssueCode::kManField);
}

// Programs that know only plain pages are told by a feature; databases of theirs stay what they are.
TEST(Area, pages_of_nodes_are_packed_or_those_of_the_first_databases) {
  AreaHeader area = sampleArea();
  area.nodes_per_page = kNodesPerPlainPage;
  const std::string text = serializeArea(area);
  EXPECT_EQ(text.find("packed_nodes"), std::string::npos);
  EXPECT_EQ(parseArea(text, "a").value(), area);
  for (const char* const size : {"0", "17", "32", "63", "65", "4294967295"}) {
    const std::string per_page = std::string("\"per_page\": ") + size;
    EXPECT_EQ(parseArea(withReplaced("\"per_page\": 16", per_page), "a").error().code, IssueCode::kManField);
  }
  EXPECT_FALSE(parseArea(withReplaced("\"per_page\": 16", "\"per_page\": 64"), "a").ok())
      << "plain pages under the feature of packed ones";
}

TEST(Area, names_of_colour_maps_and_models_are_plain_and_unique) {
  const auto accepted = [](const std::function<void(AreaHeader&)>& change) {
    AreaHeader area = areaWithAssets();
    change(area);
    return parseArea(serializeArea(area), "a").ok();
  };
  EXPECT_TRUE(accepted([](auto&) {}));
  EXPECT_TRUE(accepted([](auto& a) { a.models[0].name = "summer"; })) << "a map and a model may share one";
  EXPECT_TRUE(accepted([](auto& a) { a.models[0].name = std::string(64, 'x'); }));
  EXPECT_FALSE(accepted([](auto& a) { a.color_maps[1].name = "summer"; }));
  EXPECT_FALSE(accepted([](auto& a) { a.models[1].name = "tower"; }));
  for (const std::string name : {"", "none", "a/b", "..", ".a", "a.", "-a", "a b", "\xC3\xBC"})
    EXPECT_FALSE(accepted([&](auto& a) { a.color_maps[0].name = name; })) << name;
  EXPECT_FALSE(accepted([](auto& a) { a.models[0].name = std::string(65, 'x'); }));
}

TEST(Area, something_else_is_not_a_database) {
  EXPECT_EQ(parseArea("", "a").error().code, IssueCode::kManSyntax);
  EXPECT_EQ(parseArea("{}", "a").error().code, IssueCode::kManSyntax);
}

}  // namespace
}  // namespace deltaz
