// The libFuzzer entry of one target, chosen when this is compiled.
#include <cstdint>
#include <string_view>

#include "tests/fuzz/targets.h"

namespace {

const deltaz::FuzzTarget& target() {
  for (const deltaz::FuzzTarget& candidate : deltaz::fuzzTargets()) {
    if (std::string_view(candidate.name) == DELTAZ_FUZZ_TARGET) return candidate;
  }
  __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const deltaz::FuzzTarget& kTarget = target();
  kTarget.run(std::as_bytes(std::span(data, size)));
  return 0;
}
