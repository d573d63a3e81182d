#include "librender/ars/machine/control_status_board.h"

#include <array>
#include <gtest/gtest.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "librender/ars/machine/machine.h"
#include "tests/librender/ars/machine/random_pixels.h"

namespace deltaz::ars {
namespace {

using Json = nlohmann::json;

PassStatistics someFrame(const MachineConfiguration& configuration) {
  Machine machine = Machine::make(configuration).value();
  return machine.runTimed(randomPixels({.triangles = 200, .seed = 20})).value();
}

// What the report printed of its own frame.
PassStatistics reportedFrame() {
  constexpr std::array<std::array<std::int64_t, 7>, 8> kTable20 = {
      {{30377, 19603, 0, 3156, 3970, 1750, 1898},
       {30430, 19606, 0, 3208, 3949, 1763, 1904},
       {30393, 19362, 0, 3157, 4122, 1696, 2056},
       {30620, 19755, 0, 3250, 3990, 1749, 1876},
       {30411, 19619, 0, 3214, 3934, 1777, 1867},
       {30416, 19647, 0, 3154, 3905, 1813, 1897},
       {30502, 19737, 0, 3156, 3953, 1794, 1862},
       {30458, 19635, 0, 3204, 3942, 1772, 1905}}};
  constexpr std::array<std::array<std::int64_t, 2>, 4> kTable22 = {
      {{86584, 61086}, {88473, 61770}, {83547, 59815}, {86436, 60935}}};
  PassStatistics statistics;
  for (const auto& [cycles, initialize, background, law, lanw, rcw, rcnw] : kTable20) {
    MemoryStatistics memory;
    memory.counts.cycles = {background, initialize, lanw, law, rcnw, rcw, 0};
    EXPECT_EQ(memory.counts.writes(), cycles);
    statistics.memories.push_back(memory);
  }
  for (const auto& [sampled, tiled] : kTable22)
    statistics.tilers.push_back({.triangles = 500, .samples = sampled, .pixels = tiled});
  return statistics;
}

bool hasRow(const std::string& text, const std::vector<std::string>& words) {
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    std::istringstream line(text.substr(begin, end - begin));
    std::vector<std::string> found{std::istream_iterator<std::string>(line), {}};
    if (found == words) return true;
    begin = end + 1;
  }
  return false;
}

TEST(ControlStatusBoard, prints_the_reports_tables_from_its_counts) {
  const std::string text = statisticsText(reportedFrame(), {});
  EXPECT_TRUE(hasRow(text, {"0", "30377", "19603", "0", "3156", "3970", "1750", "1898", "0.927"})) << text;
  EXPECT_TRUE(hasRow(text, {"2", "30393", "19362", "0", "3157", "4122", "1696", "2056", "0.927"}));
  EXPECT_TRUE(hasRow(text, {"6", "30502", "19737", "0", "3156", "3953", "1794", "1862", "0.930"}));
  EXPECT_TRUE(hasRow(text, {"TOTAL", "MEMORY", "CYCLES", "=", "243607"}));
  EXPECT_TRUE(hasRow(text, {"SYSTEM", "DEPTH", "COMPLEXITY", "=", "0.929"}));
  EXPECT_TRUE(hasRow(text, {"DISTRIBUTION", "TREE", "MODE", "=", "SCRAMBLE"}));
  EXPECT_TRUE(hasRow(text, {"AVERAGE", "MEMORY", "CYCLE", "=", "168.58", "NS"}));
  EXPECT_TRUE(hasRow(text, {"1", "500", "86584", "61086", "122.172", "70.551"}));
  EXPECT_TRUE(hasRow(text, {"3", "500", "83547", "59815", "119.630", "71.594"}));
  EXPECT_TRUE(hasRow(text, {"TOTAL", "2000", "345040", "243606", "121.803", "70.602"}));
  EXPECT_TRUE(hasRow(text, {"AVERAGE", "TRIANGLE", "SIZE", "=", "122", "PIXELS"}));
}

// Report: cycles / 32,768, the fourth digit cut off.
TEST(ControlStatusBoard, cuts_depth_complexity_off) {
  EXPECT_EQ(depthComplexity(30'408, 32'768), 0.927);  // .92798
  EXPECT_EQ(depthComplexity(5, 0), 0);
}

TEST(ControlStatusBoard, says_everything_in_json) {
  MachineConfiguration configuration;
  configuration.unavailable = {3};
  const PassStatistics statistics = someFrame(configuration);
  const Json json = Json::parse(statisticsJson(statistics, configuration));
  EXPECT_EQ(json["configuration"]["mode"], "scramble");
  EXPECT_EQ(json["configuration"]["unavailable"], Json::array({3}));
  ASSERT_EQ(json["memories"].size(), 8U);
  ASSERT_EQ(json["tilers"].size(), 4U);
  std::int64_t cycles = 0, tiled = 0;
  const auto duration = json["duration_ps"].get<std::int64_t>();
  for (const Json& memory : json["memories"]) {
    cycles += memory["cycles"].get<std::int64_t>();
    EXPECT_EQ(memory["busy_ps"].get<std::int64_t>() + memory["starved_ps"].get<std::int64_t>(), duration);
  }
  for (const Json& tiler : json["tilers"]) {
    tiled += tiler["pixels_tiled"].get<std::int64_t>();
    const Json& tiling = tiler["tiling"];
    EXPECT_EQ(tiling["busy_ps"].get<std::int64_t>() + tiling["starved_ps"].get<std::int64_t>() +
                  tiling["blocked_ps"].get<std::int64_t>(),
              duration);
  }
  EXPECT_EQ(cycles, tiled);
  EXPECT_EQ(json["memory_totals"]["cycles"], cycles);
  EXPECT_EQ(json["tiler_totals"]["pixels_tiled"], tiled);
  ASSERT_EQ(json["tree"]["levels"].size(), 3U);
  EXPECT_EQ(json["tree"]["levels"][0]["cells"], "split");
  EXPECT_EQ(json["tree"]["levels"][2]["queues"].size(), 8U);
  std::int64_t at_all_lengths = 0;
  for (const Json& at_length : json["tree"]["levels"][2]["queues"][0]["cycles_at_length"])
    at_all_lengths += at_length.get<std::int64_t>();
  EXPECT_EQ(at_all_lengths, json["tree"]["cycles"]);
}

TEST(ControlStatusBoard, prints_what_nothing_was_drawn_for) {
  Machine machine = Machine::make({}).value();
  const RecordedPixels nothing;
  const PassStatistics statistics = machine.runTimed(nothing).value();
  EXPECT_NE(statisticsText(statistics, {}).find("TRIANGLES TILED = 0"), std::string::npos);
  EXPECT_EQ(Json::parse(statisticsJson(statistics, {}))["pixels"], 0);
}

}  // namespace
}  // namespace deltaz::ars
