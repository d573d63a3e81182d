// The antialiaser that the report designed and did not build (4.4): reads 512 x 512 colours once, line by
// line, at 10 MHz, and gives 256 x 256. Level 1 filters across; level 2 filters what level 1 gives down the
// columns, through delay registers of 256 and 512 stages. Row 0 and column 0 are copies of row 1 and
// column 1.
//
// To the last bit what filtered() makes with the kernel "report"; this one shows when.
// Thread-safety: one thread an antialiaser.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

inline constexpr int kAntialiaserLatency = 514;  // inputs before the first output, its own included

class Antialiaser {
 public:
  // The next colour; sometimes the next pixel of the picture. After 512 x 512 colours a new picture begins.
  std::optional<std::uint8_t> put(std::uint8_t color);

 private:
  static constexpr int kPixels = kScreenPixels / 2;
  static constexpr std::uint8_t combine(int a, int b, int c) {
    return static_cast<std::uint8_t>((((a + c) >> 1) + b) >> 1);
  }

  int i_ = 0, j_ = 0;  // of the next colour
  std::uint8_t before_ = 0, last_ = 0;
  std::array<std::uint8_t, kPixels> delay_256_{},
      delay_512_{};  // level 1 of the last line and the one before
};

}  // namespace deltaz::ars
