#include "librender/raster/mesh_renderer.h"

#include <algorithm>
#include <hwy/cache_control.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unordered_map>

#include "librender/raster/grid_culler.h"
#include "librender/raster/tile_rasterizer.h"
#include "librender/raster/triangle_placement.h"
#include "librender/raster/vertex_projection.h"

namespace deltaz {
namespace {

// Cells of a grid that are one item of work.
// Long rows, so that the processor sees what is read next; their vertices fill vectors of 16.
constexpr int kItemColumns = 255, kItemRows = 32;
constexpr std::size_t kMeshletVertices = 255, kMeshletTriangles = 255;
constexpr std::size_t kLeastMeshletsOfItem = 8, kMostItemsOfMesh = 256;

struct Item {
  bool grid = true;
  std::uint32_t mesh = 0;
  std::uint32_t first = 0, count = 0;              // meshlets
  int column = 0, row = 0, columns = 0, rows = 0;  // cells of a grid
};

// Room for a meshlet's vertices.
struct MeshletRoom {
  static constexpr std::size_t kVertices = 256 + kRowPadding;
  alignas(64) std::array<RasterVertex, kVertices> vertex;
  alignas(64) std::array<std::int32_t, kVertices> snapped_x, snapped_y;
};

// Room for one row of an item's vertices.
struct RowRoom {
  static constexpr std::size_t kVertices = kItemColumns + 1 + 2 * kRowPadding;
  alignas(64) std::array<float, kVertices> x, y, inverse_u;
  alignas(64) std::array<std::int32_t, kVertices> snapped_x, snapped_y;
  // Of some: what triangles are made of.
  alignas(64) std::array<RasterVertex, kVertices> vertex;
  std::size_t first_whole = 0, end_whole = 0;

  // Makes whole vertices of those from `first` up to `end`.
  void makeWhole(std::size_t first, std::size_t end, const std::uint32_t* colors) {
    if (first >= first_whole && end <= end_whole) return;
    for (std::size_t n = first; n < end; ++n) vertex[n] = {x[n], y[n], inverse_u[n], colors[n]};
    first_whole = first;
    end_whole = end;
  }
};

TileRange unpacked(std::uint32_t range) {
  return {static_cast<std::int32_t>(range & 0xFF), static_cast<std::int32_t>(range >> 8 & 0xFF),
          static_cast<std::int32_t>(range >> 16 & 0xFF), static_cast<std::int32_t>(range >> 24)};
}

bool isOneTile(std::uint32_t range) {
  return (range & 0xFFFF) == range >> 16;
}

void add(const CullCounts& culled, MeshCounts& counts) {
  counts.in += culled.in;
  counts.outside += culled.outside;
  counts.back_facing += culled.back_facing;
  counts.no_sample += culled.no_sample;
}

Vector3 meshPosition(const ViewTransform& view, const MeshVertices& vertices, std::size_t index) {
  return view.toView({static_cast<double>(vertices.x[index]), static_cast<double>(vertices.y[index]),
                      static_cast<double>(vertices.z[index])});
}

std::uint32_t mixedColor(const std::array<std::uint32_t, 3>& colors, const std::array<float, 2>& weight) {
  std::uint32_t mixed = 0xFF000000;
  for (int channel = 0; channel < 3; ++channel) {
    const auto value = [&](std::size_t k) { return static_cast<float>(colors[k] >> (8 * channel) & 0xFF); };
    const float sum = value(0) * (1 - weight[0] - weight[1]) + value(1) * weight[0] + value(2) * weight[1];
    mixed |= static_cast<std::uint32_t>(std::clamp(sum + 0.5F, 0.0F, 255.0F)) << (8 * channel);
  }
  return mixed;
}

}  // namespace

std::size_t MeshVertices::size() const {
  return x.size() - kRowPadding;
}

void MeshVertices::append(float vertex_x, float vertex_y, float vertex_z, std::uint32_t color) {
  x.push_back(vertex_x);
  y.push_back(vertex_y);
  z.push_back(vertex_z);
  rgba.push_back(color);
}

void MeshVertices::pad() {
  const std::size_t padded = x.size() + kRowPadding;
  x.resize(padded);
  y.resize(padded);
  z.resize(padded);
  rgba.resize(padded);
}

IndexedMesh::IndexedMesh(const MeshVertices& vertices,
                         std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::unordered_map<std::uint32_t, std::uint8_t> local;
  const auto close = [&] {
    if (meshlets_.empty()) return;
    meshlets_.back().vertices =
        static_cast<std::uint32_t>(vertices_.x.size()) - meshlets_.back().first_vertex;
    meshlets_.back().triangles =
        static_cast<std::uint32_t>(corners_[0].size()) - meshlets_.back().first_triangle;
  };
  const auto open = [&] {
    close();
    local.clear();
    meshlets_.push_back({static_cast<std::uint32_t>(vertices_.x.size()), 0,
                         static_cast<std::uint32_t>(corners_[0].size()), 0});
  };
  for (const std::array<std::uint32_t, 3>& triangle : triangles) {
    if (meshlets_.empty() || local.size() + 3 > kMeshletVertices ||
        corners_[0].size() - meshlets_.back().first_triangle == kMeshletTriangles)
      open();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, is_new] = local.try_emplace(triangle[k], static_cast<std::uint8_t>(local.size()));
      corners_[k].push_back(found->second);
      if (is_new)
        vertices_.append(vertices.x[triangle[k]], vertices.y[triangle[k]], vertices.z[triangle[k]],
                         vertices.rgba[triangle[k]]);
    }
  }
  close();
  vertices_.pad();
  for (std::vector<std::uint8_t>& corners : corners_) corners.resize(corners.size() + kRowPadding);
}

struct MeshRenderer::Worker {
  RowRoom rows[2];
  MeshletRoom meshlet_room;
  static constexpr std::size_t kFaces = std::max<std::size_t>(kItemColumns, kMeshletTriangles);
  std::array<std::uint32_t, 2 * (kFaces + kRowPadding)> face, tiles;
  MeshCounts counts;
  TileBuffer buffer;
  TileCounts tile_counts;
  std::vector<TileBins::Segment> segments;
  std::vector<const RasterTriangle*> triangles;
  GouraudScratch scratch;

  void drawGrid(const ViewTransform& view, const MeshProjection& projection, const GridMesh& mesh,
                const Item& item, TileBins::Writer& writer);
  void drawMeshlets(const ViewTransform& view, const MeshProjection& projection, const IndexedMesh& mesh,
                    const Item& item, TileBins::Writer& writer);
  // A face the integer tests could not decide.
  void drawCarefully(const ViewTransform& view, const MeshVertices& vertices,
                     const std::array<std::size_t, 3>& corners, TileBins::Writer& writer);
};

MeshRenderer::MeshRenderer() = default;
MeshRenderer::~MeshRenderer() = default;

void MeshRenderer::Worker::drawGrid(const ViewTransform& view, const MeshProjection& projection,
                                    const GridMesh& mesh, const Item& item, TileBins::Writer& writer) {
  const auto columns = static_cast<std::size_t>(mesh.columns);
  const auto first_of = [&](int row) {
    return static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(item.column);
  };
  const MeshVertices& v = mesh.vertices;
  const auto project = [&](int row, RowRoom& room) {
    const std::size_t first = first_of(row);
    room.first_whole = room.end_whole = 0;
    projection.project(v.x.data() + first, v.y.data() + first, v.z.data() + first,
                       static_cast<std::size_t>(item.columns) + 1,
                       ProjectedArrays{room.x.data(), room.y.data(), room.inverse_u.data(),
                                       room.snapped_x.data(), room.snapped_y.data()});
  };
  RowRoom *south = &rows[0], *north = &rows[1];
  project(item.row, *south);
  CullCounts culled;
  std::size_t first_kept = static_cast<std::size_t>(item.columns), last_kept = 0;  // of the row before
  for (int row = item.row; row < item.row + item.rows; ++row) {
    project(row + 1, *north);
    // What the processor does not see coming: rows lie far apart.
    if (row + 1 < item.row + item.rows) {
      const std::size_t next = first_of(row + 2);
      for (std::size_t n = 0; n < static_cast<std::size_t>(item.columns); n += 16) {
        __builtin_prefetch(v.x.data() + next + n);
        __builtin_prefetch(v.y.data() + next + n);
        __builtin_prefetch(v.z.data() + next + n);
      }
      // Of the colours what the row before needed.
      for (std::size_t n = first_kept; n <= last_kept; n += 16) __builtin_prefetch(v.rgba.data() + next + n);
    }
    first_kept = static_cast<std::size_t>(item.columns);
    last_kept = 0;
    const GridRow cells{south->snapped_x.data(),
                        south->snapped_y.data(),
                        north->snapped_x.data(),
                        north->snapped_y.data(),
                        static_cast<std::size_t>(item.columns),
                        nullptr};
    CulledFaces faces{face.data(), tiles.data(), 0};
    cullGridRow(cells, view.width, view.height, faces, culled);
    const std::uint32_t* const south_color = v.rgba.data() + first_of(row);
    const std::uint32_t* const north_color = south_color + columns;
    for (std::size_t n = 0; n < faces.count; ++n) {
      const std::size_t cell = faces.face[n] >> 1;
      first_kept = std::min(first_kept, cell);
      last_kept = std::max(last_kept, cell + 1);
    }
    south->makeWhole(first_kept, last_kept + 1, south_color);
    north->makeWhole(first_kept, last_kept + 1, north_color);
    for (std::size_t n = 0; n < faces.count; ++n) {
      const std::uint32_t cell = faces.face[n] >> 1, range = faces.tiles[n];
      const bool top = (faces.face[n] & 1) != 0;
      if (range == kExceptional) {
        const std::size_t south_west = first_of(row) + cell, north_west = south_west + columns;
        drawCarefully(view, mesh.vertices,
                      {south_west, top ? north_west : north_west + 1, top ? north_west + 1 : south_west + 1},
                      writer);
        continue;
      }
      RasterTriangle several;
      RasterTriangle& triangle = isOneTile(range) ? writer.add(static_cast<std::int32_t>(range & 0xFF),
                                                               static_cast<std::int32_t>(range >> 8 & 0xFF))
                                                  : several;
      triangle.vertex[0] = south->vertex[cell];
      triangle.vertex[1] = north->vertex[top ? cell : cell + 1];
      triangle.vertex[2] = (top ? north : south)->vertex[cell + 1];
      triangle.node = 0;
      triangle.face = faces.face[n];
      if (!isOneTile(range)) writer.add(triangle, unpacked(range));
    }
    std::swap(south, north);
  }
  add(culled, counts);
}

void MeshRenderer::Worker::drawMeshlets(const ViewTransform& view, const MeshProjection& projection,
                                        const IndexedMesh& mesh, const Item& item, TileBins::Writer& writer) {
  const MeshVertices& v = mesh.vertices();
  const MeshletRoom& room = meshlet_room;
  CullCounts culled;
  for (std::uint32_t m = item.first; m < item.first + item.count; ++m) {
    const IndexedMesh::Meshlet& meshlet = mesh.meshlets()[m];
    const std::size_t first = meshlet.first_vertex;
    projection.project(
        v.x.data() + first, v.y.data() + first, v.z.data() + first, v.rgba.data() + first, meshlet.vertices,
        {meshlet_room.vertex.data(), meshlet_room.snapped_x.data(), meshlet_room.snapped_y.data()});
    // Counter-clockwise seen from the front runs clockwise on the screen in the opposite order.
    const std::uint8_t *const a = mesh.corners(0).data() + meshlet.first_triangle,
                              *const b = mesh.corners(2).data() + meshlet.first_triangle,
                              *const c = mesh.corners(1).data() + meshlet.first_triangle;
    CulledFaces faces{face.data(), tiles.data(), 0};
    cullIndexedFaces({a, b, c, meshlet.triangles, room.snapped_x.data(), room.snapped_y.data()}, view.width,
                     view.height, faces, culled);
    for (std::size_t n = 0; n < faces.count; ++n) {
      const std::uint32_t t = faces.face[n], range = faces.tiles[n];
      if (range == kExceptional) {
        drawCarefully(view, v, {first + a[t], first + b[t], first + c[t]}, writer);
        continue;
      }
      RasterTriangle several;
      RasterTriangle& triangle = isOneTile(range) ? writer.add(static_cast<std::int32_t>(range & 0xFF),
                                                               static_cast<std::int32_t>(range >> 8 & 0xFF))
                                                  : several;
      triangle.vertex[0] = room.vertex[a[t]];
      triangle.vertex[1] = room.vertex[b[t]];
      triangle.vertex[2] = room.vertex[c[t]];
      triangle.node = 0;
      triangle.face = meshlet.first_triangle + t;
      if (!isOneTile(range)) writer.add(triangle, unpacked(range));
    }
  }
  add(culled, counts);
}

void MeshRenderer::Worker::drawCarefully(const ViewTransform& view, const MeshVertices& vertices,
                                         const std::array<std::size_t, 3>& corners,
                                         TileBins::Writer& writer) {
  std::array<Vector3, 3> positions;
  std::array<std::uint32_t, 3> colors{};
  for (std::size_t k = 0; k < 3; ++k) {
    positions[k] = meshPosition(view, vertices, corners[k]);
    colors[k] = vertices.rgba[corners[k]];
  }
  if (isOutsidePicture(positions, view.width, view.height)) {
    ++counts.outside;
    return;
  }
  const ClippedFace clipped = clipFace(positions);
  RasterTriangle triangle;
  triangle.node = triangle.face = 0;
  // A face of several pieces is counted once: by the worst that befell all of them, or as drawn.
  TriangleFate fate = TriangleFate::kOutside;
  std::uint32_t number = 0;
  for (std::size_t k = 1; k + 1 < clipped.corners; ++k) {
    const std::array<std::size_t, 3> corner = {0, k, k + 1};
    std::array<std::int32_t, 3> x{}, y{};
    for (std::size_t n = 0; n < 3; ++n) {
      triangle.vertex[n] = clipped.corner[corner[n]];
      triangle.vertex[n].payload = mixedColor(colors, clipped.weight[corner[n]]);
      x[n] = snappedCoordinate(triangle.vertex[n].x, view.width);
      y[n] = snappedCoordinate(triangle.vertex[n].y, view.height);
    }
    const TrianglePlacement placed = placeTriangle(x, y, view.width, view.height);
    if (placed.fate != TriangleFate::kKept) {
      fate = std::max(fate, placed.fate);
      continue;
    }
    if (number == 0) number = writer.numberForPieces();
    writer.addPiece(triangle, placed.tiles, number);
  }
  if (number != 0) return;
  counts.outside += fate == TriangleFate::kOutside ? 1 : 0;
  counts.back_facing += fate == TriangleFate::kBackFacing ? 1 : 0;
  counts.no_sample += fate == TriangleFate::kNoSample ? 1 : 0;
}

MeshCounts MeshRenderer::draw(const ViewTransform& view, std::span<const GridMesh> grids,
                              std::span<const IndexedMesh> meshes, ColorFrame& frame) {
  std::vector<Item> items;
  for (std::uint32_t n = 0; n < grids.size(); ++n) {
    const int columns = grids[n].columns - 1, rows = grids[n].rows - 1;
    for (int row = 0; row < rows; row += kItemRows) {
      for (int column = 0; column < columns; column += kItemColumns)
        items.push_back({true, n, 0, 0, column, row, std::min(kItemColumns, columns - column),
                         std::min(kItemRows, rows - row)});
    }
  }
  for (std::uint32_t n = 0; n < meshes.size(); ++n) {
    const std::size_t count = meshes[n].meshlets().size();
    const std::size_t of_item =
        std::max(kLeastMeshletsOfItem, (count + kMostItemsOfMesh - 1) / kMostItemsOfMesh);
    for (std::size_t first = 0; first < count; first += of_item)
      items.push_back({false, n, static_cast<std::uint32_t>(first),
                       static_cast<std::uint32_t>(std::min(of_item, count - first)), 0, 0, 0, 0});
  }

  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  while (workers_.size() < threads) workers_.push_back(std::make_unique<Worker>());
  for (const std::unique_ptr<Worker>& worker : workers_) {
    worker->counts = {};
    worker->tile_counts = {};
    // From here on shading leaves it clear; a frame that memory ran out for did not.
    worker->buffer.clear();
  }
  const auto own = [] { return static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()); };

  bins_.reset(view.width, view.height, threads);
  const MeshProjection projection(view);
  tbb::parallel_for(std::size_t{0}, items.size(), [&](std::size_t n) {
    Worker& worker = *workers_[own()];
    TileBins::Writer& writer = bins_.writer(own());
    writer.begin(static_cast<std::uint32_t>(n));
    const Item& item = items[n];
    if (item.grid) {
      worker.drawGrid(view, projection, grids[item.mesh], item, writer);
    } else {
      worker.drawMeshlets(view, projection, meshes[item.mesh], item, writer);
    }
  });
  bins_.finish();

  crossing_.reset(threads, 1 + bins_.crossingCount());
  const auto draw_tile = [&](std::size_t t) {
    Worker& worker = *workers_[own()];
    bins_.segmentsOf(t, worker.segments);
    std::size_t count = 0;
    for (const TileBins::Segment& segment : worker.segments) count += segment.count;
    worker.triangles.resize(count);
    const RasterTriangle** next = worker.triangles.data();
    for (const TileBins::Segment& segment : worker.segments) {
      for (std::uint32_t n = 0; n < segment.count; ++n) {
        // On its way while the others are listed.
        hwy::Prefetch(segment.first + n);
        *next++ = segment.first + n;
      }
    }
    const auto across = static_cast<std::size_t>(bins_.tilesAcross());
    const Tile tile{static_cast<int>(t % across), static_cast<int>(t / across), view.width, view.height};
    rasterizeTile(tile, worker.triangles, 0, crossing_.notesOf(own()), worker.buffer, worker.tile_counts);
    shadeTileGouraud(tile, worker.triangles, worker.buffer, worker.scratch, frame);
  };
  const tbb::blocked_range<std::size_t> all_tiles(0, bins_.tileCount());
  tbb::parallel_for(all_tiles, [&](const tbb::blocked_range<std::size_t>& tiles) {
    for (std::size_t t = tiles.begin(); t < tiles.end(); ++t) draw_tile(t);
    // Pixels that passed the caches are there before another thread goes on.
    hwy::FlushStream();
  });

  MeshCounts counts;
  for (const std::unique_ptr<Worker>& worker : workers_) {
    counts.in += worker->counts.in;
    counts.outside += worker->counts.outside;
    counts.back_facing += worker->counts.back_facing;
    counts.no_sample += worker->counts.no_sample + worker->tile_counts.no_sample;
    counts.drawn += worker->tile_counts.drawn;
    counts.hidden += worker->tile_counts.hidden;
    counts.samples_tested += worker->tile_counts.tested;
    counts.samples_written += worker->tile_counts.written;
  }
  const CrossingFates::Counts crossing = crossing_.counted();
  counts.drawn += crossing.covering + crossing.hidden;
  counts.hidden += crossing.hidden;
  counts.no_sample += bins_.crossingTriangles() - crossing.covering - crossing.hidden;
  return counts;
}

}  // namespace deltaz
