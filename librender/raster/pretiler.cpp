#include "librender/raster/pretiler.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "librender/raster/clipper.h"
#include "librender/raster/grid_culler.h"
#include "librender/raster/triangle_placement.h"
#include "librender/raster/vertex_projection.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

// Faces that are tested before the next ones.
constexpr std::size_t kFacesAtOnce = 1024;

struct WeightedScreenVertex {
  ScreenVertex screen;
  double weight1 = 0, weight2 = 0;
};

// Positive for a face seen from its front: the order of a face's vertices is clockwise on the screen once
// reversed.
double screenArea(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return (c.j - a.j) * (b.i - a.i) - (b.j - a.j) * (c.i - a.i);
}

// Gradients by differences from the first vertex, in double, on unsnapped positions.
void setPlanes(const std::array<WeightedScreenVertex, 3>& vertices, FacePlanes& face) {
  const auto& [a, b, c] = vertices;
  face.anchor_j = a.screen.j;
  face.anchor_i = a.screen.i;
  const double bj = b.screen.j - a.screen.j, bi = b.screen.i - a.screen.i;
  const double cj = c.screen.j - a.screen.j, ci = c.screen.i - a.screen.i;
  const double determinant = bj * ci - cj * bi;
  // A face that is a line but for rounding keeps the values of its first vertex.
  const double inverse = determinant != 0 ? 1 / determinant : 0;
  const auto plane = [&](double at_a, double at_b, double at_c) {
    const double db = at_b - at_a, dc = at_c - at_a;
    return ScreenPlane{at_a, (db * ci - dc * bi) * inverse, (bj * dc - cj * db) * inverse};
  };
  face.inverse_u = plane(a.screen.inverse_u, b.screen.inverse_u, c.screen.inverse_u);
  face.weight1 =
      plane(a.weight1 * a.screen.inverse_u, b.weight1 * b.screen.inverse_u, c.weight1 * c.screen.inverse_u);
  face.weight2 =
      plane(a.weight2 * a.screen.inverse_u, b.weight2 * b.screen.inverse_u, c.weight2 * c.screen.inverse_u);
}

void setCorners(std::span<const WeightedScreenVertex> corners, FacePlanes& face) {
  face.corners = static_cast<std::uint32_t>(std::min(corners.size(), face.corner_j.size()));
  for (std::size_t k = 0; k < face.corners; ++k) {
    face.corner_j[k] = corners[k].screen.j - face.anchor_j;
    face.corner_i[k] = corners[k].screen.i - face.anchor_i;
  }
}

std::array<float, 3> toFloats(const LinearColor& color) {
  return {static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue)};
}

void setAttributes(const PretiledNode& node, std::uint32_t number, FacePlanes& planes) {
  const TerrainFace face = node.face(number);
  planes.identity = std::uint64_t{node.identity} << 32 | face.identity;
  planes.surface = node.surface;
  if (node.surface == Surface::kModel) {
    for (std::size_t k = 0; k < 3; ++k) planes.color[k] = toFloats(node.model.front[number].color[k]);
    return;
  }
  const TerrainVertices& vertices = node.vertices;
  for (std::size_t k = 0; k < 3; ++k) {
    const VertexLight& light = vertices.light[face.vertex[k]];
    planes.color[k] = {light.red, light.green, light.blue};
    planes.intensity[k] = light.intensity;
  }
  planes.texture = vertices.texture(face.vertex[0]);
  for (std::size_t k = 0; k < 2; ++k) {
    const GridCoordinates to = vertices.texture(face.vertex[k + 1]);
    planes.texture_steps[k] = {to.column - planes.texture.column, to.row - planes.texture.row};
  }
}

// Of one worker, kept from node to node.
struct ProjectionScratch {
  std::vector<RasterVertex> vertex;
  std::vector<std::int32_t> snapped_x, snapped_y;
  void grow(std::size_t room) {
    if (vertex.size() >= room) return;
    vertex.resize(room);
    snapped_x.resize(room);
    snapped_y.resize(room);
  }
};

// Of a word of CulledFaces::tiles.
TileRange tileRange(std::uint32_t tiles) {
  return {static_cast<std::int32_t>(tiles & 0xFF), static_cast<std::int32_t>(tiles >> 8 & 0xFF),
          static_cast<std::int32_t>(tiles >> 16 & 0xFF), static_cast<std::int32_t>(tiles >> 24)};
}

void addCounts(const CullCounts& counts, PretiledNode& node) {
  node.clipped += counts.outside;
  // A front face whose snapped vertices run the other way is narrower than the snap and covers nothing.
  node.no_sample += counts.back_facing + counts.no_sample;
}

std::array<Vector3, 3> cornersOf(const PretiledNode& node, std::uint32_t face) {
  const std::vector<Vector3>& position = node.positions();
  const auto vertex = node.face(face).vertex;
  return {position[vertex[0]], position[vertex[1]], position[vertex[2]]};
}

}  // namespace

PretiledNode PretiledNode::ofTerrain(std::uint16_t grid, std::uint32_t record, TerrainVertices vertices,
                                     std::vector<TerrainFace> front) {
  PretiledNode node;
  node.grid = grid;
  node.identity = record;
  node.vertices = std::move(vertices);
  node.faces = std::move(front);
  return node;
}

PretiledNode PretiledNode::ofTerrain(std::uint16_t grid, std::uint32_t record, TerrainVertices vertices,
                                     GridFaces faces) {
  PretiledNode node = ofTerrain(grid, record, std::move(vertices), std::move(faces.listed.front));
  node.grid_faces = std::move(faces.cells);
  return node;
}

TerrainFace PretiledNode::face(std::uint32_t number) const {
  if ((number & kGridFace) == 0) return faces[number];
  const std::uint32_t of_grid = number & ~kGridFace, cell = of_grid >> 1;
  const auto columns = static_cast<std::uint32_t>(vertices.columns);
  const std::uint32_t south_west = cell / (columns - 1) * columns + cell % (columns - 1);
  const std::uint32_t north_east = south_west + columns + 1;
  if ((of_grid & 1) == 0) return {{south_west, south_west + 1, north_east}, of_grid};
  return {{south_west, north_east, south_west + columns}, of_grid};
}

PretiledNode PretiledNode::ofModel(std::uint32_t instance, ModelFaces model) {
  PretiledNode node;
  node.surface = Surface::kModel;
  node.identity = instance;
  node.faces.reserve(model.front.size());
  for (const ModelFace& face : model.front) node.faces.push_back({face.vertex, face.identity});
  node.model = std::move(model);
  return node;
}

FacePlanes facePlanes(const ViewTransform& view, const PretiledNode& node, std::uint32_t face) {
  FacePlanes planes;
  setAttributes(node, face, planes);
  const std::array<Vector3, 3> unclipped = cornersOf(node, face);
  if (std::min({unclipped[0].x, unclipped[1].x, unclipped[2].x}) >= kHither) {
    const std::array<WeightedScreenVertex, 3> on_screen = {{{project(view, unclipped[0]), 0, 0},
                                                            {project(view, unclipped[1]), 1, 0},
                                                            {project(view, unclipped[2]), 0, 1}}};
    const double a = on_screen[0].screen.inverse_u, b = on_screen[1].screen.inverse_u;
    const double c = on_screen[2].screen.inverse_u;
    planes.least = std::min({a, b, c});
    planes.greatest = std::max({a, b, c});
    setPlanes(on_screen, planes);
    setCorners(on_screen, planes);
    return planes;
  }
  ClipPolygon polygon(unclipped);
  polygon.clipToHither();
  std::array<WeightedScreenVertex, 8> corners;
  std::size_t count = 0;
  for (const ClipVertex& corner : polygon.corners()) {
    corners[count] = {project(view, corner.position), corner.weight1, corner.weight2};
    const double inverse_u = corners[count].screen.inverse_u;
    planes.least = count == 0 ? inverse_u : std::min(planes.least, inverse_u);
    planes.greatest = std::max(planes.greatest, inverse_u);
    ++count;
  }
  if (count < 3) return planes;
  // Of a quadrilateral the larger half has the better determined gradients.
  const bool second_half =
      count == 4 && screenArea(corners[0].screen, corners[2].screen, corners[3].screen) >
                        screenArea(corners[0].screen, corners[1].screen, corners[2].screen);
  setPlanes({corners[0], corners[second_half ? 2 : 1], corners[second_half ? 3 : 2]}, planes);
  setCorners(std::span(corners).first(count), planes);
  return planes;
}

void Pretiler::process(PretiledNode& node, std::uint32_t number, TileBins::Writer& bins) const {
  // Each vertex is projected and snapped once, though about six faces use it.
  const std::vector<Vector3>& positions = node.positions();
  const std::size_t room = positions.size() + kRowPadding;
  thread_local ProjectionScratch scratch;
  scratch.grow(room);
  const ProjectedVertices vertices{scratch.vertex.data(), scratch.snapped_x.data(), scratch.snapped_y.data()};
  projectViewPositions(positions, view_.width, view_.height, vertices);
  if (!node.grid_faces.empty()) processGrid(node, number, vertices, bins);
  processList(node, number, vertices, bins);
}

void Pretiler::processGrid(PretiledNode& node, std::uint32_t number, const ProjectedVertices& vertices,
                           TileBins::Writer& bins) const {
  const auto columns = static_cast<std::size_t>(node.vertices.columns), cells = columns - 1;
  const std::size_t rows = static_cast<std::size_t>(node.vertices.rows) - 1;
  thread_local std::vector<std::uint32_t> kept, tiles;
  kept.resize(2 * (cells + kRowPadding));
  tiles.resize(kept.size());
  CullCounts counts;
  for (std::size_t j = 0; j < rows; ++j) {
    const std::size_t south = j * columns, north = south + columns;
    CulledFaces faces{kept.data(), tiles.data(), 0};
    cullGridRow({vertices.snapped_x + south, vertices.snapped_y + south, vertices.snapped_x + north,
                 vertices.snapped_y + north, cells, &node.grid_faces[j * cells]},
                view_.width, view_.height, faces, counts, reach_);
    const auto first_of_row = static_cast<std::uint32_t>(j * cells * 2);
    for (std::size_t n = 0; n < faces.count; ++n) {
      const std::uint32_t face = (first_of_row + kept[n]) | kGridFace;
      if (tiles[n] == kExceptional) {
        processClipped(node, number, face, bins);
        continue;
      }
      // Clockwise on the screen.
      const RasterVertex* const south_west = vertices.vertex + south + (kept[n] >> 1);
      const RasterVertex* const north_west = south_west + columns;
      RasterTriangle triangle;
      triangle.vertex[0] = south_west[0];
      triangle.vertex[1] = (kept[n] & 1) != 0 ? north_west[0] : north_west[1];
      triangle.vertex[2] = (kept[n] & 1) != 0 ? north_west[1] : south_west[1];
      triangle.node = number;
      triangle.face = face;
      bins.add(triangle, tileRange(tiles[n]));
    }
  }
  addCounts(counts, node);
}

void Pretiler::processList(PretiledNode& node, std::uint32_t number, const ProjectedVertices& vertices,
                           TileBins::Writer& bins) const {
  static_assert(sizeof(TerrainFace) == 4 * sizeof(std::uint32_t));
  std::array<std::uint32_t, kFacesAtOnce + kRowPadding> kept, tiles;
  CullCounts counts;
  for (std::size_t first = 0; first < node.faces.size(); first += kFacesAtOnce) {
    const std::size_t count = std::min(kFacesAtOnce, node.faces.size() - first);
    CulledFaces faces{kept.data(), tiles.data(), 0};
    cullCornerFaces({node.faces[first].vertex.data(), count, vertices.snapped_x, vertices.snapped_y},
                    view_.width, view_.height, faces, counts, reach_);
    for (std::size_t n = 0; n < faces.count; ++n) {
      const auto face = static_cast<std::uint32_t>(first + faces.face[n]);
      if (faces.tiles[n] == kExceptional) {
        processClipped(node, number, face, bins);
        continue;
      }
      const auto& corner = node.faces[face].vertex;
      RasterTriangle triangle;
      // Counter-clockwise seen from the front runs clockwise on the screen in the opposite order.
      triangle.vertex[0] = vertices.vertex[corner[0]];
      triangle.vertex[1] = vertices.vertex[corner[2]];
      triangle.vertex[2] = vertices.vertex[corner[1]];
      triangle.node = number;
      triangle.face = face;
      bins.add(triangle, tileRange(faces.tiles[n]));
    }
  }
  addCounts(counts, node);
}

void Pretiler::processClipped(PretiledNode& node, std::uint32_t number, std::uint32_t face,
                              TileBins::Writer& bins) const {
  const std::array<Vector3, 3> corners = cornersOf(node, face);
  if (isOutsidePicture(corners, view_.width, view_.height)) {
    ++node.clipped;
    return;
  }
  const ClippedFace clipped = clipFace({corners[0], corners[2], corners[1]});
  if (clipped.corners < 3) {
    ++node.clipped;
    return;
  }
  RasterTriangle triangle;
  triangle.node = number;
  triangle.face = face;
  // All pieces share one number, so that the face is counted once.
  std::uint32_t shared = 0;
  for (std::size_t k = 1; k + 1 < clipped.corners; ++k) {
    const std::array<std::size_t, 3> corner = {0, k, k + 1};
    std::array<std::int32_t, 3> x{}, y{};
    for (std::size_t n = 0; n < 3; ++n) {
      triangle.vertex[n] = clipped.corner[corner[n]];
      x[n] = snappedCoordinate(triangle.vertex[n].x, view_.width);
      y[n] = snappedCoordinate(triangle.vertex[n].y, view_.height);
    }
    const TrianglePlacement placed = placeTriangle(x, y, view_.width, view_.height, reach_);
    if (placed.fate != TriangleFate::kKept) continue;
    if (shared == 0) shared = bins.numberForPieces();
    bins.addPiece(triangle, placed.tiles, shared);
  }
  if (shared == 0) ++node.no_sample;
}

}  // namespace deltaz
