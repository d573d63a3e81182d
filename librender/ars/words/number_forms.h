// What the report leaves open about its numbers (Table 8 gives widths and no more), as names.
#pragma once

#include <cstdint>

namespace deltaz::ars {

enum class SignForm : std::uint8_t { kSignMagnitude, kTwosComplement };

// The leading one of a normalised mantissa: written (0.1mmm, a fraction) or hidden (1.mmm).
enum class LeadingOne : std::uint8_t { kWritten, kHidden };

// Bits beyond the last kept: nearest (ties to even), or dropped, which is towards zero in sign and magnitude
// and downwards in two's complement.
enum class Rounding : std::uint8_t { kNearest, kTruncate };

}  // namespace deltaz::ars
