// A seam: how the grid drawn on top (the upper) meets the one under it (the lower). Specified in seam.md.
//
// Along the edge of the upper grid's coverage both grids follow the lower grid's surface. Faces of either
// grid that the edge touches are replaced by faces between seam vertices; lower faces that lie under the
// upper grid altogether are removed. All at full resolution: nodes that a seam touches are drawn at level 0.
// Errors: kInvalid with kHgtSeam. Thread-safety: plain values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/error.h"

namespace deltaz {

enum class SeamSide : std::uint8_t { kUpper = 0, kLower = 1 };

// A point of one of the grids' full-resolution surfaces:
//   p0 + (p1 - p0) * weight1 + (p2 - p0) * weight2
// with p0 the post (column, row) and p1, p2 posts next to it. A post itself has both weights 0; a point on an
// edge has weight2 0 and the edge's lower post as p0.
struct SeamVertex {
  SeamSide side = SeamSide::kLower;  // whose posts these are
  std::int64_t column = 0, row = 0;  // global level-0 index of p0
  std::array<std::int8_t, 2> to_p1{}, to_p2{};
  double weight1 = 0, weight2 = 0;
  bool operator==(const SeamVertex&) const = default;
};

// A face of one of the grids and what is drawn instead: faces [first_face, first_face + face_count) of the
// seam.
struct ReplacedFace {
  std::int64_t column = 0, row = 0;  // of the cell's south-west post
  bool top = false;                  // (SW, NE, NW) instead of (SW, SE, NE)
  std::uint32_t first_face = 0, face_count = 0;
  bool operator==(const ReplacedFace&) const = default;
};

// Cells of one row, from column `begin` up to but not including `end`; global level-0 indices.
struct CellRun {
  std::int64_t row = 0, begin = 0, end = 0;
  bool operator==(const CellRun&) const = default;
};

struct Seam {
  std::uint16_t upper = 0, lower = 0;  // grids
  // Cells of the lower grid that are not drawn at all.
  std::vector<CellRun> runs;  // in the order of row, column
  std::vector<SeamVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;    // vertices, counter-clockwise from above
  std::array<std::vector<ReplacedFace>, 2> replaced;  // by SeamSide; in the order of row, column, face
  double error = 0;  // metres: largest distance along the normal between the two surfaces at the edge's posts

  const std::vector<ReplacedFace>& replacedOf(SeamSide side) const {
    return replaced[static_cast<std::size_t>(side)];
  }
  bool operator==(const Seam&) const = default;
};

std::vector<std::byte> encodeSeam(const Seam& seam);
// Checks every index, weight and cell against the grids; nothing read from it leads outside them.
Result<Seam> decodeSeam(std::span<const std::byte> bytes, const std::vector<GridHeader>& grids,
                        const std::string& where);

}  // namespace deltaz
