// Which memory holds a pixel, and where in it: the hashing modes of the memory address generator in the
// A-cells (report 4.3.4.1, 7.1.3.1).
//
//   sequential  the upper bits of i: bands of lines, 8 of 64 lines each
//   interleave  the lower bits of i: line by line
//   scramble    (3j + i) mod memories: pixels side by side lie three memories apart
//
// The report has eight memories; the formulas hold for any power of two, 3 being odd. Its figure of the
// scramble is damaged in rows 3 and 4, which follow from the formula.
//
// Inside a memory (ours, the report gives none) the bits of i and j that do not choose it are the address:
// every place of the picture has one address and every address one place. Cost: a few shifts.
// Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

enum class HashingMode : std::uint8_t { kSequential, kInterleave, kScramble };
std::string_view hashingModeName(HashingMode mode);  // "sequential", "interleave", "scramble"
std::optional<HashingMode> hashingModeNamed(std::string_view name);

// Tilers and memories come in powers of two.
inline constexpr int kMaximumTilers = 64, kMaximumMemories = 64;

class MemoryMap {
 public:
  // 1 to kMaximumMemories memories, a power of two.
  MemoryMap(int memories, HashingMode mode);

  int memories() const { return 1 << bits_; }
  int wordsPerMemory() const { return kScreenLines * kScreenPixels >> bits_; }
  HashingMode mode() const { return mode_; }

  // i and j: 0..511.
  int memory(int i, int j) const {
    switch (mode_) {
      case HashingMode::kSequential:
        return i >> (kLineBits - bits_);
      case HashingMode::kInterleave:
        return i & mask_;
      case HashingMode::kScramble:
        break;
    }
    return (3 * j + i) & mask_;
  }
  // In the memory that holds the pixel: 0..wordsPerMemory() - 1.
  int address(int i, int j) const {
    switch (mode_) {
      case HashingMode::kSequential:
        return (i & ((kScreenLines >> bits_) - 1)) * kScreenPixels + j;
      case HashingMode::kInterleave:
        return (i >> bits_) * kScreenPixels + j;
      case HashingMode::kScramble:
        break;
    }
    return i * (kScreenPixels >> bits_) + (j >> bits_);
  }

  struct Place {
    int i = 0, j = 0;
    bool operator==(const Place&) const = default;
  };
  // The place held at an address of a memory.
  Place place(int memory, int address) const;

 private:
  static constexpr int kLineBits = 9;
  HashingMode mode_;
  int bits_, mask_;
  int inverse_of_3_;  // modulo the number of memories
};

}  // namespace deltaz::ars
