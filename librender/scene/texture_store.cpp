#include "librender/scene/texture_store.h"

#include <algorithm>
#include <cstddef>
#include <tbb/parallel_for.h>

namespace deltaz {
namespace {

TextureSquare squareOf(const ColorNode& node) {
  return {node.grid, node.level, node.x, node.y};
}

// The first error of a list of results, in its order.
template <typename T>
Status firstError(const std::vector<std::optional<Result<T>>>& results) {
  for (const auto& result : results) {
    if (!result->ok()) return result->error();
  }
  return Success{};
}

}  // namespace

Result<TextureStore> TextureStore::read(const ColorMap& map, std::vector<TextureSquare> squares) {
  TextureStore store;
  std::sort(squares.begin(), squares.end());
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
  store.squares_ = std::move(squares);

  std::vector<std::optional<Result<std::optional<ColorNode>>>> found(store.squares_.size());
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t n) {
    const TextureSquare& square = store.squares_[n];
    const double cells = colorNodeCells(map.leafCells(square.grid), square.level);
    found[n].emplace(
        map.nodeAt(square.grid, (square.x + 0.5) * cells, (square.y + 0.5) * cells, square.level));
  });
  DELTAZ_TRY(firstError(found));

  // A coarse node may serve many squares.
  std::vector<ColorNode> nodes;
  for (const auto& node : found) {
    if (node->value()) nodes.push_back(*node->value());
  }
  const auto before = [](const ColorNode& a, const ColorNode& b) { return squareOf(a) < squareOf(b); };
  const auto same = [](const ColorNode& a, const ColorNode& b) { return squareOf(a) == squareOf(b); };
  std::sort(nodes.begin(), nodes.end(), before);
  nodes.erase(std::unique(nodes.begin(), nodes.end(), same), nodes.end());
  for (const auto& node : found) {
    if (!node->value()) {
      store.tile_of_.push_back(kNoTile);
      continue;
    }
    const auto at = std::lower_bound(nodes.begin(), nodes.end(), *node->value(), before);
    store.tile_of_.push_back(static_cast<std::uint32_t>(at - nodes.begin()));
  }

  std::vector<std::optional<Result<std::vector<std::uint8_t>>>> texels(nodes.size());
  tbb::parallel_for(std::size_t{0}, nodes.size(),
                    [&](std::size_t n) { texels[n].emplace(map.tile(nodes[n])); });
  DELTAZ_TRY(firstError(texels));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    store.tiles_.push_back({squareOf(nodes[n]), map.leafCells(nodes[n].grid), std::move(*texels[n]).value()});
  return store;
}

const TextureTile* TextureStore::find(const TextureSquare& square) const {
  const auto at = std::lower_bound(squares_.begin(), squares_.end(), square);
  if (at == squares_.end() || *at != square) return nullptr;
  const std::uint32_t tile = tile_of_[static_cast<std::size_t>(at - squares_.begin())];
  return tile == kNoTile ? nullptr : &tiles_[tile];
}

const TextureTile* TextureReader::find(const TextureSquare& square) {
  std::optional<Last>& last = last_[square.level & 1];
  if (!last || last->square != square) last = Last{square, store_.find(square)};
  return last->tile;
}

}  // namespace deltaz
