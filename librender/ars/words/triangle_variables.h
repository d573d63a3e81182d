// What a tiler is given of one triangle (report Table 3), as numbers of a profile's formats. Thread-safety:
// plain values.
#pragma once

#include <array>
#include <cstdint>

namespace deltaz::ars {

// The corner of the circumscribing box in which a vertex lies and where tiling starts (Fig 52): bit 1 below,
// bit 0 right.
enum class Corner : std::uint8_t { kUpperLeft, kUpperRight, kLowerLeft, kLowerRight };

constexpr bool isLower(Corner corner) {
  return (static_cast<unsigned>(corner) & 2) != 0;
}
constexpr bool isRight(Corner corner) {
  return (static_cast<unsigned>(corner) & 1) != 0;
}

struct TriangleVariables {
  struct Vertex {
    std::int32_t i = 0, j = 0;  // RI, RJ in units of 2^-vertex_fraction_bits
    bool operator==(const Vertex&) const = default;
  };
  std::array<Vertex, 3> vertices;  // i never decreases
  Corner corner = Corner::kUpperLeft;
  bool oversample = false, background = false;
  double color = 0, color_i = 0, color_j = 0;  // C0, DCDI, DCDJ
  double depth = 0, depth_i = 0, depth_j = 0;  // D0, DDDI, DDDJ; at the corner vertex rounded to the pixel

  bool operator==(const TriangleVariables&) const = default;
};

// What the machine's words lack and corrections of ours need beside them (tiler/tiler_corrections.h).
struct TriangleSupplement {
  double least_depth = 0, greatest_depth = 0;  // of the vertices
  // c/U at the corner vertex rounded to the pixel and a pixel further; numbers of the depth planes' format.
  double color_over_depth = 0, color_over_depth_i = 0, color_over_depth_j = 0;

  bool operator==(const TriangleSupplement&) const = default;
};

}  // namespace deltaz::ars
