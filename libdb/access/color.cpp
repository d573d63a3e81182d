#include "libdb/access/color.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace deltaz {
namespace {

double linearOfEncoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Encoding by comparison instead of by std::pow: a code's lower border in linear light, and for each of
// kSteps equal intervals of linear light, none of which holds two borders, the code at its beginning.
struct EncodingTable {
  static constexpr int kSteps = 4096;
  static constexpr double kWhite = 1 - 1.0 / 8192;  // has the code of 1
  std::array<double, 257> border{};                 // code c covers border[c] .. border[c + 1]
  std::array<std::uint8_t, kSteps> first_code{};

  EncodingTable() {
    border[0] = 0;
    for (int code = 1; code < 256; ++code) {
      border[static_cast<std::size_t>(code)] = linearOfEncoded((code - 0.5) / 255.0);
    }
    border[256] = 2;  // above every clamped value
    std::size_t code = 0;
    for (int step = 0; step < kSteps; ++step) {
      while (static_cast<double>(step) / kSteps >= border[code + 1]) ++code;
      first_code[static_cast<std::size_t>(step)] = static_cast<std::uint8_t>(code);
    }
  }

  std::uint8_t encode(double linear) const {
    // Also of what is not a number.
    const double kept = linear > 0 ? linear < kWhite ? linear : kWhite : 0;
    const std::size_t code = first_code[static_cast<std::size_t>(kept * kSteps)];
    return static_cast<std::uint8_t>(code + (kept >= border[code + 1] ? 1 : 0));
  }
};

const EncodingTable& encodingTable() {
  static const EncodingTable table;
  return table;
}

}  // namespace

std::uint8_t encodeSrgb(double linear) {
  return encodingTable().encode(linear);
}

void encodeSrgb(const double* red, const double* green, const double* blue, std::size_t count,
                std::uint8_t* codes) {
  const EncodingTable& table = encodingTable();
  for (std::size_t n = 0; n < count; ++n) {
    codes[3 * n] = table.encode(red[n]);
    codes[3 * n + 1] = table.encode(green[n]);
    codes[3 * n + 2] = table.encode(blue[n]);
  }
}

double decodeSrgb(std::uint8_t code) {
  return linearOfEncoded(code / 255.0);
}

double linearOfSrgb(std::uint8_t code) {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> values{};
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = decodeSrgb(static_cast<std::uint8_t>(k));
    return values;
  }();
  return table[code];
}

}  // namespace deltaz
