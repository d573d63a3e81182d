// Terrain segments (the report's TED header and TED data): one block per node, a header and the delta-z
// array. Specified in terrain_segment.md.
//
// The array holds the node's posts and a one-post ring of its neighbours' heights, so that vertex normals
// need no other node. Post (0,0) is absolute, the rest of the first column relative to the south neighbour,
// everything else relative to the west neighbour (report 5.1.4, Fig 48): integers, so prefix sums are exact.
// Errors: kInvalid with kHgtDecode. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/error.h"

namespace deltaz {

inline constexpr std::size_t kTerrainHeaderBytes = 64;
// Heights are kept within +-2^30 quanta, so that any difference of two fits 32 bits.
inline constexpr std::int32_t kMaximumHeightQuanta = 1 << 30;
inline constexpr std::uint32_t kMaximumLeafCells = 1024;

// "predicted from": what the packed array is a difference against.
enum class Prediction : std::uint8_t { kNone = 0, kParent = 1 };

// Error of one ancestor level over the posts of a leaf, kept so that a patch need not re-read the area.
struct AncestorError {
  std::uint32_t maximum = 0;         // kErrorUnit, rounded up
  std::uint64_t sum_of_squares = 0;  // kErrorUnit squared, of errors rounded to nearest
  std::uint32_t posts = 0;           // how many posts were compared
  bool operator==(const AncestorError&) const = default;
};

struct TerrainBlock {
  // The node's own posts, without the ring. A node at an area's edge may have few or (never drawn) none.
  std::uint16_t columns = 0, rows = 0;
  // First post, counted in the node's level from the node's south-west corner.
  std::uint16_t first_column = 0, first_row = 0;
  double spacing_x = 0, spacing_y = 0;  // between posts of this level, in units of the axes
  Rational quantum;                     // metres
  Prediction predicted_from = Prediction::kNone;
  std::uint8_t normal_exponent = 2;
  // (columns + 2) x (rows + 2), row by row from the south-west corner of the ring, quanta. What stands at a
  // void post is undefined but equal for equal databases.
  std::vector<std::int32_t> heights;
  // 1 where the post is valid, else 0; same shape.
  std::vector<std::uint8_t> valid;
  // Kind of each void post: an index into the grid's sentinels (formats/area.h), 0 at valid posts and outside
  // the area. Same shape, or empty if all are 0.
  std::vector<std::uint8_t> void_kinds;
  // Leaves only: error of level 1, 2, ... over this leaf's posts.
  std::vector<AncestorError> ancestors;
};

// Pre: shapes as above, heights within kMaximumHeightQuanta. Equal blocks give equal bytes (with one zstd
// version).
std::vector<std::byte> encodeTerrainBlock(const TerrainBlock& block);

// `leaf_cells` bounds what is allocated: a block of more than leaf_cells + 1 posts a side is refused.
Result<TerrainBlock> decodeTerrainBlock(std::span<const std::byte> bytes, std::uint32_t leaf_cells,
                                        const std::string& where);

}  // namespace deltaz
