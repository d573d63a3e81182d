#include "formats/terrain_segment.h"

#include <cassert>

#include "formats/bytes.h"
#include "formats/delta_codec.h"

namespace deltaz {

namespace {

constexpr std::size_t kAncestorBytes = 16;
constexpr std::size_t kMaximumAncestors = 64;

}  // namespace

std::vector<std::byte> encodeTerrainBlock(const TerrainBlock& block) {
  assert(block.ancestors.size() <= kMaximumAncestors);
  HeightArray array;
  array.columns = block.columns + 2u;
  array.rows = block.rows + 2u;
  array.heights = block.heights;
  array.valid = block.valid;
  array.void_kinds = block.void_kinds;
  assert(array.heights.size() == static_cast<std::size_t>(array.columns) * array.rows);
  fillVoids(array);
  const std::vector<std::byte> packed = packHeights(array, DeltaPacking::kPlanes);

  ByteWriter writer;
  writer.put(static_cast<std::uint8_t>(DeltaPacking::kPlanes));
  writer.put(static_cast<std::uint8_t>(block.predicted_from));
  writer.put(block.normal_exponent);
  writer.put(static_cast<std::uint8_t>(block.ancestors.size()));
  writer.put(block.columns);
  writer.put(block.rows);
  writer.put(block.first_column);
  writer.put(block.first_row);
  writer.put(static_cast<std::uint32_t>(packed.size()));
  writer.put(block.spacing_x);
  writer.put(block.spacing_y);
  writer.put(block.quantum.numerator);
  writer.put(block.quantum.denominator);
  writer.putZeros(kTerrainHeaderBytes - writer.size());
  writer.putBytes(packed);
  for (const AncestorError& ancestor : block.ancestors) {
    writer.put(ancestor.maximum);
    writer.put(ancestor.posts);
    writer.put(ancestor.sum_of_squares);
  }
  return writer.take();
}

Result<TerrainBlock> decodeTerrainBlock(std::span<const std::byte> bytes, std::uint32_t leaf_cells,
                                        const std::string& where) {
  const auto damaged = [&](const char* why) {
    return invalidError(IssueCode::kHgtDecode, where, "the terrain block cannot be decoded", why);
  };
  if (bytes.size() < kTerrainHeaderBytes) return damaged("it is shorter than its header");
  ByteReader reader(bytes);
  const auto packing = static_cast<DeltaPacking>(reader.get<std::uint8_t>());
  const auto prediction = reader.get<std::uint8_t>();
  TerrainBlock block;
  block.normal_exponent = reader.get<std::uint8_t>();
  const auto ancestor_count = reader.get<std::uint8_t>();
  block.columns = reader.get<std::uint16_t>();
  block.rows = reader.get<std::uint16_t>();
  block.first_column = reader.get<std::uint16_t>();
  block.first_row = reader.get<std::uint16_t>();
  const auto packed_length = reader.get<std::uint32_t>();
  block.spacing_x = reader.get<double>();
  block.spacing_y = reader.get<double>();
  block.quantum.numerator = reader.get<std::int64_t>();
  block.quantum.denominator = reader.get<std::int64_t>();
  for (std::size_t i = reader.position(); i < kTerrainHeaderBytes; ++i) {
    if (reader.get<std::uint8_t>() != 0) return damaged("a reserved byte is not zero");
  }
  const std::uint32_t most_posts = leaf_cells + 1;
  if (prediction > static_cast<std::uint8_t>(Prediction::kParent))
    return damaged("its prediction is unknown");
  if (prediction == static_cast<std::uint8_t>(Prediction::kParent)) {
    return newerFormatError(IssueCode::kHdrFeatureUnknown, where, "the terrain is predicted from its parent",
                            "Use a newer deltaz");
  }
  if (block.columns > most_posts || block.rows > most_posts ||
      block.first_column + std::uint32_t{block.columns} > most_posts ||
      block.first_row + std::uint32_t{block.rows} > most_posts) {
    return damaged("it has more posts than a node can have");
  }
  if (!(block.spacing_x > 0) || !(block.spacing_y > 0) || block.quantum.numerator <= 0 ||
      block.quantum.denominator <= 0 || ancestor_count > kMaximumAncestors) {
    return damaged("its header has a wrong value");
  }
  if (reader.remaining() < packed_length ||
      reader.remaining() - packed_length != ancestor_count * kAncestorBytes) {
    return damaged("its parts do not add up to its length");
  }
  DELTAZ_TRY_ASSIGN(HeightArray array, unpackHeights(reader.rest().first(packed_length), packing,
                                                     block.columns + 2u, block.rows + 2u, where));
  reader.skip(packed_length);
  for (const std::int32_t height : array.heights) {
    if (height > kMaximumHeightQuanta || height < -kMaximumHeightQuanta)
      return damaged("a height is out of range");
  }
  block.heights = std::move(array.heights);
  block.valid = std::move(array.valid);
  block.void_kinds = std::move(array.void_kinds);
  for (unsigned i = 0; i < ancestor_count; ++i) {
    AncestorError ancestor;
    ancestor.maximum = reader.get<std::uint32_t>();
    ancestor.posts = reader.get<std::uint32_t>();
    ancestor.sum_of_squares = reader.get<std::uint64_t>();
    block.ancestors.push_back(ancestor);
  }
  return block;
}

}  // namespace deltaz
