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
// kSteps equal intervals of linear light the code at its beginning.
struct EncodingTable {
  static constexpr int kSteps = 4096;
  std::array<double, 257> border{};  // code c covers border[c] .. border[c + 1]
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
};

const EncodingTable& encodingTable() {
  static const EncodingTable table;
  return table;
}

}  // namespace

std::uint8_t encodeSrgb(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  const EncodingTable& table = encodingTable();
  std::size_t code = table.first_code[static_cast<std::size_t>(linear * EncodingTable::kSteps)];
  while (linear >= table.border[code + 1]) ++code;
  return static_cast<std::uint8_t>(code);
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
