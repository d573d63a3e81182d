// What positions, normals and shading of a tile's posts all start from, made ready once, as lists for a
// vector unit.
//
// Lists of posts have one entry for each post of the tile with its ring, row by row from the ring's
// south-west corner (TerrainTile::index), and the padding of libdb/access/vector_lists.h. Contents are the
// same bits as GridGeometry gives, on every processor. Memory: some 10 doubles a post while it is used;
// nothing is kept for a tile that is not. Thread-safety: const members from any thread.
#pragma once

#include <cstddef>
#include <vector>

#include "libdb/access/grid_geometry.h"
#include "libdb/access/post_axes.h"
#include "libdb/access/terrain_tile.h"
#include "libdb/access/vector_lists.h"

namespace deltaz {

class TilePosts {
 public:
  // `tile` and `geometry` must stay until prepare is called again, which allocates only for a larger tile.
  // Pre: tile.columns, tile.rows >= 1; a projected grid's geometry has its patches.
  void prepare(const TerrainTile& tile, const GridGeometry& geometry);

  const TerrainTile& tile() const { return *tile_; }
  const GridGeometry& geometry() const { return *geometry_; }
  bool isGeodetic() const { return geometry_->isGeodetic(); }
  std::size_t stride() const { return static_cast<std::size_t>(tile_->columns) + 2; }

  const std::vector<double>& heights() const { return heights_; }  // metres
  // 1 or 0; empty if the whole tile is valid, the ring included.
  const std::vector<double>& valid() const { return valid_; }

  // Geodetic grids: of the rows and columns of the tile, beginning with the ring's.
  const std::vector<RowTerms>& rows() const { return rows_; }
  const ColumnTerms& columns() const { return columns_; }

  // Projected grids: Earth-centred metres, and the ellipsoid normals.
  const VectorLists& positions() const { return positions_; }
  const VectorLists& ups() const { return ups_; }

 private:
  const TerrainTile* tile_ = nullptr;
  const GridGeometry* geometry_ = nullptr;
  std::vector<double> heights_, valid_;
  std::vector<RowTerms> rows_;
  ColumnTerms columns_;
  VectorLists positions_, ups_;
};

}  // namespace deltaz
