#include "libdb/access/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace deltaz {
namespace {

double linearOfEncoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Encoding by comparison instead of by std::pow, in integers: a code's lower border in linear light, and for
// each of kSteps equal intervals of linear light, none of which holds two borders, the code at its beginning.
struct EncodingTable {
  static constexpr int kSteps = 4096, kScaleBits = 30, kStepBits = kScaleBits - 12;
  std::array<std::uint32_t, 257> border{};  // code c covers border[c] .. border[c + 1], in 2^-30
  std::array<std::uint8_t, kSteps> first_code{};

  EncodingTable() {
    constexpr double kScale = 1 << kScaleBits;
    border[0] = 0;
    for (int code = 1; code < 256; ++code)
      border[static_cast<std::size_t>(code)] =
          static_cast<std::uint32_t>(std::ceil(linearOfEncoded((code - 0.5) / 255.0) * kScale));
    border[256] = 0xFFFFFFFF;
    std::size_t code = 0;
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      while (step << kStepBits >= border[code + 1]) ++code;
      first_code[step] = static_cast<std::uint8_t>(code);
    }
  }

  // Linear light in 2^-30, kept within 0 and just below 1; 0 of what is not a number.
  static std::int32_t scaled(double linear) {
    constexpr double kScale = 1 << kScaleBits, kWhite = kScale - 1;
    const double value = linear * kScale, kept = value > 0 ? value : 0;
    return static_cast<std::int32_t>(kept < kWhite ? kept : kWhite);
  }
  std::uint8_t codeOf(std::int32_t light) const {
    const auto value = static_cast<std::uint32_t>(light);
    const std::size_t code = first_code[value >> kStepBits];
    return static_cast<std::uint8_t>(code + (value >= border[code + 1] ? 1 : 0));
  }
  std::uint8_t encode(double linear) const { return codeOf(scaled(linear)); }
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
  constexpr std::size_t kAtOnce = 64;
  std::array<std::array<std::int32_t, kAtOnce>, 3> light;
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    const std::size_t left = std::min(kAtOnce, count - first);
    const auto scale = [&](const double* linear, std::array<std::int32_t, kAtOnce>& out) {
      for (std::size_t n = 0; n < left; ++n) out[n] = EncodingTable::scaled(linear[first + n]);
    };
    scale(red, light[0]);
    scale(green, light[1]);
    scale(blue, light[2]);
    std::uint8_t* const to = codes + 3 * first;
    for (std::size_t n = 0; n < left; ++n) {
      for (std::size_t c = 0; c < 3; ++c) to[3 * n + c] = table.codeOf(light[c][n]);
    }
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
