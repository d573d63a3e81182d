// How a delta-z array is packed into bytes. What the array means is fixed (terrain_segment.md); this is only
// the packing, and the place where a better one will be added under a new number.
//
// Packing 1, "planes": differences are zigzag coded, split into byte planes, followed by the void mask as
// bits and the kinds of voids as bytes where there are any, and compressed with zstd. Errors: kInvalid with
// kHgtDecode. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/error.h"

namespace deltaz {

enum class DeltaPacking : std::uint8_t { kPlanes = 1 };

struct HeightArray {
  std::uint32_t columns = 0, rows = 0;
  std::vector<std::int32_t> heights;  // row by row from the south-west
  std::vector<std::uint8_t> valid;    // 1 or 0; same shape
  // Kind of each void post (what its source held there), 0 at valid posts; same shape, or empty if all are 0.
  std::vector<std::uint8_t> void_kinds = {};
};

// The delta-z array of `heights`: (0,0) absolute, first column against the south, all else against the west
// neighbour. Pre: size is columns * rows >= 1, heights within 2^30.
std::vector<std::int32_t> differencesOf(std::span<const std::int32_t> heights, std::uint32_t columns,
                                        std::uint32_t rows);
// Its inverse. Sums wrap modulo 2^32, so any input is defined.
std::vector<std::int32_t> sumsOf(std::span<const std::int32_t> differences, std::uint32_t columns,
                                 std::uint32_t rows);

// Gives every void post the height its difference becomes zero with; a leading run takes the first valid
// height.
void fillVoids(HeightArray& array);

std::vector<std::byte> packHeights(const HeightArray& array, DeltaPacking packing);
Result<HeightArray> unpackHeights(std::span<const std::byte> bytes, DeltaPacking packing,
                                  std::uint32_t columns, std::uint32_t rows, const std::string& where);

}  // namespace deltaz
