#include "formats/color_file.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "formats/bytes.h"
#include "formats/zstd_packing.h"

namespace deltaz {

namespace {

constexpr std::size_t kNodeBytes = 24, kTreeBytes = 16, kDirectoryHeaderBytes = 16, kTileHeaderBytes = 4;
constexpr std::uint32_t kMostRoots = 4;
constexpr std::uint8_t kHasCover = 1;
constexpr std::size_t kTexels = kColorTileBytes / 4;

Error badTree(const std::string& where, const char* why) {
  return invalidError(IssueCode::kColorTree, where, "this is no part of a colour map's tree", why);
}

bool isLevel(int level) {
  return level >= kLowestColorLevel && level <= kHighestColorLevel;
}

// What is subtracted from a value of a plane: its west, south and south-west neighbours' plane through them,
// kept within the two nearer ones (the median of LOCO-I).
std::uint8_t prediction(std::span<const std::byte> plane, std::size_t k) {
  constexpr std::size_t kSide = kColorTileSide;
  const auto at = [&](std::size_t index) { return std::to_integer<int>(plane[index]); };
  const bool first_column = k % kSide == 0, first_row = k < kSide;
  if (first_column && first_row) return 0;
  if (first_row) return static_cast<std::uint8_t>(at(k - 1));
  if (first_column) return static_cast<std::uint8_t>(at(k - kSide));
  const int west = at(k - 1), south = at(k - kSide), corner = at(k - kSide - 1);
  const auto [low, high] = std::minmax(west, south);
  return static_cast<std::uint8_t>(std::clamp(west + south - corner, low, high));
}

std::byte difference(std::byte a, std::uint8_t b) {
  return static_cast<std::byte>(std::to_integer<unsigned>(a) - b);
}
std::byte sum(std::byte a, std::uint8_t b) {
  return static_cast<std::byte>(std::to_integer<unsigned>(a) + b);
}

}  // namespace

std::vector<std::byte> encodeColorDirectory(const ColorDirectory& directory) {
  ByteWriter writer;
  writer.put(directory.node_count);
  writer.put(directory.first_page);
  writer.put(static_cast<std::uint32_t>(directory.trees.size()));
  writer.put(static_cast<std::uint32_t>(kColorTileTexels));
  for (const ColorTree& tree : directory.trees) {
    writer.put(tree.grid);
    writer.put(tree.coarsest_level);
    writer.put(tree.finest_level);
    writer.put(tree.first_root);
    writer.put(tree.root_count);
    writer.put(std::uint32_t{0});
  }
  return writer.take();
}

Result<ColorDirectory> decodeColorDirectory(std::span<const std::byte> bytes, std::uint32_t blocks,
                                            const std::string& where) {
  if (bytes.size() < kDirectoryHeaderBytes) return badTree(where, "the directory is too short");
  ByteReader reader(bytes);
  ColorDirectory directory;
  directory.node_count = reader.get<std::uint32_t>();
  directory.first_page = reader.get<std::uint32_t>();
  const auto trees = reader.get<std::uint32_t>();
  if (reader.get<std::uint32_t>() != kColorTileTexels) return badTree(where, "its tiles are of another size");
  if (reader.remaining() != std::size_t{trees} * kTreeBytes)
    return badTree(where, "the directory has the wrong length");
  // Every node has a tile of its own, then come the pages, then the directory.
  const std::uint64_t pages =
      (std::uint64_t{directory.node_count} + kColorNodesPerPage - 1) / kColorNodesPerPage;
  if (directory.first_page != directory.node_count ||
      std::uint64_t{directory.first_page} + pages + 1 != blocks)
    return badTree(where, "its counts are not those of the file");
  std::uint64_t roots = 1;
  for (std::uint32_t t = 0; t < trees; ++t) {
    ColorTree tree;
    tree.grid = reader.get<std::uint16_t>();
    tree.coarsest_level = reader.get<std::int8_t>();
    tree.finest_level = reader.get<std::int8_t>();
    tree.first_root = reader.get<std::uint32_t>();
    tree.root_count = reader.get<std::uint32_t>();
    if (reader.get<std::uint32_t>() != 0) return badTree(where, "a reserved byte is not zero");
    if (!isLevel(tree.coarsest_level) || !isLevel(tree.finest_level) ||
        tree.finest_level > tree.coarsest_level)
      return badTree(where, "a tree's levels are out of range");
    if (!directory.trees.empty() && directory.trees.back().grid >= tree.grid)
      return badTree(where, "the trees are not in the order of their grids");
    if (tree.first_root != roots || tree.root_count < 1 || tree.root_count > kMostRoots)
      return badTree(where, "a tree's coarsest nodes are not where they should be");
    roots += tree.root_count;
    directory.trees.push_back(tree);
  }
  if (roots - 1 > directory.node_count) return badTree(where, "there are more trees than nodes");
  return directory;
}

std::vector<std::byte> encodeColorPage(std::span<const ColorNode> nodes) {
  assert(nodes.size() <= kColorNodesPerPage);
  ByteWriter writer;
  for (const ColorNode& node : nodes) {
    writer.put(node.grid);
    writer.put(node.level);
    writer.put(node.children);
    writer.put(node.x);
    writer.put(node.y);
    writer.put(node.first_child);
    writer.put(node.block);
    writer.put(std::uint32_t{0});
  }
  return writer.take();
}

Result<std::vector<ColorNode>> decodeColorPage(std::span<const std::byte> bytes, const std::string& where) {
  if (bytes.empty() || bytes.size() % kNodeBytes != 0 || bytes.size() > kNodeBytes * kColorNodesPerPage)
    return badTree(where, "a page has the wrong length");
  ByteReader reader(bytes);
  std::vector<ColorNode> nodes(bytes.size() / kNodeBytes);
  for (ColorNode& node : nodes) {
    node.grid = reader.get<std::uint16_t>();
    node.level = reader.get<std::int8_t>();
    node.children = reader.get<std::uint8_t>();
    node.x = reader.get<std::int32_t>();
    node.y = reader.get<std::int32_t>();
    node.first_child = reader.get<std::uint32_t>();
    node.block = reader.get<std::uint32_t>();
    if (reader.get<std::uint32_t>() != 0) return badTree(where, "a reserved byte is not zero");
    if (!isLevel(node.level)) return badTree(where, "a node's level is out of range");
    if (node.children > 15 || (node.children == 0) != (node.first_child == 0))
      return badTree(where, "a node's children do not agree with each other");
  }
  return nodes;
}

std::vector<std::byte> encodeColorTile(std::span<const std::uint8_t> texels) {
  assert(texels.size() == kColorTileBytes);
  bool covered = true;
  for (std::size_t k = 0; k < kTexels; ++k) covered = covered && texels[4 * k + 3] == 255;
  // Red and blue follow green: what is left of them after it is small.
  std::vector<std::byte> planes((covered ? 3 : 4) * kTexels);
  for (std::size_t k = 0; k < kTexels; ++k) {
    const std::uint8_t green = texels[4 * k + 1];
    planes[k] = static_cast<std::byte>(green);
    planes[kTexels + k] = difference(static_cast<std::byte>(texels[4 * k]), green);
    planes[2 * kTexels + k] = difference(static_cast<std::byte>(texels[4 * k + 2]), green);
    if (!covered) planes[3 * kTexels + k] = static_cast<std::byte>(texels[4 * k + 3]);
  }
  for (std::size_t begin = 0; begin < planes.size(); begin += kTexels) {
    const std::span<std::byte> plane = std::span(planes).subspan(begin, kTexels);
    // Backwards, so that predictions are made of the values themselves.
    for (std::size_t k = kTexels; k-- > 0;) plane[k] = difference(plane[k], prediction(plane, k));
  }
  ByteWriter writer;
  writer.put(covered ? std::uint8_t{0} : kHasCover);
  writer.putZeros(kTileHeaderBytes - writer.size());
  writer.putBytes(packBytes(planes));
  return writer.take();
}

Result<std::vector<std::uint8_t>> decodeColorTile(std::span<const std::byte> bytes,
                                                  const std::string& where) {
  const auto damaged = [&](const char* why) {
    return invalidError(IssueCode::kColorTile, where, "a tile of texels cannot be unpacked", why);
  };
  if (bytes.size() < kTileHeaderBytes) return damaged("it is too short");
  ByteReader reader(bytes);
  const auto flags = reader.get<std::uint8_t>();
  const bool reserved = reader.get<std::uint8_t>() != 0 || reader.get<std::uint16_t>() != 0;
  if (flags > kHasCover || reserved) return damaged("its header has a wrong value");
  const bool covered = (flags & kHasCover) == 0;
  std::vector<std::byte> planes((covered ? 3 : 4) * kTexels);
  if (!unpackBytes(reader.rest(), planes)) return damaged("its compressed bytes are not what zstd wrote");
  for (std::size_t begin = 0; begin < planes.size(); begin += kTexels) {
    const std::span<std::byte> plane = std::span(planes).subspan(begin, kTexels);
    for (std::size_t k = 0; k < kTexels; ++k) plane[k] = sum(plane[k], prediction(plane, k));
  }
  std::vector<std::uint8_t> texels(kColorTileBytes);
  bool all_covered = true;
  for (std::size_t k = 0; k < kTexels; ++k) {
    const auto green = std::to_integer<std::uint8_t>(planes[k]);
    std::uint8_t* texel = &texels[4 * k];
    texel[0] = std::to_integer<std::uint8_t>(sum(planes[kTexels + k], green));
    texel[1] = green;
    texel[2] = std::to_integer<std::uint8_t>(sum(planes[2 * kTexels + k], green));
    texel[3] = covered ? std::uint8_t{255} : std::to_integer<std::uint8_t>(planes[3 * kTexels + k]);
    all_covered = all_covered && texel[3] == 255;
    if (texel[3] == 0 && (texel[0] | texel[1] | texel[2]) != 0)
      return damaged("a texel has a colour and no cover");
  }
  // One tile, one spelling.
  if (all_covered != covered) return damaged("it says its cover although all of it is covered");
  return texels;
}

}  // namespace deltaz
