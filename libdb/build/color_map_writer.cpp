#include "libdb/build/color_map_writer.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace deltaz {

namespace {

// The blocks of places, found by binary search.
class PlaceIndex {
 public:
  explicit PlaceIndex(const std::vector<ColorPlace>& places) : places_(places), order_(places.size()) {
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::uint32_t a, std::uint32_t b) { return places_[a] < places_[b]; });
  }
  // Blocks in the order of their places.
  const std::vector<std::uint32_t>& order() const { return order_; }
  bool hasTwice() const {
    return std::adjacent_find(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
             return places_[a] == places_[b];
           }) != order_.end();
  }
  const std::uint32_t* find(const ColorPlace& place) const {
    const auto found = std::lower_bound(
        order_.begin(), order_.end(), place,
        [&](std::uint32_t block, const ColorPlace& other) { return places_[block] < other; });
    return found != order_.end() && places_[*found] == place ? &*found : nullptr;
  }

 private:
  const std::vector<ColorPlace>& places_;
  std::vector<std::uint32_t> order_;
};

// The trees and their roots, the first records.
std::vector<ColorTree> treesOf(const std::vector<ColorPlace>& places, const PlaceIndex& index,
                               std::vector<ColorNode>& nodes) {
  std::vector<ColorTree> trees;
  const std::vector<std::uint32_t>& order = index.order();
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && places[order[end]].grid == places[order[begin]].grid) ++end;
    ColorTree tree;
    tree.grid = places[order[begin]].grid;
    // Places are in the order of their levels.
    tree.finest_level = places[order[begin]].level;
    tree.coarsest_level = places[order[end - 1]].level;
    tree.first_root = static_cast<std::uint32_t>(nodes.size() + 1);
    tree.root_count = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const ColorPlace& place = places[order[k]];
      if (place.level != tree.coarsest_level) continue;
      nodes.push_back({place.grid, place.level, 0, place.x, place.y, 0, order[k]});
      ++tree.root_count;
    }
    trees.push_back(tree);
    begin = end;
  }
  return trees;
}

}  // namespace

ColorPlace childPlace(const ColorPlace& place, int child_number) {
  const std::int32_t east = child_number == 2 || child_number == 3 ? 1 : 0;
  const std::int32_t north = child_number >= 3 ? 1 : 0;
  return {place.grid, static_cast<std::int8_t>(place.level - 1), 2 * place.x + east, 2 * place.y + north};
}

Result<ColorMapWriter> ColorMapWriter::create(const FileSystem& files, const std::string& path) {
  DELTAZ_TRY_ASSIGN(ContainerWriter file, ContainerWriter::create(files, path, ContentKind::kColors));
  return ColorMapWriter(std::move(file), path);
}

Status ColorMapWriter::add(const ColorPlace& place, std::span<const std::byte> tile) {
  DELTAZ_TRY_ASSIGN(const std::uint32_t block, file_.append(BlockType::kColorTile, tile));
  if (block != places_.size()) return internalError(path_, "a tile is not where its record will say");
  places_.push_back(place);
  return Success{};
}

std::pair<int, int> ColorMapWriter::levels() const {
  const auto [finest, coarsest] =
      std::minmax_element(places_.begin(), places_.end(),
                          [](const ColorPlace& a, const ColorPlace& b) { return a.level < b.level; });
  return {finest->level, coarsest->level};
}

Result<FileIdentity> ColorMapWriter::finish() {
  const PlaceIndex index(places_);
  if (index.hasTwice()) return internalError(path_, "a node of the colour map was written twice");
  ColorDirectory directory;
  directory.node_count = directory.first_page = static_cast<std::uint32_t>(places_.size());
  std::vector<ColorNode> nodes;
  nodes.reserve(places_.size());
  directory.trees = treesOf(places_, index, nodes);
  for (const ColorTree& tree : directory.trees) {
    if (tree.root_count > 4)
      return internalError(path_, fmt::format("grid {} has more than 4 coarsest nodes", tree.grid));
  }
  // Every node is followed, in the end, by its children: breadth first over all trees.
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    ColorNode& node = nodes[k];
    const auto next = static_cast<std::uint32_t>(nodes.size() + 1);
    std::vector<ColorNode> children;
    for (int number = 1; number <= 4 && node.level > kLowestColorLevel; ++number) {
      const ColorPlace place = childPlace({node.grid, node.level, node.x, node.y}, number);
      const std::uint32_t* const block = index.find(place);
      if (block == nullptr) continue;
      node.children = static_cast<std::uint8_t>(node.children | 1u << (number - 1));
      children.push_back({place.grid, place.level, 0, place.x, place.y, 0, *block});
    }
    if (!children.empty()) node.first_child = next;
    nodes.insert(nodes.end(), children.begin(), children.end());
  }
  if (nodes.size() != places_.size()) return internalError(path_, "a node of the colour map has no parent");
  for (std::size_t first = 0; first < nodes.size(); first += kColorNodesPerPage) {
    const std::size_t count = std::min<std::size_t>(kColorNodesPerPage, nodes.size() - first);
    DELTAZ_TRY_ASSIGN(
        [[maybe_unused]] const std::uint32_t block,
        file_.append(BlockType::kColorPage, encodeColorPage(std::span(nodes).subspan(first, count))));
  }
  DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                    file_.append(BlockType::kColorDirectory, encodeColorDirectory(directory)));
  return file_.finish();
}

}  // namespace deltaz
