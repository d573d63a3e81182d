// Which lanes come first when those with a bit set move to the front: a row for each set of bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace deltaz {

template <std::size_t kLanes>
constexpr auto compactionPlaces() {
  std::array<std::array<std::uint8_t, kLanes>, 1 << kLanes> rows{};
  for (std::size_t bits = 0; bits < rows.size(); ++bits) {
    std::size_t count = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if ((bits >> lane & 1) != 0) rows[bits][count++] = static_cast<std::uint8_t>(lane);
    }
  }
  return rows;
}

inline constexpr auto kPlacesOf4 = compactionPlaces<4>();
inline constexpr auto kPlacesOf8 = compactionPlaces<8>();

}  // namespace deltaz
