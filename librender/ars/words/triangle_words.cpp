#include "librender/ars/words/triangle_words.h"

#include <algorithm>

#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

namespace {

constexpr int kBackgroundBit = 16, kOversampleBit = 17, kCornerShift = 18;

bool isOrdered(const TriangleVariables& triangle) {
  const auto& v = triangle.vertices;
  return v[0].i <= v[1].i && v[1].i <= v[2].i;
}

bool isOnScreen(const TriangleVariables& triangle, int fraction_bits) {
  return std::all_of(triangle.vertices.begin(), triangle.vertices.end(), [&](const auto& vertex) {
    const int i = nearestPixel(vertex.i, fraction_bits), j = nearestPixel(vertex.j, fraction_bits);
    return i >= 0 && i < kScreenLines && j >= 0 && j < kScreenPixels;
  });
}

bool hasItsCorner(const TriangleVariables& triangle) {
  const auto& v = triangle.vertices;
  const auto [least, greatest] = std::minmax({v[0].j, v[1].j, v[2].j});
  const std::int32_t i = isLower(triangle.corner) ? v[2].i : v[0].i,
                     j = isRight(triangle.corner) ? greatest : least;
  return std::find(v.begin(), v.end(), TriangleVariables::Vertex{i, j}) != v.end();
}

inline void decodePlanes(const TriangleWords& words, const FloatFormat& color, const FloatFormat& depth,
                         TriangleVariables& triangle) {
  triangle.color = color.decode(words[3] & 0xFFFF);
  triangle.color_i = color.decode(words[4] & 0xFFFF);
  triangle.color_j = color.decode(words[4] >> 16);
  triangle.depth = depth.decode(words[5]);
  triangle.depth_i = depth.decode(words[6]);
  triangle.depth_j = depth.decode(words[7]);
}

}  // namespace

TriangleWords encodeTriangleWords(const TriangleVariables& triangle, const NumberProfile& profile) {
  const FixedPointFormat vertex = profile.vertexFormat();
  TriangleWords words{};
  for (std::size_t k = 0; k < 3; ++k) {
    words[k] = static_cast<std::uint32_t>(vertex.encode(triangle.vertices[k].i) << 16 |
                                          vertex.encode(triangle.vertices[k].j));
  }
  words[3] = static_cast<std::uint32_t>(triangle.corner) << kCornerShift |
             static_cast<std::uint32_t>(triangle.oversample) << kOversampleBit |
             static_cast<std::uint32_t>(triangle.background) << kBackgroundBit |
             profile.color.encode(triangle.color);
  words[4] = profile.color.encode(triangle.color_j) << 16 | profile.color.encode(triangle.color_i);
  words[5] = profile.depth_plane.encode(triangle.depth);
  words[6] = profile.depth_plane.encode(triangle.depth_i);
  words[7] = profile.depth_plane.encode(triangle.depth_j);
  return words;
}

TriangleVariables decodeTriangleWords(const TriangleWords& words, const NumberProfile& profile) {
  const FixedPointFormat vertex = profile.vertexFormat();
  TriangleVariables triangle;
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.vertices[k] = {.i = static_cast<std::int32_t>(vertex.decode(words[k] >> 16)),
                            .j = static_cast<std::int32_t>(vertex.decode(words[k] & 0xFFFF))};
  }
  triangle.corner = static_cast<Corner>(words[3] >> kCornerShift & 3);
  triangle.oversample = (words[3] >> kOversampleBit & 1) != 0;
  triangle.background = (words[3] >> kBackgroundBit & 1) != 0;
  // Known when compiled, the formats cost a third.
  if (profile.color == kColorFormat && profile.depth_plane == kDepthPlaneFormat) {
    decodePlanes(words, kColorFormat, kDepthPlaneFormat, triangle);
  } else {
    decodePlanes(words, profile.color, profile.depth_plane, triangle);
  }
  return triangle;
}

bool isTileable(const TriangleVariables& triangle, int vertex_fraction_bits) {
  return isOrdered(triangle) && isOnScreen(triangle, vertex_fraction_bits) && hasItsCorner(triangle);
}

Status checkTriangleWords(const TriangleWords& words, const NumberProfile& profile,
                          const std::string& where) {
  const auto refuse = [&](const char* what, const char* why) -> Status {
    return invalidError(IssueCode::kNone, where, what, why, "Record the stream anew");
  };
  if ((words[3] & kUnstatedBits) != 0)
    return refuse("bits 20 to 31 of word 4 are set",
                  "The format leaves them unstated and they are written 0");
  const TriangleVariables triangle = decodeTriangleWords(words, profile);
  if (!isOrdered(triangle))
    return refuse("the vertices are not ordered on i", "Word 1 has the least i, word 3 the greatest");
  if (!isOnScreen(triangle, profile.vertex_fraction_bits))
    return refuse("a vertex lies beside the picture", "Rounded to pixels, i and j are 0 to 511");
  if (!hasItsCorner(triangle))
    return refuse("no vertex lies in the corner that word 4 names",
                  "Tiling starts at a vertex in a corner of the box");
  return Success{};
}

}  // namespace deltaz::ars
