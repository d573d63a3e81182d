#include "librender/ars/experiments/correction_effects.h"

#include <gtest/gtest.h>
#include <map>

namespace deltaz::ars {
namespace {

double effect(const std::string& id) {
  static const std::vector<ReportRow> kRows = correctionRows();
  for (const ReportRow& row : kRows) {
    if (row.id == "correction." + id) return row.ours;
  }
  ADD_FAILURE() << "no row " << id;
  return -1;
}

// Digest 6.2: shared edges are tiled twice, 21 % of an integer lattice's pixels and 1.1 % of a random mesh's.
TEST(CorrectionEffects, top_left_rule_tiles_shared_edges_once) {
  EXPECT_NEAR(effect("top_left_rule.lattice.off"), 1.2307, 0.0001);
  EXPECT_NEAR(effect("top_left_rule.mesh.off"), 1.011, 0.005);
  EXPECT_EQ(effect("top_left_rule.lattice.on"), 1);
  EXPECT_EQ(effect("top_left_rule.mesh.on"), 1);
}

// Digest 5: grazing terrain, oversampled, has many pixels outside their triangle's depths; undersampled few.
TEST(CorrectionEffects, clamped_depths_stay_with_their_triangle) {
  EXPECT_GT(effect("clamp_depth.oversample.outside.off"), 10);
  EXPECT_GT(effect("clamp_depth.oversample.twentieth.off"), 0.1);
  EXPECT_LT(effect("clamp_depth.undersample.outside.off"), 5);
  for (const char* mode : {"undersample", "oversample"}) {
    for (const char* kind : {"outside", "twentieth", "infinity"})
      EXPECT_EQ(effect(std::string("clamp_depth.") + mode + "." + kind + ".on"), 0) << mode << " " << kind;
  }
}

// Fig 14: the middle of a rod from U = 1 to U = 3 shows at three quarters, and linear shading has made it
// three quarters white.
TEST(CorrectionEffects, true_color_is_linear_in_space) {
  EXPECT_NEAR(effect("true_color.rod.off"), 0.75 * 255, 1);
  EXPECT_NEAR(effect("true_color.rod.on"), 0.5 * 255, 1);
  EXPECT_GT(effect("true_color.largest.off"), 5);
  // Half a code of rounding, and what the planes' 24 bits lose.
  EXPECT_LE(effect("true_color.largest.on"), 0.51);
  EXPECT_LT(effect("true_color.mean.on"), effect("true_color.mean.off"));
}

}  // namespace
}  // namespace deltaz::ars
