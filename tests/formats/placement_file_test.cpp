#include "formats/placement_file.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck/gtest.h>

#include "formats/area.h"
#include "tests/support/byte_changes.h"

namespace deltaz {
namespace {

constexpr std::size_t kModels = 3;

std::vector<Placement> samplePlacements() {
  return {{1, 0, 46.85, -121.76, 4392.5, 90.25, false, 0},
          {7, 2, -90, 180, -430.5, 0, true, 12.5},
          {4000000000, 1, 90, -180, 0, 359.99, true, -1.5}};
}

std::optional<BlockBytes> recodePage(std::span<const std::byte> bytes) {
  const auto placements = decodePlacementPage(bytes, kModels, "test");
  if (!placements.ok()) {
    EXPECT_EQ(placements.error().code, IssueCode::kPlacementRecord);
    return std::nullopt;
  }
  return encodePlacementPage(placements.value());
}

PlacementDirectory sampleDirectory() {
  PlacementDirectory directory;
  directory.count = kPlacementsPerPage + 5;
  directory.next_instance = 100;
  directory.pages = {{{-2304000.5, -3635000.25, 4698000}, 1200}, {{1, 2, 3}, 0}};
  return directory;
}
constexpr std::uint32_t kSampleBlocks = 3;

std::optional<BlockBytes> recodeDirectory(std::span<const std::byte> bytes) {
  const auto directory = decodePlacementDirectory(bytes, kSampleBlocks, "test");
  if (!directory.ok()) {
    EXPECT_EQ(directory.error().code, IssueCode::kPlacementRecord);
    return std::nullopt;
  }
  return encodePlacementDirectory(directory.value());
}

TEST(PlacementPage, reads_back_exactly_and_has_one_form) {
  const BlockBytes bytes = encodePlacementPage(samplePlacements());
  const auto back = decodePlacementPage(bytes, kModels, "test");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), samplePlacements());
  EXPECT_GT(expectOneForm(bytes, recodePage), 0u);
  for (std::size_t length = 0; length <= bytes.size() + 1; ++length) {
    BlockBytes cut = bytes;
    cut.resize(length);
    const bool whole = length > 0 && length <= bytes.size() && length % (bytes.size() / 3) == 0;
    EXPECT_EQ(recodePage(cut).has_value(), whole) << length;
  }
}

RC_GTEST_PROP(PlacementPage, placements_read_back_exactly, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, kPlacementsPerPage + 1);
  const auto within = [](int limit) { return *rc::gen::inRange(-limit, limit + 1) / 1024.0; };
  std::vector<Placement> placements(count);
  for (Placement& placement : placements) {
    placement.instance = *rc::gen::inRange<std::uint32_t>(1, 1u << 31);
    placement.model = *rc::gen::inRange<std::uint32_t>(0, kModels);
    placement.latitude = within(90 * 1024);
    placement.longitude = within(180 * 1024);
    placement.height = within(9000 * 1024);
    placement.heading = std::abs(within(359 * 1024));
    placement.on_ground = *rc::gen::arbitrary<bool>();
    placement.above_ground = placement.on_ground ? within(500 * 1024) : 0.0;
  }
  const auto back = decodePlacementPage(encodePlacementPage(placements), kModels, "test");
  RC_ASSERT(back.ok());
  RC_ASSERT(back.value() == placements);
}

TEST(PlacementPage, values_out_of_range_are_refused) {
  const auto accepted = [](const std::function<void(Placement&)>& change) {
    Placement placement = samplePlacements()[1];
    change(placement);
    return decodePlacementPage(encodePlacementPage(std::span(&placement, 1)), kModels, "test").ok();
  };
  EXPECT_TRUE(accepted([](auto&) {}));
  EXPECT_FALSE(accepted([](auto& p) { p.instance = 0; }));
  EXPECT_FALSE(accepted([](auto& p) { p.model = kModels; }));
  EXPECT_FALSE(accepted([](auto& p) { p.heading = 360; }));
  EXPECT_FALSE(accepted([](auto& p) { p.heading = -0.001; }));
  EXPECT_FALSE(accepted([](auto& p) { p.latitude = 90.0000001; }));
  EXPECT_FALSE(accepted([](auto& p) { p.longitude = -180.0000001; }));
  EXPECT_FALSE(accepted([](auto& p) { p.height = 2 * kMaximumHeightMetres; }));
  EXPECT_FALSE(accepted([](auto& p) { p.on_ground = false; })) << "above the ground without following it";
  for (const double odd :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(accepted([&](auto& p) { p.latitude = odd; }));
    EXPECT_FALSE(accepted([&](auto& p) { p.longitude = odd; }));
    EXPECT_FALSE(accepted([&](auto& p) { p.height = odd; }));
    EXPECT_FALSE(accepted([&](auto& p) { p.heading = odd; }));
    EXPECT_FALSE(accepted([&](auto& p) { p.above_ground = odd; }));
  }
}

TEST(PlacementPage, more_placements_than_a_page_holds_are_refused) {
  const std::vector<Placement> placements(kPlacementsPerPage, samplePlacements()[0]);
  BlockBytes bytes = encodePlacementPage(placements);
  EXPECT_TRUE(recodePage(bytes).has_value());
  const BlockBytes one = encodePlacementPage(std::span(placements).first(1));
  bytes.insert(bytes.end(), one.begin(), one.end());
  EXPECT_FALSE(recodePage(bytes).has_value());
}

TEST(PlacementDirectory, reads_back_exactly_and_has_one_form) {
  const BlockBytes bytes = encodePlacementDirectory(sampleDirectory());
  const auto back = decodePlacementDirectory(bytes, kSampleBlocks, "test");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), sampleDirectory());
  expectCutsRefused(bytes, recodeDirectory);
  EXPECT_GT(expectOneForm(bytes, recodeDirectory), 0u);
}

TEST(PlacementDirectory, one_without_placements_reads_back) {
  const PlacementDirectory empty{0, 17, {}};
  const auto back = decodePlacementDirectory(encodePlacementDirectory(empty), 1, "test");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back.value(), empty);
}

TEST(PlacementDirectory, counts_must_be_those_of_the_file) {
  const auto accepted = [](const std::function<void(PlacementDirectory&)>& change,
                           std::uint32_t blocks = kSampleBlocks) {
    PlacementDirectory directory = sampleDirectory();
    change(directory);
    return decodePlacementDirectory(encodePlacementDirectory(directory), blocks, "test").ok();
  };
  EXPECT_TRUE(accepted([](auto&) {}));
  EXPECT_FALSE(accepted([](auto&) {}, 2));
  EXPECT_FALSE(accepted([](auto&) {}, 0));
  EXPECT_FALSE(accepted([](auto& d) { d.count = kPlacementsPerPage; })) << "a page too many";
  EXPECT_FALSE(accepted([](auto& d) { d.count = 2 * kPlacementsPerPage + 1; })) << "a page too few";
  EXPECT_TRUE(accepted([](auto& d) { d.next_instance = d.count + 1; }));
  EXPECT_FALSE(accepted([](auto& d) { d.next_instance = d.count; })) << "fewer numbers than placements";
  EXPECT_FALSE(accepted([](auto& d) { d.next_instance = 0; }));
  EXPECT_FALSE(accepted([](auto& d) { d.pages[0].radius = -1; }));
  EXPECT_FALSE(accepted([](auto& d) { d.pages[0].radius = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_FALSE(accepted([](auto& d) { d.pages[1].centre[2] = std::numeric_limits<double>::infinity(); }));
}

}  // namespace
}  // namespace deltaz
