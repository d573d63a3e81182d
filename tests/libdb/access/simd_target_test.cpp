#include "libdb/access/simd_target.h"

#include <gtest/gtest.h>

namespace deltaz {
namespace {

TEST(simd_target, names_are_found_again) {
  for (const SimdTarget target :
       {SimdTarget::kPortable, SimdTarget::kSse4, SimdTarget::kAvx2, SimdTarget::kAvx512})
    EXPECT_EQ(simdTargetNamed(simdTargetName(target)), target);
  EXPECT_EQ(simdTargetNamed("mmx"), std::nullopt);
}

TEST(simd_target, every_processor_runs_the_portable_code) {
  ASSERT_FALSE(simdTargets().empty());
  EXPECT_EQ(simdTargets().front(), SimdTarget::kPortable);
}

TEST(simd_target, a_limit_can_be_set_and_lifted) {
  const std::vector<SimdTarget> before = simdTargets();
  for (const SimdTarget target : before) EXPECT_TRUE(limitSimdTarget(target));
  EXPECT_TRUE(limitSimdTarget(std::nullopt));
  EXPECT_EQ(simdTargets(), before);
}

}  // namespace
}  // namespace deltaz
