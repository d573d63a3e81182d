// Which faces of a row of grid cells may cover a sample of the picture, and which tiles they touch: the tests
// before set-up, for all cells of a row at once.
//
// A face is dropped, for the first of these reasons that holds, because it lies beside the picture, because
// it is turned away (its snapped vertices run counter-clockwise), or because no pixel centre lies in its
// bounding box or it has no area. Faces the integer tests cannot decide (a vertex before the hither plane or
// outside the guard band, or larger than 127 pixels) are reported as exceptional, for the careful way. Exact,
// and the same on every vector width. Where samples are moved from the pixels' centres (sample_pattern.h), by
// no more than `reach`, bounding boxes are tested as much wider: of the faces without a sample some are kept.
// Thread-safety: pure function.
#pragma once

#include <cstddef>
#include <cstdint>

#include "librender/raster/raster_triangle.h"

namespace deltaz {

// A snapped coordinate of a vertex that is not in front of the hither plane; both of its coordinates have it.
inline constexpr std::int32_t kBeforeHitherCoordinate = 1 << 25;
// Coordinates at least this far from the picture's centre are those of vertices outside the guard band, cut
// off at it.
inline constexpr std::int32_t kGuardCoordinate = kGuardBand * kSubPixels;

// Readable vertices behind the last one of a row.
inline constexpr std::size_t kRowPadding = 16;

struct GridRow {
  // Snapped positions of cells + 1 vertices of the cells' southern and northern side.
  const std::int32_t *south_x, *south_y, *north_x, *north_y;
  std::size_t cells;
  // One byte a cell: bit 0 if the bottom face is drawn, bit 1 the top face; nullptr if all are.
  const std::uint8_t* drawn;
};

struct CulledFaces {
  // cell << 1 | (1 for the top face), first all bottom faces from west to east, then all top faces.
  std::uint32_t* face;
  // The tiles of the face: first_j | first_i << 8 | last_j << 16 | last_i << 24, kExceptional if undecided.
  std::uint32_t* tiles;
  std::size_t count;  // set
};
inline constexpr std::uint32_t kExceptional = 0x00FF00FF;  // first after last: no range

// Faces of any mesh: four words a face, its three vertices counter-clockwise seen from its front, and one
// that is not looked at.
struct CornerFaces {
  const std::uint32_t* words;
  std::size_t count;
  const std::int32_t *snapped_x, *snapped_y;  // of the vertices
};

struct CullCounts {
  std::uint64_t in = 0, outside = 0, back_facing = 0, no_sample = 0;
};

// Faces of a small indexed mesh: the corners of face n are the vertices first[n], second[n] and third[n],
// clockwise on the screen if it is seen from its front. Readable kRowPadding entries behind the last.
struct IndexedFaces {
  const std::uint8_t *first, *second, *third;
  std::size_t count;
  const std::int32_t *snapped_x, *snapped_y;  // of the vertices
};
// The same tests; CulledFaces::face is n, in ascending order. Room for count + kRowPadding entries.
void cullIndexedFaces(const IndexedFaces& faces, int width, int height, CulledFaces& out, CullCounts& counts);

// The same tests; CulledFaces::face is the face's number, in ascending order. Room for count + kRowPadding
// entries.
void cullCornerFaces(const CornerFaces& faces, int width, int height, CulledFaces& out, CullCounts& counts,
                     std::int32_t reach = 0);

// Room for 2 * (cells + kRowPadding) entries in both lists. Adds to `counts`.
void cullGridRow(const GridRow& row, int width, int height, CulledFaces& out, CullCounts& counts,
                 std::int32_t reach = 0);

}  // namespace deltaz
