// Colours as the engines compute with them: linear light, doubles, 1 = white. Encoded once, at the end.
// Thread-safety: plain values and pure functions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace deltaz {

struct LinearColor {
  double red = 0, green = 0, blue = 0;
};

// A colour that covers part of what it stands on: each component times the cover, cover 0 .. 1.
struct CoveredColor {
  double red = 0, green = 0, blue = 0, cover = 0;
};

inline LinearColor operator+(const LinearColor& a, const LinearColor& b) {
  return {a.red + b.red, a.green + b.green, a.blue + b.blue};
}
inline LinearColor operator*(const LinearColor& a, double s) {
  return {a.red * s, a.green * s, a.blue * s};
}
// a where t = 0, b where t = 1.
inline LinearColor mix(const LinearColor& a, const LinearColor& b, double t) {
  return a * (1 - t) + b * t;
}

// 0 at or below `low`, 1 at or above `high`, smooth between (cubic). Pre: low < high.
inline double smoothStep(double low, double high, double x) {
  const double t = x <= low ? 0.0 : x >= high ? 1.0 : (x - low) / (high - low);
  return t * t * (3 - 2 * t);
}

// The sRGB code (IEC 61966-2-1) nearest to a linear value, in code space; values outside 0 .. 1 are clamped.
std::uint8_t encodeSrgb(double linear);
// The same of `count` colours; `codes` become red, green, blue of each.
void encodeSrgb(const double* red, const double* green, const double* blue, std::size_t count,
                std::uint8_t* codes);
// The linear value of an sRGB code.
double decodeSrgb(std::uint8_t code);
// The same, from a table.
double linearOfSrgb(std::uint8_t code);

}  // namespace deltaz
