// The cycles of a depth/frame memory module and how long they take (report Table 19), and the designs with
// simpler control that the report sets beside its own (7.1.1.2, Fig 85).
// Thread-safety: plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace deltaz::ars {

enum class MemoryCycle : std::uint8_t {
  kBackground,          // background flag set: written whatever is there
  kInitialize,          // first write since the word was read
  kLookAheadNoWrite,    // the exponents say: farther
  kLookAheadWrite,      // the exponents say: nearer
  kReadCompareNoWrite,  // same exponent, the mantissas say: not nearer
  kReadCompareWrite,    // same exponent, the mantissas say: nearer
  kRead,                // to the antialiaser
};
inline constexpr std::size_t kMemoryCycleCount = 7, kWriteCycleCount = 6;  // all but READ
std::string_view memoryCycleName(MemoryCycle cycle);  // "background", "look-ahead no-write", ...

using CycleCounts = std::array<std::int64_t, kMemoryCycleCount>;  // by MemoryCycle

// Lengths in nanoseconds, by MemoryCycle.
struct CycleLengths {
  std::array<int, kMemoryCycleCount> nanoseconds{};

  int of(MemoryCycle cycle) const { return nanoseconds[static_cast<std::size_t>(cycle)]; }
  bool operator==(const CycleLengths&) const = default;
};

enum class MemoryDesign : std::uint8_t {
  kVariable,     // 1, as built: seven lengths
  kNoEarlyEnd,   // 2: no-write cycles take as long as their write cycles
  kNoLookAhead,  // 3: exponents are not compared first, only INIT and read-compare are left
  kFixed,        // 4: one length, the longest
};
inline constexpr std::array kMemoryDesigns = {MemoryDesign::kVariable, MemoryDesign::kNoEarlyEnd,
                                              MemoryDesign::kNoLookAhead, MemoryDesign::kFixed};
std::string_view memoryDesignName(MemoryDesign design);  // "variable", "no-early-end", ...
std::optional<MemoryDesign> memoryDesignNamed(std::string_view name);

// The report prints the lengths of design 1. Those of the others follow from what it says of them; none
// leaves out BG, and READ is the same in all.
CycleLengths cycleLengths(MemoryDesign design);

// Of the write cycles; 0 if there are none.
double averageCycle(const CycleCounts& counts, const CycleLengths& lengths);  // nanoseconds

}  // namespace deltaz::ars
