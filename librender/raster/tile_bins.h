// Which triangles touch which tiles of the picture (the sort of a sort-middle renderer): each worker copies
// the triangles it has made into its own list for each tile; a tile then takes the lists of all workers in
// the order of submission.
//
// The order does not depend on threads: work is cut into items that are numbered by the caller, an item is
// made by one worker from begin to end, and a tile takes its triangles item by item. Memory is kept from
// frame to frame. Thread-safety: one Writer a thread; reading only after all writing.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "librender/raster/raster_triangle.h"

namespace deltaz {

inline constexpr int kTileSide = 64;  // pixels

// Inclusive ranges of tiles.
struct TileRange {
  std::int32_t first_j = 0, first_i = 0, last_j = 0, last_i = 0;
};

class TileBins {
 public:
  // A run of triangles of one item.
  struct Segment {
    std::uint32_t item = 0;
    const RasterTriangle* first = nullptr;
    std::uint32_t count = 0;
  };

  class Writer {
   public:
    // The triangles that follow belong to item `item`.
    void begin(std::uint32_t item) { item_ = item; }
    // Room for a triangle that touches one tile only, to be filled in whole; its `crossing` is 0 already.
    RasterTriangle& add(std::int32_t tile_j, std::int32_t tile_i) {
      RasterTriangle& triangle = *next(bin(tile_j, tile_i));
      triangle.crossing = 0;
      return triangle;
    }
    // A number for a face that is added in several pieces, to count it once.
    std::uint32_t numberForPieces() { return 1 + crossingNumber(); }
    // Adds a piece of a face that has been given `number`.
    void addPiece(RasterTriangle& triangle, const TileRange& tiles, std::uint32_t number) {
      triangle.crossing = number;
      copyTo(triangle, tiles);
    }
    // Adds the triangle to every tile of the range, which lies within the picture.
    void add(RasterTriangle& triangle, const TileRange& tiles) {
      if (tiles.first_j == tiles.last_j && tiles.first_i == tiles.last_i) {
        triangle.crossing = 0;
        *next(bin(tiles.first_j, tiles.first_i)) = triangle;
        return;
      }
      addToSeveral(triangle, tiles);
    }

   private:
    friend class TileBins;
    static constexpr std::size_t kAskedAhead = 4;  // triangles; slabs have as many to spare
    struct Bin {
      RasterTriangle* next = nullptr;
      RasterTriangle* end = nullptr;
      std::uint32_t item = 0xFFFFFFFF;
      std::vector<Segment> segments;  // the last one's count is set when it is closed
      void close();
    };
    Bin& bin(std::int32_t tile_j, std::int32_t tile_i) {
      return bins_[static_cast<std::size_t>(tile_i) * static_cast<std::size_t>(across_) +
                   static_cast<std::size_t>(tile_j)];
    }
    RasterTriangle* next(Bin& bin) {
      if (bin.next == bin.end || bin.item != item_) open(bin);
      // Where later ones go, which was last read a frame ago.
      __builtin_prefetch(bin.next + kAskedAhead, 1);
      return bin.next++;
    }
    void open(Bin& bin);
    void addToSeveral(RasterTriangle& triangle, const TileRange& tiles);
    void copyTo(const RasterTriangle& triangle, const TileRange& tiles);
    RasterTriangle* takeChunk();
    std::uint32_t crossingNumber();

    std::vector<Bin> bins_;
    std::int32_t across_ = 0;
    std::uint32_t item_ = 0;
    std::vector<std::unique_ptr<RasterTriangle[]>> slabs_;
    std::size_t chunks_taken_ = 0;
    std::uint32_t crossing_next_ = 0, crossing_end_ = 0, crossing_used_ = 0;
    std::atomic<std::uint32_t>* crossing_count_ = nullptr;
  };

  // Empties everything for a picture of this size and so many writers; keeps the memory.
  void reset(int width, int height, std::size_t writers);
  Writer& writer(std::size_t n) { return *writers_[n]; }
  // After all writing: closes the lists.
  void finish();

  int tilesAcross() const { return across_; }
  int tilesDown() const { return down_; }
  std::size_t tileCount() const {
    return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_);
  }
  // The runs of a tile in the order of submission; `segments` is replaced.
  void segmentsOf(std::size_t tile, std::vector<Segment>& segments) const;
  // Triangles that touch several tiles, and faces in pieces.
  std::uint64_t crossingTriangles() const;
  // Upper bound of RasterTriangle::crossing; not all numbers below it are used.
  std::uint32_t crossingCount() const { return crossing_count_.load(std::memory_order_relaxed); }

 private:
  int across_ = 0, down_ = 0;
  std::vector<std::unique_ptr<Writer>> writers_;
  std::atomic<std::uint32_t> crossing_count_{0};
};

}  // namespace deltaz
