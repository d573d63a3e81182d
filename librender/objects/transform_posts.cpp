#include "librender/objects/transform_posts.h"

#include "librender/objects/terrain_object_processor.h"

namespace deltaz {
namespace {

// A view axis in single precision: what an Earth-centred offset is multiplied by, V and W scaled to pixels.
struct FloatVector {
  float x = 0, y = 0, z = 0;
};

FloatVector toFloat(const Vector3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// View coordinates of an Earth-centred direction.
Vector3 directionInView(const ViewTransform& view, const Vector3& d) {
  return {dot(view.forward, d), dot(view.right, d) * view.pixels, dot(view.down, d) * view.pixels};
}

// The flat grid's axes and middle in view coordinates: the rows of the report's 4 x 4 matrix.
struct FloatGrid {
  FloatVector east, north, up, origin;
  FloatGrid(const PlanarGrid& planar, const ViewTransform& view)
      : east(toFloat(directionInView(view, planar.east))),
        north(toFloat(directionInView(view, planar.north))),
        up(toFloat(directionInView(view, planar.up))),
        origin(toFloat(view.toView(planar.origin))) {}

  // `x` and `y` in posts from the middle, `z` in metres above the base.
  FloatVector at(float x, float y, float z) const {
    return {east.x * x + north.x * y + up.x * z + origin.x, east.y * x + north.y * y + up.y * z + origin.y,
            east.z * x + north.z * y + up.z * z + origin.z};
  }
};

FloatVector stepped(const FloatVector& from, const FloatVector& axis, const FloatVector& up, float delta) {
  return {from.x + (axis.x + delta * up.x), from.y + (axis.y + delta * up.y),
          from.z + (axis.z + delta * up.z)};
}

Vector3 widened(const FloatVector& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

std::size_t postCount(const TerrainTile& tile) {
  return tile.columns < 1 || tile.rows < 1
             ? 0
             : static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
}

// Differences and heights are taken in integers, where they are exact, before they become floats.
float metresOf(std::int64_t quanta, float quantum) {
  return static_cast<float>(quanta) * quantum;
}

}  // namespace

std::string_view transformName(TransformKind kind) {
  switch (kind) {
    case TransformKind::kExact:
      return "exact";
    case TransformKind::kDelta:
      return "delta";
    case TransformKind::kMatrix:
      return "matrix";
    case TransformKind::kLocal:
      return "local";
  }
  return "";
}

Result<TileTransform> TileTransform::make(TransformKind kind, const TerrainTile& tile,
                                          const GridGeometry& geometry) {
  if (!geometry.isGeodetic() && geometry.patches() == nullptr)
    return internalError("transform", "a projected grid's posts cannot be placed without its patches");
  TileTransform transform(kind, tile, geometry);
  if (postCount(tile) == 0) return transform;
  if (kind != TransformKind::kExact) transform.planar_ = planarGridOf(tile, geometry);
  if (kind == TransformKind::kDelta) transform.prepareDeltas();
  if (kind == TransformKind::kMatrix) transform.prepareHeights();
  if (kind == TransformKind::kLocal) transform.prepareOffsets();
  return transform;
}

void TileTransform::prepareDeltas() {
  const TerrainTile& tile = *tile_;
  const auto quantum = static_cast<float>(geometry_->header().quantum.value());
  heights_.reserve(postCount(tile));
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const std::int64_t before = i > 0   ? tile.height(i - 1, j)
                                  : j > 0 ? tile.height(i, j - 1)
                                          : std::int64_t{planar_.base};
      heights_.push_back(metresOf(tile.height(i, j) - before, quantum));
    }
  }
}

void TileTransform::prepareHeights() {
  const TerrainTile& tile = *tile_;
  const auto quantum = static_cast<float>(geometry_->header().quantum.value());
  heights_.reserve(postCount(tile));
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i)
      heights_.push_back(metresOf(std::int64_t{tile.height(i, j)} - planar_.base, quantum));
  }
}

void TileTransform::prepareOffsets() {
  const TerrainTile& tile = *tile_;
  const std::vector<PostPlace> places =
      geometry_->postPlaces(tile.level, {tile.first_column, tile.first_column + tile.columns},
                            {tile.first_row, tile.first_row + tile.rows});
  offsets_.reserve(places.size());
  for (int j = 0; j < tile.rows; ++j) {
    for (int i = 0; i < tile.columns; ++i) {
      const Vector3 offset =
          places[offsets_.size()].at(geometry_->metres(tile.height(i, j))) - planar_.origin;
      offsets_.push_back(
          {static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)});
    }
  }
}

void TileTransform::apply(const ViewTransform& view, std::vector<Vector3>& out) const {
  out.clear();
  if (postCount(*tile_) == 0) return;
  out.reserve(postCount(*tile_));
  switch (kind_) {
    case TransformKind::kExact:
      out = terrainPositions(*tile_, *geometry_, view);
      return;
    case TransformKind::kDelta:
      return applyDelta(view, out);
    case TransformKind::kMatrix:
      return applyMatrix(view, out);
    case TransformKind::kLocal:
      return applyLocal(view, out);
  }
}

void TileTransform::applyDelta(const ViewTransform& view, std::vector<Vector3>& out) const {
  const FloatGrid grid(planar_, view);
  const float* delta = heights_.data();
  FloatVector row_start =
      grid.at(static_cast<float>(-planar_.middle_column), static_cast<float>(-planar_.middle_row), *delta);
  for (int j = 0; j < tile_->rows; ++j) {
    if (j > 0) row_start = stepped(row_start, grid.north, grid.up, *delta);
    ++delta;
    FloatVector post = row_start;
    out.push_back(widened(post));
    for (int i = 1; i < tile_->columns; ++i) {
      post = stepped(post, grid.east, grid.up, *delta++);
      out.push_back(widened(post));
    }
  }
}

void TileTransform::applyMatrix(const ViewTransform& view, std::vector<Vector3>& out) const {
  const FloatGrid grid(planar_, view);
  const float* height = heights_.data();
  for (int j = 0; j < tile_->rows; ++j) {
    const auto y = static_cast<float>(j - planar_.middle_row);
    for (int i = 0; i < tile_->columns; ++i)
      out.push_back(widened(grid.at(static_cast<float>(i - planar_.middle_column), y, *height++)));
  }
}

void TileTransform::applyLocal(const ViewTransform& view, std::vector<Vector3>& out) const {
  const FloatVector u = toFloat(view.forward), v = toFloat(view.right * view.pixels),
                    w = toFloat(view.down * view.pixels), t = toFloat(view.toView(planar_.origin));
  for (const std::array<float, 3>& p : offsets_) {
    out.push_back(
        widened({u.x * p[0] + u.y * p[1] + u.z * p[2] + t.x, v.x * p[0] + v.y * p[1] + v.z * p[2] + t.y,
                 w.x * p[0] + w.y * p[1] + w.z * p[2] + t.z}));
  }
}

Result<std::vector<Vector3>> transformPosts(TransformKind kind, const TerrainTile& tile,
                                            const GridGeometry& geometry, const ViewTransform& view) {
  DELTAZ_TRY_ASSIGN(const TileTransform transform, TileTransform::make(kind, tile, geometry));
  std::vector<Vector3> positions;
  transform.apply(view, positions);
  return positions;
}

}  // namespace deltaz
