// The terrain object processor (report 5.5): one node's posts in view space, lit and coloured, and its front
// faces.
//
// Positions are exact WGS-84: on a geodetic grid each view coordinate of post (column, row, h) is
//   (a + b h) k + (c + s h) m3 - t
// with the row constants a, b, c, s of libdb/access/earth.h, k = m1 cos(lon) + m2 sin(lon) of the column and
// view, (m1, m2, m3) the view vector and t its product with the eye. In double the result is within 1e-7 m of
// GeographicLib anywhere on Earth, poles and antimeridian included, and the same for a post shared by two
// nodes. Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libdb/access/color.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/access/vector3.h"
#include "librender/scene/camera.h"
#include "librender/scene/illumination.h"
#include "librender/scene/transform_kind.h"

namespace deltaz {

// A place in a grid, in level-0 posts counted from global index 0: what colour maps are addressed by.
struct GridCoordinates {
  double column = 0, row = 0;
};

// All that is interpolated over a face.
struct TerrainVertex {
  Vector3 position;         // (U, V, W)
  LinearColor color;        // illumination times synthetic colour, linear
  double intensity = 0;     // illumination: what a texel's colour is multiplied by
  GridCoordinates texture;  // in the grid of the node that draws the face

  // The vertex moved by `weight` of the way from `from` to `to`.
  TerrainVertex moved(const TerrainVertex& from, const TerrainVertex& to, double weight) const;
};

// Illumination times synthetic colour, linear, and illumination: in single precision, as they are drawn.
struct VertexLight {
  float red = 0, green = 0, blue = 0, intensity = 0;
  bool operator==(const VertexLight&) const = default;
};

// Posts row by row from the south-west, columns * rows of them, then points that split border faces; what
// stands at a void post is not used by any face. The lists have one entry a vertex, as of TerrainVertex.
struct TerrainVertices {
  int columns = 0, rows = 0;
  std::vector<Vector3> position;
  std::vector<VertexLight> light;
  // Posts stand where their index says: from the first one on, so many level-0 posts apart.
  GridCoordinates first_post;
  double step = 1;
  std::vector<GridCoordinates> appended_texture;  // of the vertices behind the posts

  GridCoordinates texture(std::size_t index) const {
    const auto across = static_cast<std::size_t>(columns), posts = across * static_cast<std::size_t>(rows);
    if (index >= posts) return appended_texture[index - posts];
    return {first_post.column + static_cast<double>(index % across) * step,
            first_post.row + static_cast<double>(index / across) * step};
  }
  TerrainVertex at(std::size_t index) const;
  // Pre: the vertex stands at the post's own place in the grid.
  void setPost(std::size_t index, const TerrainVertex& vertex);
  void append(const TerrainVertex& vertex);
};

// A face by the indices of its posts, in the order of the report (counter-clockwise seen from above).
struct TerrainFace {
  std::array<std::uint32_t, 3> vertex{};
  std::uint32_t identity = 0;  // cell << 1 | (1 for the top face), cell = row * (columns - 1) + column
};

struct TerrainFaces {
  std::vector<TerrainFace> front;
  std::uint64_t in = 0, back_facing = 0;  // in = back_facing + front.size()
};

std::vector<Vector3> terrainPositions(const TerrainTile& tile, const GridGeometry& geometry,
                                      const ViewTransform& view);
// Illumination of each post, and that times its synthetic colour.
struct TerrainShading {
  std::vector<LinearColor> color;
  std::vector<double> intensity;
};
TerrainShading terrainShading(const TerrainTile& tile, const GridGeometry& geometry, const Light& light);
TerrainVertices terrainVertices(const TerrainTile& tile, const GridGeometry& geometry,
                                const ViewTransform& view, const Light& light,
                                TransformKind transform = TransformKind::kExact);

// True for a face whose upper side is turned away from the eye (or edge-on, or of no extent). Vertices in
// view space.
inline bool isBackFacing(const Vector3& a, const Vector3& b, const Vector3& c) {
  return !(dot(cross(b - a, c - a), a) < 0);
}

// Points that split the faces along a tile's border (border_stitcher.h), as indices of vertices behind the
// posts. One list for each border edge of a side, from west to east or south to north; no lists at all for a
// side that has no points.
struct TerrainSplits {
  std::vector<std::vector<std::uint32_t>> south, east, north, west;
};

// Appends a face to the front ones, or counts it as a back face.
void addFace(TerrainFaces& faces, const std::vector<Vector3>& position, const TerrainFace& face);

// Faces whose three posts are valid, sorted into front and back, cells row by row, bottom face before top
// face; a face that is split keeps its identity in all its parts.
// `left_out` has 1 at the identities of faces that are not drawn; empty for none.
TerrainFaces terrainFaces(const TerrainTile& tile, const std::vector<Vector3>& position,
                          const TerrainSplits& splits = {}, const std::vector<std::uint8_t>& left_out = {});

}  // namespace deltaz
