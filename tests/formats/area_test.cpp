#include "formats/area.h"

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
  area.nodes_per_page = 64;
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
      parseArea(withReplaced("\"required_features\": []", "\"required_features\": [\n    \"tin\"\n  ]"), "a");
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

TEST(Area, something_else_is_not_a_database) {
  EXPECT_EQ(parseArea("", "a").error().code, IssueCode::kManSyntax);
  EXPECT_EQ(parseArea("{}", "a").error().code, IssueCode::kManSyntax);
}

}  // namespace
}  // namespace deltaz
