// Runs a check on every instruction set of this processor, and lifts the limit afterwards.
#pragma once

#include <gtest/gtest.h>
#include <string>

#include "libdb/access/simd_target.h"

namespace deltaz {

template <typename Check>
void onEverySimdTarget(const Check& check) {
  for (const SimdTarget target : simdTargets()) {
    SCOPED_TRACE(std::string(simdTargetName(target)));
    ASSERT_TRUE(limitSimdTarget(target));
    check();
  }
  limitSimdTarget(std::nullopt);
}

}  // namespace deltaz
