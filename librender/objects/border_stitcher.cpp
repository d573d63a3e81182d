#include "librender/objects/border_stitcher.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "libdb/access/grid_locator.h"
#include "libdb/access/seam_geometry.h"

namespace deltaz {
namespace {

// The level-0 indices of a node's corner and side.
struct Extent {
  std::int64_t step = 1, span = 0, west = 0, south = 0;
};

Extent extentOf(const Database& database, const NodeRecord& record) {
  Extent extent;
  extent.step = std::int64_t{1} << record.level;
  extent.span = database.grid(record.grid).header().leaf_cells * extent.step;
  extent.west = record.x * extent.span;
  extent.south = record.y * extent.span;
  return extent;
}

// The nodes whose cells touch a post, each once.
struct Touching {
  std::array<std::uint32_t, 4> node{};
  int count = 0;
};

Touching touching(const CutIndex& index, std::uint16_t grid, std::int64_t column, std::int64_t row) {
  Touching result;
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    const std::uint32_t node = index.holding(grid, column - (quadrant & 1), row - (quadrant >> 1));
    const auto end = result.node.begin() + result.count;
    if (node == CutIndex::kNone || std::find(result.node.begin(), end, node) != end) continue;
    result.node[static_cast<std::size_t>(result.count++)] = node;
  }
  return result;
}

bool alongX(Side side) {
  return side == Side::kSouth || side == Side::kNorth;
}

// Where a tile's posts stand in level-0 indices; each side's posts are on the node's border only if the area
// reaches that far.
struct TileBorder {
  TileBorder(const TerrainTile& tile, const Extent& extent)
      : step(extent.step),
        first_column(tile.first_column * extent.step),
        first_row(tile.first_row * extent.step),
        last_column((tile.first_column + tile.columns - 1) * extent.step),
        last_row((tile.first_row + tile.rows - 1) * extent.step),
        columns(tile.columns),
        rows(tile.rows) {
    reaches = {first_row == extent.south, last_column == extent.west + extent.span,
               last_row == extent.south + extent.span, first_column == extent.west};
  }
  bool reachesSide(Side side) const { return reaches[static_cast<std::size_t>(side)]; }
  int count(Side side) const { return alongX(side) ? columns : rows; }
  // Vertex index of post k of a side.
  std::uint32_t vertex(Side side, int k) const {
    const int i = side == Side::kWest ? 0 : side == Side::kEast ? columns - 1 : k;
    const int j = side == Side::kSouth ? 0 : side == Side::kNorth ? rows - 1 : k;
    return static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(columns) +
           static_cast<std::uint32_t>(i);
  }
  std::array<std::int64_t, 2> post(Side side, std::int64_t along) const {
    switch (side) {
      case Side::kSouth:
        return {along, first_row};
      case Side::kEast:
        return {last_column, along};
      case Side::kNorth:
        return {along, last_row};
      case Side::kWest:
        break;
    }
    return {first_column, along};
  }
  std::int64_t begin(Side side) const { return alongX(side) ? first_column : first_row; }

  std::int64_t step, first_column, first_row, last_column, last_row;
  int columns, rows;
  std::array<bool, 4> reaches{};
};

// True if the tile draws the face on its border edge `edge` of a side.
bool faceOnEdge(const TerrainTile& tile, Side side, int edge) {
  switch (side) {
    case Side::kSouth:
      return tile.bottomFaceValid(edge, 0);
    case Side::kEast:
      return tile.bottomFaceValid(tile.columns - 2, edge);
    case Side::kNorth:
      return tile.topFaceValid(edge, tile.rows - 2);
    case Side::kWest:
      break;
  }
  return tile.topFaceValid(0, edge);
}

}  // namespace

std::vector<std::uint8_t> nodesToProcess(const std::vector<CutNode>& cut, const CutIndex& index,
                                         const SeamIndex& seams) {
  std::vector<std::uint8_t> wanted(cut.size(), 0);
  for (std::uint32_t n = 0; n < cut.size(); ++n) {
    if (!cut[n].in_view) continue;
    wanted[n] = 1;
    const LeafSeams* const leaf =
        cut[n].node.record.level == 0 ? seams.leaf(positionOf(cut[n].node.record)) : nullptr;
    if (leaf == nullptr) continue;
    for (const NodePosition& partner : leaf->partners) {
      if (const std::uint32_t other = index.at(partner); other != CutIndex::kNone) wanted[other] = 1;
    }
  }
  return wanted;
}

std::vector<std::uint32_t> nodesToProcess(const Database& database, const std::vector<CutNode>& cut,
                                          const CutIndex& index, const SeamIndex& seams,
                                          std::span<const std::uint32_t> part) {
  std::unordered_set<std::uint32_t> wanted(part.begin(), part.end());
  std::vector<std::uint32_t> waiting(part.begin(), part.end());
  const auto want = [&](std::uint32_t n) {
    if (wanted.insert(n).second) waiting.push_back(n);
  };
  for (const std::uint32_t n : part) {
    const LeafSeams* const leaf =
        cut[n].node.record.level == 0 ? seams.leaf(positionOf(cut[n].node.record)) : nullptr;
    if (leaf == nullptr) continue;
    for (const NodePosition& partner : leaf->partners) {
      if (const std::uint32_t other = index.at(partner); other != CutIndex::kNone) want(other);
    }
  }
  // The ends of an edge may follow an edge that is coarser still.
  while (!waiting.empty()) {
    const NodeRecord& record = cut[waiting.back()].node.record;
    waiting.pop_back();
    const Extent extent = extentOf(database, record);
    const auto want_coarser = [&](std::uint32_t other) {
      if (other != CutIndex::kNone && cut[other].in_view && cut[other].node.record.level > record.level)
        want(other);
    };
    for (const Side side : kSides) want_coarser(index.acrossWhole(positionOf(record), side));
    for (int corner = 0; corner < 4; ++corner) {
      const Touching around = touching(index, record.grid, extent.west + (corner & 1) * extent.span,
                                       extent.south + (corner >> 1) * extent.span);
      for (int k = 0; k < around.count; ++k) want_coarser(around.node[static_cast<std::size_t>(k)]);
    }
  }
  std::vector<std::uint32_t> sorted(wanted.begin(), wanted.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

BorderStitcher::BorderStitcher(const Database& database, const std::vector<CutNode>& cut,
                               const CutIndex& index, const SeamIndex& seams,
                               const std::vector<ProcessedNode>& processed, bool textured)
    : database_(database),
      cut_(cut),
      index_(index),
      seams_(seams),
      processed_(processed),
      textured_(textured) {}

// Whether coarser node `node` draws a face on the edge of its border that the post lies inside of.
bool BorderStitcher::drawsFaceOnEdge(std::uint32_t node, std::int64_t column, std::int64_t row) const {
  const TerrainTile* const tile = processed_[node].tile;
  if (tile == nullptr || tile->columns < 2 || tile->rows < 2) return false;
  const Extent extent = extentOf(database_, cut_[node].node.record);
  const TileBorder border(*tile, extent);
  const bool along_x = column % extent.step != 0;
  const Side side = along_x ? (row == extent.south ? Side::kSouth : Side::kNorth)
                            : (column == extent.west ? Side::kWest : Side::kEast);
  if (!border.reachesSide(side)) return false;
  const std::int64_t edge = floorDivide((along_x ? column : row) - border.begin(side), extent.step);
  return edge >= 0 && edge + 1 < border.count(side) && faceOnEdge(*tile, side, static_cast<int>(edge));
}

std::optional<TerrainVertex> BorderStitcher::resolve(std::uint16_t grid, std::int64_t column,
                                                     std::int64_t row) const {
  const Touching around = touching(index_, grid, column, row);
  const auto is_post = [&](std::int64_t step) { return column % step == 0 && row % step == 0; };
  std::uint32_t mover = CutIndex::kNone, owner = CutIndex::kNone;
  const auto coarser = [&](std::uint32_t n, std::uint32_t than) {
    return than == CutIndex::kNone || cut_[n].node.record.level > cut_[than].node.record.level;
  };
  for (int k = 0; k < around.count; ++k) {
    const std::uint32_t n = around.node[static_cast<std::size_t>(k)];
    if (is_post(std::int64_t{1} << cut_[n].node.record.level)) {
      if (processed_[n].tile != nullptr && coarser(n, owner)) owner = n;
    } else if (coarser(n, mover) && drawsFaceOnEdge(n, column, row)) {
      mover = n;
    }
  }
  if (mover != CutIndex::kNone) {
    const std::int64_t step = std::int64_t{1} << cut_[mover].node.record.level;
    const bool along_x = column % step != 0;
    const std::int64_t at = along_x ? column : row, begin = floorDivide(at, step) * step;
    const auto from = along_x ? resolve(grid, begin, row) : resolve(grid, column, begin);
    const auto to = along_x ? resolve(grid, begin + step, row) : resolve(grid, column, begin + step);
    if (from && to) {
      const double t = static_cast<double>(at - begin) / static_cast<double>(step);
      return from->moved(*from, *to, t);
    }
  }
  if (owner == CutIndex::kNone) return std::nullopt;
  const TerrainTile& tile = *processed_[owner].tile;
  const std::int64_t step = std::int64_t{1} << tile.level;
  const std::int64_t i = column / step - tile.first_column, j = row / step - tile.first_row;
  if (i < 0 || j < 0 || i >= tile.columns || j >= tile.rows) return std::nullopt;
  return processed_[owner].vertices->at(static_cast<std::size_t>(j * tile.columns + i));
}

TerrainVertices BorderStitcher::vertices(std::uint32_t n, TerrainSplits& splits,
                                         std::vector<std::array<std::int64_t, 2>>* posts) const {
  const TerrainTile& tile = *processed_[n].tile;
  const NodeRecord& record = cut_[n].node.record;
  const NodePosition position = positionOf(record);
  TerrainVertices result = *processed_[n].vertices;
  splits = {};
  const Extent extent = extentOf(database_, record);
  const TileBorder border(tile, extent);
  if (posts != nullptr) {
    posts->clear();
    for (int j = 0; j < tile.rows; ++j) {
      for (int i = 0; i < tile.columns; ++i)
        posts->push_back({border.first_column + i * extent.step, border.first_row + j * extent.step});
    }
  }
  if (tile.columns < 2 || tile.rows < 2) return result;

  // What coarser neighbours move, and corners, which may belong to a coarser node that only touches there.
  const auto take = [&](Side side, int k) {
    const std::array<std::int64_t, 2> post = border.post(side, border.begin(side) + k * extent.step);
    if (const auto resolved = resolve(record.grid, post[0], post[1]))
      result.setPost(border.vertex(side, k), *resolved);
  };
  std::array<bool, 4> finer_across{};
  for (const Side side : kSides) {
    if (!border.reachesSide(side)) continue;
    const std::uint32_t across = index_.acrossWhole(position, side);
    const int last = border.count(side) - 1;
    finer_across[static_cast<std::size_t>(side)] = across == CutIndex::kNone;
    if (across != CutIndex::kNone && cut_[across].node.record.level > record.level) {
      for (int k = 0; k <= last; ++k) take(side, k);
    } else {
      take(side, 0);
      take(side, last);
    }
  }

  // The points finer neighbours bring.
  std::vector<std::int64_t> points;
  for (const Side side : kSides) {
    if (!finer_across[static_cast<std::size_t>(side)]) continue;
    const std::int64_t begin = border.begin(side);
    const int edges = border.count(side) - 1;
    index_.postsAcross(position, side, begin, begin + edges * extent.step, points);
    if (points.empty()) continue;
    auto& of_side = side == Side::kSouth   ? splits.south
                    : side == Side::kEast  ? splits.east
                    : side == Side::kNorth ? splits.north
                                           : splits.west;
    of_side.resize(static_cast<std::size_t>(edges));
    for (const std::int64_t along : points) {
      const std::int64_t offset = along - begin;
      const auto edge = static_cast<int>(offset / extent.step);
      if (offset % extent.step == 0 || !faceOnEdge(tile, side, edge)) continue;
      const TerrainVertex from = result.at(border.vertex(side, edge));
      const TerrainVertex to = result.at(border.vertex(side, edge + 1));
      const double t = static_cast<double>(offset % extent.step) / static_cast<double>(extent.step);
      of_side[static_cast<std::size_t>(edge)].push_back(static_cast<std::uint32_t>(result.position.size()));
      result.append(from.moved(from, to, t));
      if (posts != nullptr) posts->push_back(border.post(side, along));
    }
  }
  return result;
}

std::optional<TerrainVertex> BorderStitcher::ownPost(std::uint16_t grid, std::int64_t column,
                                                     std::int64_t row) const {
  const Touching around = touching(index_, grid, column, row);
  for (int k = 0; k < around.count; ++k) {
    const std::uint32_t n = around.node[static_cast<std::size_t>(k)];
    const TerrainTile* const tile = processed_[n].tile;
    if (tile == nullptr || tile->level != 0) continue;
    const std::int64_t i = column - tile->first_column, j = row - tile->first_row;
    if (i < 0 || j < 0 || i >= tile->columns || j >= tile->rows) continue;
    return processed_[n].vertices->at(static_cast<std::size_t>(j * tile->columns + i));
  }
  return std::nullopt;
}

GridCoordinates BorderStitcher::textureIn(std::uint16_t drawing, std::uint16_t grid, std::int64_t column,
                                          std::int64_t row) const {
  if (drawing == grid) return {static_cast<double>(column), static_cast<double>(row)};
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (!textured_) return {kUnknown, kUnknown};
  const auto place = GridLocator(database_.grid(drawing)).locatePost(database_.grid(grid), column, row);
  if (!place) return {kUnknown, kUnknown};
  return {static_cast<double>(place->column) + place->x, static_cast<double>(place->row) + place->y};
}

std::optional<TerrainVertex> BorderStitcher::seamVertex(const Seam& seam, const SeamVertex& vertex,
                                                        std::uint16_t drawing) const {
  const std::uint16_t grid = gridOf(seam, vertex.side);
  const auto placed = [&](std::optional<TerrainVertex> post, std::int64_t column, std::int64_t row) {
    if (post) post->texture = textureIn(drawing, grid, column, row);
    return post;
  };
  // A post may lie on a border with a coarser node, too; a point between posts never does.
  if (vertex.weight1 == 0 && vertex.weight2 == 0)
    return placed(resolve(grid, vertex.column, vertex.row), vertex.column, vertex.row);
  const auto p0 = placed(ownPost(grid, vertex.column, vertex.row), vertex.column, vertex.row);
  if (!p0) return std::nullopt;
  TerrainVertex result = *p0;
  const auto lean = [&](const std::array<std::int8_t, 2>& step, double weight) {
    if (weight == 0) return true;
    const std::int64_t column = vertex.column + step[0], row = vertex.row + step[1];
    const auto to = placed(ownPost(grid, column, row), column, row);
    if (!to) return false;
    result = result.moved(*p0, *to, weight);
    return true;
  };
  if (!lean(vertex.to_p1, vertex.weight1) || !lean(vertex.to_p2, vertex.weight2)) return std::nullopt;
  return result;
}

std::vector<TerrainFace> BorderStitcher::seamFaces(std::uint32_t n, TerrainVertices& vertices,
                                                   std::vector<SeamVertexName>* names) const {
  std::vector<TerrainFace> faces;
  const NodeRecord& record = cut_[n].node.record;
  const LeafSeams* const leaf = record.level == 0 ? seams_.leaf(positionOf(record)) : nullptr;
  if (leaf == nullptr) return faces;
  const TerrainTile& tile = *processed_[n].tile;
  std::unordered_map<std::uint64_t, std::optional<std::uint32_t>> placed;
  const auto place = [&](std::uint32_t seam, std::uint32_t vertex) {
    const auto [found, fresh] = placed.emplace(std::uint64_t{seam} << 32 | vertex, std::nullopt);
    if (!fresh) return found->second;
    const Seam& of = seams_.seams()[seam];
    if (const auto resolved = seamVertex(of, of.vertices[vertex], record.grid)) {
      found->second = static_cast<std::uint32_t>(vertices.position.size());
      vertices.append(*resolved);
      if (names != nullptr) names->push_back({seam, vertex});
    }
    return found->second;
  };
  for (const LeafReplacement& replacement : leaf->replaced) {
    const ReplacedFace& replaced = replacement.face;
    const auto cell = static_cast<std::uint32_t>((replaced.row - tile.first_row) * (tile.columns - 1) +
                                                 (replaced.column - tile.first_column));
    for (std::uint32_t f = 0; f < replaced.face_count; ++f) {
      TerrainFace face;
      face.identity = cell << 1 | (replaced.top ? 1 : 0);
      bool complete = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto at =
            place(replacement.seam, seams_.seams()[replacement.seam].faces[replaced.first_face + f][k]);
        complete = complete && at.has_value();
        face.vertex[k] = at.value_or(0);
      }
      if (complete) faces.push_back(face);
    }
  }
  return faces;
}

}  // namespace deltaz
