// Tile accumulate (report 4.2.4.4): depth and colour of a valid pixel, D0 + SDI + SDJ and C0 + SCI + SCJ, by
// two floating-point additions each; displacements are counted in fixed point and rounded to the format
// first. Thread-safety: plain values.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "librender/ars/tiler/tiler_setup.h"

namespace deltaz::ars {

struct PixelValues {
  std::uint32_t depth = 0;
  std::uint8_t color = 0;

  bool operator==(const PixelValues&) const = default;
};

// Sums of steps along one axis: SDI, SCI, or SDJ, SCJ; exact.
struct Displacement {
  double depth = 0, color = 0, color_over_depth = 0;
};

// In the formats of any profile.
class ProfileAccumulator {
 public:
  // Both are referred to, not copied.
  ProfileAccumulator(const TilerSetup& setup, const NumberProfile& numbers)
      : setup_(setup), numbers_(numbers) {}

  PixelValues values(const Displacement& line, const Displacement& pixel) const {
    double depth = sum(numbers_.depth_plane, setup_.depth.start, line.depth, pixel.depth);
    if (setup_.clamp_depth) depth = std::clamp(depth, setup_.least_depth, setup_.greatest_depth);
    double color = 0;
    if (setup_.true_color && depth > 0) {
      color = sum(numbers_.depth_plane, setup_.color_over_depth.start, line.color_over_depth,
                  pixel.color_over_depth) /
              depth;
    } else {
      color = sum(numbers_.color, setup_.color.start, line.color, pixel.color);
    }
    return {.depth = numbers_.depth.encode(depth, numbers_.output), .color = integer(color)};
  }

  void beginLine(int line) {
    line_ = {.depth = line * setup_.depth.line,
             .color = line * setup_.color.line,
             .color_over_depth = line * setup_.color_over_depth.line};
  }
  PixelValues at(int pixel) const {
    return values(line_, {.depth = pixel * setup_.depth.pixel,
                          .color = pixel * setup_.color.pixel,
                          .color_over_depth = pixel * setup_.color_over_depth.pixel});
  }

 private:
  double sum(const FloatFormat& format, double start, double line, double pixel) const {
    const Rounding rounding = numbers_.arithmetic;
    return format.add(format.add(start, format.round(line, rounding), rounding),
                      format.round(pixel, rounding), rounding);
  }
  std::uint8_t integer(double color) const {
    const double rounded = numbers_.output == Rounding::kNearest ? color + 0.5 : color;
    return static_cast<std::uint8_t>(std::clamp(rounded, 0.0, 255.0));
  }

  const TilerSetup& setup_;
  const NumberProfile& numbers_;
  Displacement line_;
};

// The same bits in plain float, where TilerSetup::single_precision says so.
class SingleAccumulator {
 public:
  SingleAccumulator(const TilerSetup& setup, const NumberProfile& numbers)
      : depth_(setup.depth),
        color_(setup.color),
        dropped_bits_(23 - numbers.depth.mantissa_bits),
        offset_(static_cast<std::int32_t>(127 - numbers.depth.exponent_bias) << numbers.depth.mantissa_bits),
        largest_(static_cast<std::int32_t>(numbers.depth.largestWord())) {}

  // At a line's first pixel of the box.
  struct Line {
    float depth = 0, color = 0;
  };
  Line line(int line) const {
    const auto lines = static_cast<float>(line);
    return {.depth = depth_.start + lines * depth_.line,
            .color = tenBits(color_.start + tenBits(lines * color_.line))};
  }
  // What at() computes with from there, for others who do: depth and colour a step, and the bits of memory
  // words.
  struct Steps {
    float depth = 0, color = 0;
    int dropped_bits = 0;
    std::int32_t offset = 0, largest = 0;
  };
  Steps steps() const {
    return {.depth = depth_.pixel,
            .color = color_.pixel,
            .dropped_bits = dropped_bits_,
            .offset = offset_,
            .largest = largest_};
  }

  void beginLine(int line) { line_ = this->line(line); }
  PixelValues at(int pixel) const {
    const auto pixels = static_cast<float>(pixel);
    const float depth = line_.depth + pixels * depth_.pixel;
    const float color = tenBits(line_.color + tenBits(pixels * color_.pixel)) + 0.5F;
    return {.depth = word(depth), .color = static_cast<std::uint8_t>(std::clamp(color, 0.0F, 255.0F))};
  }

 private:
  struct Plane {
    explicit Plane(const SteppedPlane& plane)
        : start(static_cast<float>(plane.start)),
          line(static_cast<float>(plane.line)),
          pixel(static_cast<float>(plane.pixel)) {}
    float start, line, pixel;
  };

  // To 10 significant bits, ties to even; float has 24.
  static float tenBits(float x) {
    constexpr int kDropped = 14;
    const auto bits = std::bit_cast<std::uint32_t>(x);
    return std::bit_cast<float>((bits + (1u << (kDropped - 1)) - 1 + (bits >> kDropped & 1)) &
                                ~((1u << kDropped) - 1));
  }
  // The exponent stands above the mantissa in both, so rounding carries into it and a subtraction changes the
  // bias.
  std::uint32_t word(float depth) const {
    const auto bits = std::bit_cast<std::int32_t>(depth);
    const std::int32_t rounded =
        (bits + (1 << (dropped_bits_ - 1)) - 1 + (bits >> dropped_bits_ & 1)) >> dropped_bits_;
    return bits < 0 ? 0 : static_cast<std::uint32_t>(std::clamp(rounded - offset_, 0, largest_));
  }

  Plane depth_, color_;
  int dropped_bits_;
  std::int32_t offset_, largest_;
  Line line_;
};

}  // namespace deltaz::ars
