#include "librender/objects/grid_faces.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/objects/grid_faces.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr D kDouble;
constexpr std::size_t kLanes = hn::MaxLanes(D());

struct Vectors {
  V x, y, z;
};

HWY_INLINE Vectors loadPosts(const Vector3* posts) {
  Vectors result;
  hn::LoadInterleaved3(kDouble, &posts->x, result.x, result.y, result.z);
  return result;
}
HWY_INLINE Vectors difference(const Vectors& a, const Vectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

// dot(cross(p, q), a) < 0, as isBackFacing computes it.
HWY_INLINE hn::Mask<D> isFront(const Vectors& p, const Vectors& q, const Vectors& a) {
  const V x = hn::Sub(hn::Mul(p.y, q.z), hn::Mul(p.z, q.y));
  const V y = hn::Sub(hn::Mul(p.z, q.x), hn::Mul(p.x, q.z));
  const V z = hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x));
  return hn::Lt(hn::Add(hn::Add(hn::Mul(x, a.x), hn::Mul(y, a.y)), hn::Mul(z, a.z)), hn::Zero(kDouble));
}

// 0 or 1 of each lane, one byte a lane.
HWY_INLINE std::uint64_t bytesOf(hn::Mask<D> mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(kDouble, mask, bits);
  // The bits seven apart, so that the lowest of each byte is one lane's.
  std::uint64_t spread = bits[0];
  spread = (spread | spread << 28) & 0x0000000F0000000F;
  spread = (spread | spread << 14) & 0x0003000300030003;
  return (spread | spread << 7) & 0x0101010101010101;
}

// Clears the bits of the faces of a row of cells that are turned away from the eye.
void dropBackFaces(const Vector3* south, const Vector3* north, std::size_t cells, std::uint8_t* faces) {
  Vector3 rest[2][kLanes + 1];
  for (std::size_t first = 0; first < cells; first += kLanes) {
    const Vector3 *southern = south + first, *northern = north + first;
    const std::size_t count = std::min(kLanes, cells - first);
    // Nothing is read behind the last post.
    if (count < kLanes) {
      std::copy_n(southern, count + 1, rest[0]);
      std::copy_n(northern, count + 1, rest[1]);
      southern = rest[0];
      northern = rest[1];
    }
    const Vectors south_west = loadPosts(southern), south_east = loadPosts(southern + 1);
    const Vectors north_west = loadPosts(northern), north_east = loadPosts(northern + 1);
    const Vectors diagonal = difference(north_east, south_west);
    const auto bottom = isFront(difference(south_east, south_west), diagonal, south_west);
    const auto top = isFront(diagonal, difference(north_west, south_west), south_west);
    const std::uint64_t front = bytesOf(bottom) | bytesOf(top) << 1;
    std::uint64_t drawn = 0;
    std::memcpy(&drawn, faces + first, count);
    drawn &= front;
    std::memcpy(faces + first, &drawn, count);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(dropBackFaces);

constexpr std::uint8_t kBottomFace = 1, kTopFace = 2;

// All faces whose posts are valid.
void setValidFaces(const TerrainTile& tile, std::vector<std::uint8_t>& faces) {
  const auto cells = static_cast<std::size_t>(tile.columns - 1);
  for (int j = 0; j + 1 < tile.rows; ++j) {
    const std::uint8_t* const south = &tile.valid[tile.index(0, j)];
    const std::uint8_t* const north = &tile.valid[tile.index(0, j + 1)];
    std::uint8_t* const row = &faces[static_cast<std::size_t>(j) * cells];
    for (std::size_t i = 0; i < cells; ++i) {
      const unsigned diagonal = south[i] & north[i + 1];
      row[i] = static_cast<std::uint8_t>((diagonal & south[i + 1]) | (diagonal & north[i]) << 1);
    }
  }
}

std::uint64_t faceCount(const std::vector<std::uint8_t>& faces) {
  std::uint64_t count = 0;
  for (const std::uint8_t cell : faces) count += (cell & kBottomFace) + (cell >> 1);
  return count;
}

// Takes the faces that points split out of the grid, and puts their fans into the list.
class Splitter {
 public:
  Splitter(const TerrainTile& tile, const std::vector<Vector3>& position, GridFaces& faces)
      : tile_(tile), position_(position), faces_(faces) {}

  void split(const TerrainSplits& splits) {
    const int last_column = tile_.columns - 2, last_row = tile_.rows - 2;
    if (!splits.south.empty() || !splits.east.empty()) {
      for (int i = 0; i < last_column; ++i) splitBottom(i, 0, pointsOn(splits.south, i), {});
      splitBottom(last_column, 0, pointsOn(splits.south, last_column), pointsOn(splits.east, 0));
      for (int j = 1; j <= last_row; ++j) splitBottom(last_column, j, {}, pointsOn(splits.east, j));
    }
    if (!splits.north.empty() || !splits.west.empty()) {
      for (int j = 0; j < last_row; ++j) splitTop(0, j, {}, pointsOn(splits.west, j));
      splitTop(0, last_row, pointsOn(splits.north, 0), pointsOn(splits.west, last_row));
      for (int i = 1; i <= last_column; ++i) splitTop(i, last_row, pointsOn(splits.north, i), {});
    }
  }

 private:
  using Points = std::span<const std::uint32_t>;

  static Points pointsOn(const std::vector<std::vector<std::uint32_t>>& side, int edge) {
    return side.empty() ? Points{} : Points(side[static_cast<std::size_t>(edge)]);
  }
  std::uint32_t post(int i, int j) const { return static_cast<std::uint32_t>(j * tile_.columns + i); }
  // False if the face is not drawn.
  bool take(int i, int j, std::uint8_t face) {
    std::uint8_t& cell = faces_.cells[static_cast<std::size_t>(j * (tile_.columns - 1) + i)];
    if ((cell & face) == 0) return false;
    cell = static_cast<std::uint8_t>(cell & ~face);
    return true;
  }
  void splitBottom(int i, int j, Points on_south, Points on_east) {
    if ((on_south.empty() && on_east.empty()) || !take(i, j, kBottomFace)) return;
    identity_ = static_cast<std::uint32_t>(j * (tile_.columns - 1) + i) << 1;
    fan(post(i, j), on_south.begin(), on_south.end(), post(i + 1, j), on_east.begin(), on_east.end(),
        post(i + 1, j + 1));
  }
  // Its border edges run westwards and southwards.
  void splitTop(int i, int j, Points on_north, Points on_west) {
    if ((on_north.empty() && on_west.empty()) || !take(i, j, kTopFace)) return;
    identity_ = static_cast<std::uint32_t>(j * (tile_.columns - 1) + i) << 1 | 1;
    fan(post(i + 1, j + 1), on_north.rbegin(), on_north.rend(), post(i, j + 1), on_west.rbegin(),
        on_west.rend(), post(i, j));
  }
  // A face with points on its edges a-b and b-c: a fan from c through those on a-b, and one from the last of
  // them through those on b-c.
  template <typename Iterator>
  void fan(std::uint32_t a, Iterator on_ab, Iterator end_ab, std::uint32_t b, Iterator on_bc, Iterator end_bc,
           std::uint32_t c) {
    std::uint32_t last = a, from = b;
    for (; on_ab != end_ab; ++on_ab) {
      add(last, *on_ab, c);
      last = *on_ab;
    }
    for (; on_bc != end_bc; ++on_bc) {
      add(last, from, *on_bc);
      from = *on_bc;
    }
    add(last, from, c);
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    addFace(faces_.listed, position_, {{a, b, c}, identity_});
  }

  const TerrainTile& tile_;
  const std::vector<Vector3>& position_;
  GridFaces& faces_;
  std::uint32_t identity_ = 0;
};

}  // namespace

GridFaces gridFaces(const TerrainTile& tile, const std::vector<Vector3>& position,
                    const TerrainSplits& splits, const std::vector<std::uint8_t>& left_out) {
  GridFaces faces;
  if (tile.columns < 2 || tile.rows < 2) return faces;
  const auto cells = static_cast<std::size_t>(tile.columns - 1),
             rows = static_cast<std::size_t>(tile.rows - 1);
  faces.cells.resize(cells * rows + kGridFacePadding);
  setValidFaces(tile, faces.cells);
  for (std::size_t identity = 0; identity < left_out.size(); ++identity) {
    if (left_out[identity] == 0) continue;
    const unsigned face = (identity & 1) == 0 ? kBottomFace : kTopFace;
    faces.cells[identity >> 1] = static_cast<std::uint8_t>(faces.cells[identity >> 1] & ~face);
  }
  Splitter(tile, position, faces).split(splits);
  faces.cells_in = faceCount(faces.cells);
  for (std::size_t j = 0; j < rows; ++j) {
    const Vector3* const south = position.data() + j * (cells + 1);
    HWY_DYNAMIC_DISPATCH(dropBackFaces)(south, south + cells + 1, cells, &faces.cells[j * cells]);
  }
  faces.cells_back_facing = faces.cells_in - faceCount(faces.cells);
  return faces;
}

}  // namespace deltaz
#endif
