// How terrain posts come into view space. Exact is the product; the others are measured against it
// (objects/transform_posts.h says what they are, tests/bench/README.md what they cost and err by).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace deltaz {

enum class TransformKind : std::uint8_t { kExact, kDelta, kMatrix, kLocal };

inline constexpr std::array<TransformKind, 4> kTransformKinds{TransformKind::kExact, TransformKind::kDelta,
                                                              TransformKind::kMatrix, TransformKind::kLocal};

// "exact", "delta", "matrix", "local".
constexpr std::string_view transformName(TransformKind kind) {
  constexpr std::array<std::string_view, 4> kNames{"exact", "delta", "matrix", "local"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace deltaz
