// Which vector instructions the inner loops run on. They are compiled for each of the sets below and the
// widest one the processor has is chosen at run time (Highway). Every set gives the same bits: multiplication
// and addition stay unfused, reciprocals are divisions.
//
// limitSimdTarget changes the whole process, for tests and for `dbview --simd`; call it while nothing else of
// the library runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace deltaz {

enum class SimdTarget : std::uint8_t {
  kPortable,
  kSse4,
  kAvx2,
  kAvx512
};  // the last three: 128, 256, 512 bits

// "portable", "sse4", "avx2", "avx512".
std::string_view simdTargetName(SimdTarget target);
std::optional<SimdTarget> simdTargetNamed(std::string_view name);

// The sets this processor has, narrowest first.
std::vector<SimdTarget> simdTargets();

// From now on nothing wider than `target` is used; nullopt lifts the limit. False, and nothing is changed, if
// the processor lacks it.
bool limitSimdTarget(std::optional<SimdTarget> target);

}  // namespace deltaz
