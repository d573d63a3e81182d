// Tiles of colour maps that stay at hand from frame to frame, decoded and ready to be filtered: reading them
// anew costs more than drawing with them.
//
// Bounded: when there are more than `capacity` bytes, those used longest ago are let go. Tiles are known by
// the identity of their file, so that the cache may serve any number of databases. Thread-safety: from any
// thread.
#pragma once

#include <array>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "librender/scene/texture_tile.h"

namespace deltaz {

class TextureCache {
 public:
  static constexpr std::size_t kDefaultCapacity = std::size_t{256} << 20;  // some 760 tiles

  explicit TextureCache(std::size_t capacity = kDefaultCapacity) : capacity_(capacity) {}

  // Nothing if it is not there.
  std::shared_ptr<const TextureTile> find(const FileIdentity& file, const TextureSquare& square);
  void add(const FileIdentity& file, const std::shared_ptr<const TextureTile>& tile);
  std::size_t bytes() const;

 private:
  using Key = std::pair<std::array<std::byte, 16>, TextureSquare>;  // hash of the file's contents
  struct Entry {
    Key key;
    std::shared_ptr<const TextureTile> tile;
  };
  mutable std::mutex mutex_;
  std::size_t capacity_, bytes_ = 0;
  std::list<Entry> entries_;  // the last used first
  std::map<Key, std::list<Entry>::iterator> places_;
};

}  // namespace deltaz
