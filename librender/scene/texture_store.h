// The memory manager of colour (report 5.6): the tiles of a colour map that a frame needs, each read when it
// is first asked for, and once. A cache, if there is one, spares those that earlier frames have read.
//
// What a pixel asks for is a square: the place of a node of some level, whether or not the map has that node.
// Where it has none, the finest coarser node that holds the place serves; all places of a square share it.
//
// Thread-safety: find from any thread; the others when no thread finds. A TextureReader belongs to one
// thread.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "librender/scene/texture_cache.h"

namespace deltaz {

class TextureStore {
 public:
  // Without a map every square is empty. Both must live as long.
  explicit TextureStore(const ColorMap* map = nullptr, TextureCache* cache = nullptr);
  ~TextureStore();
  TextureStore(TextureStore&&) noexcept;
  TextureStore& operator=(TextureStore&&) noexcept;

  const ColorMap* map() const { return map_; }
  // The tile that serves a square, nullptr where the map has no texels or could not be read. It stays where
  // it is.
  const TextureTile* find(const TextureSquare& square);
  // What went wrong in finding: of several errors the first in the order of the squares.
  Status status() const;
  // Tiles that were found, read or at hand.
  std::size_t tileCount() const;

 private:
  struct Contents;
  const ColorMap* map_;
  TextureCache* cache_;
  std::unique_ptr<Contents> contents_;
};

// Looks tiles up in a store; neighbouring pixels mostly want the tiles of the pixel before.
class TextureReader {
 public:
  explicit TextureReader(TextureStore& store) : store_(&store) {}
  const TextureTile* find(const TextureSquare& square);
  TextureStore& store() const { return *store_; }

 private:
  struct Last {
    TextureSquare square;
    const TextureTile* tile = nullptr;
  };
  TextureStore* store_;
  std::array<std::optional<Last>, 2> last_;  // a pixel asks for two levels, one of them even
};

}  // namespace deltaz
