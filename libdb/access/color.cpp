#include "libdb/access/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libdb/access/color.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_COLOR_SCALE
#define DELTAZ_COLOR_SCALE
namespace deltaz {
namespace {

// Linear light in integers.
constexpr int kLightBits = 30;
constexpr double kLightScale = 1 << kLightBits, kWhiteLight = kLightScale - 1;

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// EncodingTable::scaled of each; nothing is read or written behind the last.
void scaleLight(const double* linear, std::size_t count, std::int32_t* out) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const auto zero = hn::Zero(d), scale = hn::Set(d, kLightScale), white = hn::Set(d, kWhiteLight);
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t n = 0; n < count; n += lanes) {
    double rest[8] = {};
    const bool whole = n + lanes <= count;
    if (!whole) std::copy(linear + n, linear + count, rest);
    const auto value = hn::Mul(hn::LoadU(d, whole ? linear + n : rest), scale);
    // What is not a number is not greater.
    const auto kept = hn::Min(hn::IfThenElseZero(hn::Gt(value, zero), value), white);
    const auto scaled = hn::DemoteTo(di, kept);
    if (whole) {
      hn::StoreU(scaled, di, out + n);
      continue;
    }
    std::int32_t last[8];
    hn::StoreU(scaled, di, last);
    std::copy_n(last, count - n, out + n);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(scaleLight);

double linearOfEncoded(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

// Encoding by comparison instead of by std::pow, in integers: a code's lower border in linear light, and for
// each of kSteps equal intervals of linear light, none of which holds two borders, the code at its beginning.
struct EncodingTable {
  static constexpr int kSteps = 4096, kStepBits = kLightBits - 12;
  std::array<std::uint32_t, 257> border{};  // code c covers border[c] .. border[c + 1], in 2^-30
  std::array<std::uint8_t, kSteps> first_code{};

  EncodingTable() {
    border[0] = 0;
    for (int code = 1; code < 256; ++code)
      border[static_cast<std::size_t>(code)] =
          static_cast<std::uint32_t>(std::ceil(linearOfEncoded((code - 0.5) / 255.0) * kLightScale));
    border[256] = 0xFFFFFFFF;
    std::size_t code = 0;
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      while (step << kStepBits >= border[code + 1]) ++code;
      first_code[step] = static_cast<std::uint8_t>(code);
    }
  }

  // Linear light in 2^-30, kept within 0 and just below 1; 0 of what is not a number.
  static std::int32_t scaled(double linear) {
    const double value = linear * kLightScale, kept = value > 0 ? value : 0;
    return static_cast<std::int32_t>(kept < kWhiteLight ? kept : kWhiteLight);
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
    HWY_DYNAMIC_DISPATCH(scaleLight)(red + first, left, light[0].data());
    HWY_DYNAMIC_DISPATCH(scaleLight)(green + first, left, light[1].data());
    HWY_DYNAMIC_DISPATCH(scaleLight)(blue + first, left, light[2].data());
    std::uint8_t* const to = codes + 3 * first;
    for (std::size_t n = 0; n < left; ++n) {
      to[3 * n] = table.codeOf(light[0][n]);
      to[3 * n + 1] = table.codeOf(light[1][n]);
      to[3 * n + 2] = table.codeOf(light[2][n]);
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
#endif
