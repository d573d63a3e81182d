#include "libdb/access/simd_target.h"

#include <algorithm>
#include <array>
#include <hwy/targets.h>

namespace deltaz {
namespace {

struct Named {
  SimdTarget target;
  std::string_view name;
  std::int64_t bit;  // Highway's
};

constexpr std::array<Named, 4> kTargets = {{{SimdTarget::kPortable, "portable", HWY_STATIC_TARGET},
                                            {SimdTarget::kSse4, "sse4", HWY_SSE4},
                                            {SimdTarget::kAvx2, "avx2", HWY_AVX2},
                                            {SimdTarget::kAvx512, "avx512", HWY_AVX3}}};

}  // namespace

std::string_view simdTargetName(SimdTarget target) {
  for (const Named& named : kTargets) {
    if (named.target == target) return named.name;
  }
  return "";
}

std::optional<SimdTarget> simdTargetNamed(std::string_view name) {
  for (const Named& named : kTargets) {
    if (named.name == name) return named.target;
  }
  return std::nullopt;
}

std::vector<SimdTarget> simdTargets() {
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t supported = hwy::SupportedTargets();
  std::vector<SimdTarget> targets;
  for (const Named& named : kTargets) {
    if ((supported & named.bit) != 0) targets.push_back(named.target);
  }
  return targets;
}

bool limitSimdTarget(std::optional<SimdTarget> target) {
  const std::vector<SimdTarget> supported = simdTargets();
  if (!target) {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return true;
  }
  if (std::find(supported.begin(), supported.end(), *target) == supported.end()) return false;
  for (const Named& named : kTargets) {
    if (named.target != *target) continue;
    hwy::SetSupportedTargetsForTest(named.bit);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  return true;
}

}  // namespace deltaz
