// The eight 32-bit words in which a triangle reaches a tiler (report Fig 51).
//
//   word     31 ... 20  19 18   17          16          15 ... 0
//   1, 2, 3  RI (31:16)                                 RJ
//   4        unstated   corner  oversample  background  C0
//   5        DCDJ (31:16)                               DCDI
//   6, 7, 8  D0, DDDI, DDDJ
//
// The report does not say what bits 31:20 of word 4 are. They are written 0, ignored where words are decoded,
// and refused by checkTriangleWords, so that nobody can come to depend on them.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "formats/error.h"
#include "librender/ars/words/number_profile.h"
#include "librender/ars/words/triangle_variables.h"

namespace deltaz::ars {

inline constexpr int kTriangleWordCount = 8;
using TriangleWords = std::array<std::uint32_t, kTriangleWordCount>;

inline constexpr std::uint32_t kUnstatedBits = 0xFFF0'0000;  // of word 4

// `profile` fits the words (NumberProfile::fitsTriangleWords). Any words have variables; those in the
// canonical form of their numbers (normalised, no minus zero) and without unstated bits come back bit for
// bit.
TriangleWords encodeTriangleWords(const TriangleVariables& triangle, const NumberProfile& profile);
TriangleVariables decodeTriangleWords(const TriangleWords& words, const NumberProfile& profile);

// What a tiler relies on: vertices ordered on i, pixels 0..511 after rounding, a vertex in the named corner.
// `vertex_fraction_bits` are those of the variables.
bool isTileable(const TriangleVariables& triangle, int vertex_fraction_bits);

// kInvalid, saying which promise is broken; `where` names the triangle.
Status checkTriangleWords(const TriangleWords& words, const NumberProfile& profile, const std::string& where);

}  // namespace deltaz::ars
