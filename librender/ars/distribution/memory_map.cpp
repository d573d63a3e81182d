#include "librender/ars/distribution/memory_map.h"

#include <array>
#include <bit>
#include <cassert>
#include <utility>

namespace deltaz::ars {

namespace {

constexpr std::array<std::pair<HashingMode, std::string_view>, 3> kNames = {
    {{HashingMode::kSequential, "sequential"},
     {HashingMode::kInterleave, "interleave"},
     {HashingMode::kScramble, "scramble"}}};

}  // namespace

std::string_view hashingModeName(HashingMode mode) {
  return kNames[static_cast<std::size_t>(mode)].second;
}

std::optional<HashingMode> hashingModeNamed(std::string_view name) {
  for (const auto& [mode, known] : kNames)
    if (known == name) return mode;
  return std::nullopt;
}

MemoryMap::MemoryMap(int memories, HashingMode mode)
    : mode_(mode), bits_(std::countr_zero(static_cast<unsigned>(memories))), mask_(memories - 1) {
  assert(memories >= 1 && memories <= kMaximumMemories &&
         std::has_single_bit(static_cast<unsigned>(memories)));
  inverse_of_3_ = 1;
  while ((3 * inverse_of_3_ & mask_) != (1 & mask_)) inverse_of_3_ += 2;
}

MemoryMap::Place MemoryMap::place(int memory, int address) const {
  switch (mode_) {
    case HashingMode::kSequential: {
      const int line_bits = kLineBits - bits_;
      return {.i = memory << line_bits | address / kScreenPixels, .j = address % kScreenPixels};
    }
    case HashingMode::kInterleave:
      return {.i = address / kScreenPixels << bits_ | memory, .j = address % kScreenPixels};
    case HashingMode::kScramble:
      break;
  }
  const int columns = kScreenPixels >> bits_;
  const int i = address / columns;
  return {.i = i, .j = address % columns << bits_ | (inverse_of_3_ * (memory - i) & mask_)};
}

}  // namespace deltaz::ars
