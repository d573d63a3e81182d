// All number formats of one tiler: Table 8's widths, which may be chosen otherwise at run time, and what the
// report leaves open. Thread-safety: plain values.
#pragma once

#include <string>

#include "formats/error.h"
#include "librender/ars/words/ars_float.h"
#include "librender/ars/words/fixed_point.h"
#include "librender/ars/words/memory_depth.h"

namespace deltaz::ars {

inline constexpr int kLargestVertexFractionBits = 12;
// 511 steps at most from the corner of a picture's triangle.
inline constexpr int kStepBits = 9;

// The defaults are Table 8's widths and, where it is silent: sign and magnitude, the leading one written in
// planes and hidden in the memory's depth, displacements accumulated exactly, results rounded to nearest,
// hither at one unit of depth.
struct NumberProfile {
  int vertex_fraction_bits = kVertexFormat.fraction_bits;  // of RI, RJ, NI, NJ: 0..12
  // Of P: from vertex_fraction_bits, so that normals are exact, to twice that and one, where nothing is
  // truncated.
  int dot_product_fraction_bits = kDotProductFormat.fraction_bits;
  // Two's complement truncates the start of P downwards, which changes no pixel: what is added to it has no
  // bits below.
  SignForm fixed_point_sign = SignForm::kTwosComplement;

  FloatFormat color = kColorFormat;             // C0, DCDI, DCDJ, SCI, SCJ
  FloatFormat depth_plane = kDepthPlaneFormat;  // D0, DDDI, DDDJ, SDI, SDJ
  DepthFormat depth;                            // in memory

  // Magnitude bits of the fixed-point registers that sum displacements; kStepBits more than a gradient has
  // lose nothing, and what a narrower register cannot hold is dropped from the gradient's end.
  int color_accumulator_bits = kColorFormat.precision() + kStepBits;
  int depth_accumulator_bits = kDepthPlaneFormat.precision() + kStepBits;

  Rounding arithmetic = Rounding::kNearest;  // of planes, displacements and their sums
  Rounding output = Rounding::kNearest;      // of the memory's depth and the colour integer

  bool operator==(const NumberProfile&) const = default;

  FixedPointFormat vertexFormat() const {
    return {kVertexFormat.integer_bits, vertex_fraction_bits, fixed_point_sign};
  }
  FixedPointFormat dotProductFormat() const {
    return {kDotProductFormat.integer_bits, dot_product_fraction_bits, fixed_point_sign};
  }
  // Whether triangles of this profile fit the eight words of Fig 51.
  bool fitsTriangleWords() const;
};

// Widths that go together: `bits` of fraction in a vertex with two more in P, or mantissas with accumulators
// that lose nothing.
NumberProfile withVertexFractionBits(NumberProfile profile, int bits);
NumberProfile withColorMantissaBits(NumberProfile profile, int bits);
NumberProfile withPlaneMantissaBits(NumberProfile profile, int bits);  // of D0, DDDI, DDDJ
NumberProfile withDepthMantissaBits(NumberProfile profile, int bits);  // of the memory

// The bits of one triangle's words and of one pixel's packet: what widths cost in wires and queues.
int triangleBits(const NumberProfile& profile);
int pixelBits(const NumberProfile& profile);

// kUsage, naming the width and its range, for what this model cannot compute.
Status checkNumberProfile(const NumberProfile& profile);

// The four forms in words, for reports.
std::string describe(const NumberProfile& profile);

}  // namespace deltaz::ars
