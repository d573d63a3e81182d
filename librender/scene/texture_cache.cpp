#include "librender/scene/texture_cache.h"

namespace deltaz {
namespace {

std::size_t bytesOf(const TextureTile& tile) {
  return tile.texels.size() + tile.linear.size() * sizeof(float);
}

}  // namespace

std::shared_ptr<const TextureTile> TextureCache::find(const FileIdentity& file, const TextureSquare& square) {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find({file.id.bytes, square});
  if (place == places_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, place->second);
  return place->second->tile;
}

void TextureCache::add(const FileIdentity& file, const std::shared_ptr<const TextureTile>& tile) {
  const Key key{file.id.bytes, tile->square};
  const std::lock_guard lock(mutex_);
  if (places_.contains(key)) return;
  entries_.push_front({key, tile});
  places_.emplace(key, entries_.begin());
  bytes_ += bytesOf(*tile);
  while (bytes_ > capacity_) {
    bytes_ -= bytesOf(*entries_.back().tile);
    places_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

std::size_t TextureCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace deltaz
