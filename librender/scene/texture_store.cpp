#include "librender/scene/texture_store.h"

#include <cstddef>
#include <map>
#include <mutex>
#include <utility>

namespace deltaz {
namespace {

TextureSquare squareOf(const ColorNode& node) {
  return {node.grid, node.level, node.x, node.y};
}

// Entries that are made once, by whoever asks first; others wait for that one alone.
template <typename Value>
class MadeOnce {
 public:
  template <typename Make>
  const Value& at(const TextureSquare& square, const Make& make) {
    Entry* entry = nullptr;
    {
      const std::lock_guard lock(mutex_);
      std::unique_ptr<Entry>& place = entries_[square];
      if (!place) place = std::make_unique<Entry>();
      entry = place.get();
    }
    std::call_once(entry->once, [&] { entry->value = make(); });
    return entry->value;
  }

  // In the order of the squares.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (const auto& [square, entry] : entries_) visit(entry->value);
  }

 private:
  struct Entry {
    std::once_flag once;
    Value value;
  };
  std::mutex mutex_;
  std::map<TextureSquare, std::unique_ptr<Entry>> entries_;
};

struct Served {
  const TextureTile* tile = nullptr;
  Status status = Success{};
};
struct Read {
  std::shared_ptr<const TextureTile> tile;
  Status status = Success{};
};

}  // namespace

struct TextureStore::Contents {
  MadeOnce<Served> squares;
  MadeOnce<Read> nodes;  // by their own squares: a coarse one may serve many
};

TextureStore::TextureStore(const ColorMap* map, TextureCache* cache)
    : map_(map), cache_(cache), contents_(std::make_unique<Contents>()) {}
TextureStore::~TextureStore() = default;
TextureStore::TextureStore(TextureStore&&) noexcept = default;
TextureStore& TextureStore::operator=(TextureStore&&) noexcept = default;

const TextureTile* TextureStore::find(const TextureSquare& square) {
  if (map_ == nullptr) return nullptr;
  const Served& served = contents_->squares.at(square, [&]() -> Served {
    const double cells = colorNodeCells(map_->leafCells(square.grid), square.level);
    const Result<std::optional<ColorNode>> found =
        map_->nodeAt(square.grid, (square.x + 0.5) * cells, (square.y + 0.5) * cells, square.level);
    if (!found.ok()) return {nullptr, found.error()};
    if (!found.value()) return {};
    const ColorNode& node = *found.value();
    const Read& read = contents_->nodes.at(squareOf(node), [&]() -> Read {
      const FileIdentity& file = map_->file().identity();
      if (cache_ != nullptr) {
        if (std::shared_ptr<const TextureTile> tile = cache_->find(file, squareOf(node)))
          return {std::move(tile), Success{}};
      }
      Result<std::vector<std::uint8_t>> texels = map_->tile(node);
      if (!texels.ok()) return {nullptr, texels.error()};
      auto tile = std::make_shared<TextureTile>();
      *tile = {squareOf(node), map_->leafCells(node.grid), std::move(texels).value(), {}};
      makeLinear(*tile);
      if (cache_ != nullptr) cache_->add(file, tile);
      return {std::move(tile), Success{}};
    });
    if (!read.status.ok()) return {nullptr, read.status};
    return {read.tile.get(), Success{}};
  });
  return served.tile;
}

Status TextureStore::status() const {
  Status first = Success{};
  contents_->squares.forEach([&](const Served& served) {
    if (first.ok()) first = served.status;
  });
  return first;
}

std::size_t TextureStore::tileCount() const {
  std::size_t count = 0;
  contents_->nodes.forEach([&](const Read& read) { count += read.status.ok() ? 1 : 0; });
  return count;
}

const TextureTile* TextureReader::find(const TextureSquare& square) {
  std::optional<Last>& last = last_[square.level & 1];
  if (!last || last->square != square) last = Last{square, store_->find(square)};
  return last->tile;
}

}  // namespace deltaz
