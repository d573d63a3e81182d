#include "librender/ars/memory/memory_cycles.h"

namespace deltaz::ars {

namespace {

constexpr std::array<std::string_view, kMemoryCycleCount> kCycleNames = {
    "background",         "initialize", "look-ahead no-write", "look-ahead write", "read-compare no-write",
    "read-compare write", "read"};
constexpr std::array<std::string_view, kMemoryDesigns.size()> kDesignNames = {"variable", "no-early-end",
                                                                              "no-look-ahead", "fixed"};

}  // namespace

std::string_view memoryCycleName(MemoryCycle cycle) {
  return kCycleNames[static_cast<std::size_t>(cycle)];
}

std::string_view memoryDesignName(MemoryDesign design) {
  return kDesignNames[static_cast<std::size_t>(design)];
}

std::optional<MemoryDesign> memoryDesignNamed(std::string_view name) {
  for (const MemoryDesign design : kMemoryDesigns)
    if (memoryDesignName(design) == name) return design;
  return std::nullopt;
}

CycleLengths cycleLengths(MemoryDesign design) {
  // BG, INIT, LANW, LAW, RCNW, RCW, READ
  switch (design) {
    case MemoryDesign::kVariable:
      break;
    case MemoryDesign::kNoEarlyEnd:
      return {{115, 165, 190, 190, 210, 210, 240}};
    case MemoryDesign::kNoLookAhead:
      return {{115, 165, 210, 210, 210, 210, 240}};
    case MemoryDesign::kFixed:
      return {{210, 210, 210, 210, 210, 210, 240}};
  }
  return {{115, 165, 150, 190, 170, 210, 240}};
}

double averageCycle(const CycleCounts& counts, const CycleLengths& lengths) {
  std::int64_t cycles = 0, nanoseconds = 0;
  for (std::size_t k = 0; k < kWriteCycleCount; ++k) {
    cycles += counts[k];
    nanoseconds += counts[k] * lengths.nanoseconds[k];
  }
  return cycles > 0 ? static_cast<double>(nanoseconds) / static_cast<double>(cycles) : 0;
}

}  // namespace deltaz::ars
