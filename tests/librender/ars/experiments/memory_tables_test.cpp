#include "librender/ars/experiments/memory_tables.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <string>

namespace deltaz::ars {
namespace {

using Rows = std::map<std::string, ReportRow>;

Rows byId(const std::vector<ReportRow>& list) {
  Rows rows;
  for (const ReportRow& row : list)
    EXPECT_TRUE(rows.emplace(row.id, row).second) << row.id << " is there twice";
  return rows;
}

// Each cycle's share of Table 20 to two per cent of all cycles, though the report does not say what depths it
// drew; average and depth complexity closer.
TEST(MemoryTables, table_20_comes_out_of_random_triangles) {
  const Rows rows = byId(table20Rows());
  EXPECT_NEAR(rows.at("table20.cycles").ratio().value(), 1, 0.02);
  EXPECT_NEAR(rows.at("table20.average_cycle").ratio().value(), 1, 0.005);
  EXPECT_NEAR(rows.at("table20.average_cycle").published.value(), 168.58, 0.005);
  EXPECT_NEAR(rows.at("table20.saving").ours, 19.7, 0.05);
  EXPECT_NEAR(rows.at("table20.unevenness").ours, 1.008, 0.01);
  for (const char* cycle : {"initialize", "look_ahead_no_write", "look_ahead_write", "read_compare_no_write",
                            "read_compare_write", "background"}) {
    const ReportRow& row = rows.at(std::string("table20.") + cycle + "_percent");
    EXPECT_NEAR(row.ours, row.published.value(), 2) << cycle;
  }
}

TEST(MemoryTables, table_19_is_the_reports) {
  for (const ReportRow& row : table19Rows()) EXPECT_EQ(row.ratio(), 1) << row.id;
}

// Digest 7: 36, 16.6 and 7.7 at 1, 2 and 3 memories; report: about sixteen.
TEST(MemoryTables, bursts_need_queues_of_about_sixteen) {
  const Rows rows = byId(figure29Rows());
  EXPECT_NEAR(rows.at("figure29.model.4x8.sigma_1.level_2").ours, 36, 1);
  EXPECT_NEAR(rows.at("figure29.model.4x8.sigma_2.level_2").ours, 16.6, 1);
  EXPECT_NEAR(rows.at("figure29.model.4x8.sigma_3.level_2").ours, 7.7, 1);
  EXPECT_EQ(rows.at("figure29.model.4x8.sigma_2.level_2").published, 16);
}

// Report 7.1.1.2: variable lengths keep the average even whatever the depth complexity; simpler designs do
// not.
TEST(MemoryTables, only_variable_cycles_stay_even_with_depth_complexity) {
  const Rows rows = byId(figure84And85Rows());
  const auto grown = [&rows](const std::string& design) {
    return rows.at("figure85.8000." + design).ours - rows.at("figure85.500." + design).ours;
  };
  EXPECT_LT(std::abs(grown("variable")), 4);
  EXPECT_GT(grown("no_early_end"), 15);
  EXPECT_GT(grown("no_look_ahead"), 20);
  EXPECT_EQ(grown("fixed"), 0);
  EXPECT_NEAR(rows.at("figure85.table20.no_early_end").ours, 176.3, 0.05);
  EXPECT_NEAR(rows.at("figure85.table20.no_look_ahead").ours, 181.0, 0.05);
}

TEST(MemoryTables, contention_is_the_reports_but_for_interleave_and_40_million_pixels) {
  const Rows rows = byId(figure91And92Rows());
  EXPECT_EQ(rows.at("figure91.sequential.100").ours, 256);
  for (const char* clock : {"25", "50", "75", "100"})
    EXPECT_LE(rows.at(std::string("figure91.scramble.") + clock).ours, 3);
  EXPECT_GT(rows.at("figure91.interleave.100").ours, 10 * rows.at("figure91.interleave.25").ours);
  EXPECT_LT(rows.at("throughput.scramble").ratio().value(), 0.75);
  EXPECT_GT(rows.at("figure92.sequential.memory_3").ours, 80'000);
}

// Report 4.3.3.3: bursts cost some of the tilers, the more the fewer memories they fall on; a larger network
// loses a larger share to bursts on as many memories.
TEST(MemoryTables, bursts_leave_fewer_effective_tilers) {
  const Rows rows = byId(figure30Rows());
  EXPECT_EQ(rows.size(), 24u);
  for (const char* kind : {"model", "tree"}) {
    for (const int tilers : {2, 4, 8, 16}) {
      double before = 0;
      for (const int sigma : {1, 2, 3}) {
        const double effective = rows.at(fmt::format("figure30.{}.sigma_{}.{}", kind, sigma, tilers)).ours;
        EXPECT_GT(effective, 1) << kind << tilers;
        EXPECT_LT(effective, tilers) << kind << tilers;
        // In the smallest network a scatter goes round the end and is even at once.
        if (tilers > 2) {
          EXPECT_GT(effective, before) << kind << tilers;
        }
        before = effective;
      }
    }
    const auto share = [&](int tilers) {
      return rows.at(fmt::format("figure30.{}.sigma_2.{}", kind, tilers)).ours / tilers;
    };
    EXPECT_GT(share(4), share(8));
    EXPECT_GT(share(8), share(16));
  }
}

// Digest 13: 456,131 pixels, 60.0 ms undersampled, 53.1 ms oversampled, memories 9.6 ms.
TEST(MemoryTables, table_25_is_bound_by_set_up) {
  const Rows rows = byId(table25Rows());
  for (const char* mode : {"undersample", "oversample"})
    EXPECT_NEAR(rows.at(std::string("table25.") + mode + ".depth_complexity").ratio().value(), 1, 0.01)
        << mode;
  EXPECT_NEAR(rows.at("table25.undersample.frame").ours, 60.0, 0.3);
  EXPECT_NEAR(rows.at("table25.oversample.frame").ours, 53.1, 0.3);
  EXPECT_NEAR(rows.at("table25.undersample.memory_busy").ours, 9.6, 0.4);
}

}  // namespace
}  // namespace deltaz::ars
