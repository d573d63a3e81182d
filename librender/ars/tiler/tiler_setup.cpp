#include "librender/ars/tiler/tiler_setup.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace deltaz::ars {

namespace {

// NI and NJ, inwards.
struct Normals {
  std::array<std::int64_t, 3> i{}, j{};
};

Normals inwardNormals(const std::array<TriangleVariables::Vertex, 3>& v) {
  Normals n{.i = {v[2].j - v[0].j, v[0].j - v[1].j, v[1].j - v[2].j},
            .j = {v[0].i - v[2].i, v[1].i - v[0].i, v[2].i - v[1].i}};
  const std::int64_t test = n.j[0] * n.i[2] - n.i[0] * n.j[2];  // PTEST
  if (test < 0) {
    for (std::size_t k = 0; k < 3; ++k) {
      n.i[k] = -n.i[k];
      n.j[k] = -n.j[k];
    }
  }
  return n;
}

std::int64_t truncated(std::int64_t value, int dropped_bits, bool towards_zero) {
  if (towards_zero && value < 0) return -(-value >> dropped_bits);
  return value >> dropped_bits;
}

// What is left of a gradient in a register of so many bits that counts kStepBits' worth of steps.
double accumulated(double gradient, const FloatFormat& format, int accumulator_bits) {
  const int kept = accumulator_bits - kStepBits;
  return kept >= format.precision() ? gradient
                                    : roundToBits(gradient, kept, Rounding::kTruncate, format.mantissa_sign);
}

SteppedPlane steppedPlane(double start, double per_i, double per_j, const TilerSetup& setup,
                          const FloatFormat& format, int accumulator_bits) {
  return {.start = start,
          .line = setup.i_step * accumulated(per_i, format, accumulator_bits),
          .pixel = setup.j_step * accumulated(per_j, format, accumulator_bits)};
}

// The greatest magnitude that occurs in the box.
double reach(const SteppedPlane& plane, const TilerSetup& setup) {
  return std::abs(plane.start) + setup.lines * std::abs(plane.line) + setup.pixels * std::abs(plane.pixel);
}

// float has the 24 bits of the depth planes and twice and two more than the 10 of colours, so it rounds as
// they do as long as nothing leaves their range. Sums that underflow there and not here end as depth or
// colour 0 in both, or add to what is so much larger that they leave no trace; that takes memory depths to
// end well above 2^-64.
bool singlePrecisionServes(const TilerSetup& setup, const NumberProfile& numbers) {
  constexpr double kDepthLimit = 0x1p62, kColorLimit = 0x1p14;
  constexpr int kLargestBias = 36;
  return numbers.depth_plane == kDepthPlaneFormat && numbers.color == kColorFormat &&
         numbers.depth_accumulator_bits >= kDepthPlaneFormat.precision() + kStepBits &&
         numbers.color_accumulator_bits >= kColorFormat.precision() + kStepBits &&
         numbers.arithmetic == Rounding::kNearest && numbers.output == Rounding::kNearest &&
         numbers.depth.leading_one == LeadingOne::kHidden && numbers.depth.mantissa_bits <= 22 &&
         numbers.depth.exponent_bits <= 6 && numbers.depth.exponent_bias >= 0 &&
         numbers.depth.exponent_bias <= kLargestBias && !setup.clamp_depth && !setup.true_color &&
         reach(setup.depth, setup) < kDepthLimit && reach(setup.color, setup) < kColorLimit;
}

}  // namespace

TilerSetup setUpTriangle(const TriangleVariables& triangle, const TilerConfiguration& configuration,
                         const TriangleSupplement* supplement) {
  const NumberProfile& numbers = configuration.numbers;
  const TilerCorrections& corrections = configuration.corrections;
  const auto& v = triangle.vertices;
  const int fraction = numbers.vertex_fraction_bits;
  const auto pixel = [&](std::int32_t coordinate) { return nearestPixel(coordinate, fraction); };

  TilerSetup setup;
  const auto [j_least, j_greatest] = std::minmax({v[0].j, v[1].j, v[2].j});
  const bool lower = isLower(triangle.corner), right = isRight(triangle.corner);
  setup.i_start = pixel(lower ? v[2].i : v[0].i);
  setup.j_start = pixel(right ? j_greatest : j_least);
  setup.i_step = lower ? -1 : 1;
  setup.j_step = right ? -1 : 1;
  setup.lines = std::abs(pixel(lower ? v[0].i : v[2].i) - setup.i_start);
  setup.pixels = std::abs(pixel(right ? j_least : j_greatest) - setup.j_start);
  setup.oversample = triangle.oversample;
  setup.background = triangle.background;

  // Everything below in units of 2^-(2 fraction + 1): products, and the half of a product's last bit.
  const Normals n = inwardNormals(v);
  const int dropped = 2 * fraction + 1 - numbers.dot_product_fraction_bits;
  const int widened = numbers.dot_product_fraction_bits - fraction;
  const bool exact_edges = corrections.top_left_rule && !triangle.oversample;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t to_start_i = (std::int64_t{setup.i_start} << fraction) - v[k].i;
    const std::int64_t to_start_j = (std::int64_t{setup.j_start} << fraction) - v[k].j;
    const std::int64_t product = 2 * (to_start_i * n.i[k] + to_start_j * n.j[k]);
    std::int64_t tolerance = 0;
    if (triangle.oversample) {
      tolerance = std::max(std::abs(n.i[k]), std::abs(n.j[k])) << fraction;
    } else if (!exact_edges) {
      tolerance = std::abs(n.i[k]) + std::abs(n.j[k]) + 2 * (std::abs(to_start_i) + std::abs(to_start_j));
    } else {
      const bool owned = n.j[k] > 0 || (n.j[k] == 0 && n.i[k] >= 0);
      tolerance = owned ? 0 : -1;
    }
    const bool towards_zero = numbers.fixed_point_sign == SignForm::kSignMagnitude && !exact_edges;
    setup.p_start[k] = truncated(product + tolerance, dropped, towards_zero);
    setup.p_line[k] = setup.i_step * (n.i[k] << widened);
    setup.p_pixel[k] = setup.j_step * (n.j[k] << widened);
  }

  setup.depth = steppedPlane(triangle.depth, triangle.depth_i, triangle.depth_j, setup, numbers.depth_plane,
                             numbers.depth_accumulator_bits);
  setup.color = steppedPlane(triangle.color, triangle.color_i, triangle.color_j, setup, numbers.color,
                             numbers.color_accumulator_bits);
  if (supplement != nullptr) {
    setup.clamp_depth = corrections.clamp_depth;
    setup.true_color = corrections.true_color;
    setup.least_depth = supplement->least_depth;
    setup.greatest_depth = supplement->greatest_depth;
    setup.color_over_depth = steppedPlane(supplement->color_over_depth, supplement->color_over_depth_i,
                                          supplement->color_over_depth_j, setup, numbers.depth_plane,
                                          numbers.depth_accumulator_bits);
  }
  setup.single_precision = singlePrecisionServes(setup, numbers);
  return setup;
}

}  // namespace deltaz::ars
