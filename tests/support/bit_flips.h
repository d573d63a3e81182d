// Which bits a test of flipped bits takes: two of every byte, other ones from byte to byte, or as many as
// DELTAZ_SOAK_FLIPS says, at most all 8 (scripts/soak.sh).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace deltaz {

inline std::size_t flipsOfByte() {
  const char* const text = std::getenv("DELTAZ_SOAK_FLIPS");
  return text == nullptr ? 2 : std::clamp<std::size_t>(std::strtoul(text, nullptr, 10), 1, 8);
}

// The bit of the file that flip `n` takes, for n below its bytes times flipsOfByte().
inline std::size_t flippedBit(std::size_t n) {
  const std::size_t flips = flipsOfByte(), byte = n / flips;
  return byte * 8 + (byte + n % flips * (8 / flips)) % 8;
}

}  // namespace deltaz
