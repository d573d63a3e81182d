// Filters that hardware makes of shifts and adders: one kernel across, then the same down, integer weights
// whose sum is a power of two, the sum shifted right after each level (report 4.4).
//
// The report's kernel is 1 2 1 at two samples a pixel in each direction. It computes ((a + c) >> 1 + b) >> 1,
// which is (a + 2 b + c) >> 2 to the last bit, so its filter is one of these. It calls for higher
// oversampling and larger filters (4.4.5, 8.1): those here are ours.
//
// Pixel o takes taps that begin at sample ratio * o + floor((ratio - taps) / 2). Samples beside the picture
// are copies of its edge: for the report's kernel row 0 and column 0 of Fig 40, and nothing at the other
// edges. Shifting right truncates: the report's filter is .75 grey levels too dark on the average, 1.5 at
// worst. Guard bits kept between the levels and rounding make that smaller. Thread-safety: const members from
// any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace deltaz::ars {

struct ShiftAddKernel {
  std::string_view name;
  int ratio = 1;                 // samples a pixel in each direction
  std::span<const int> weights;  // of neighbouring samples, > 0
  int shift = 0;                 // their sum is 1 << shift

  int taps() const { return static_cast<int>(weights.size()); }
  // Of a pixel: the first sample, which may lie before the picture.
  int firstSample(int pixel) const;
  // To form one sum: an adder for every bit of the weights but one.
  int adders() const;
};

// "report" (1 2 1 at ratio 2) first; then boxes, pyramids and binomials at ratios 2, 4 and 8.
std::span<const ShiftAddKernel> shiftAddKernels();
std::optional<ShiftAddKernel> shiftAddKernelNamed(std::string_view name);

struct FilterArithmetic {
  int guard_bits = 0;     // kept between the levels: 0..8; the report's filter keeps none
  bool rounding = false;  // half a unit is added before each shift
  bool down_first = false;
};

// `samples`: width * height, rows from the top; both multiples of the kernel's ratio. The picture has
// width / ratio * height / ratio pixels.
std::vector<std::uint8_t> filtered(const ShiftAddKernel& kernel, std::span<const std::uint8_t> samples,
                                   int width, int height, const FilterArithmetic& arithmetic = {});

// Samples, read line by line, that the first pixel has to wait for.
std::int64_t latency(const ShiftAddKernel& kernel, int width);

}  // namespace deltaz::ars
