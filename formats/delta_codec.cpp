#include "formats/delta_codec.h"

#include <algorithm>
#include <cassert>

#include "formats/bytes.h"
#include "formats/zstd_packing.h"

namespace deltaz {

namespace {

std::uint32_t zigzag(std::int32_t value) {
  return (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
}

std::int32_t unzigzag(std::uint32_t value) {
  return static_cast<std::int32_t>((value >> 1) ^ (~(value & 1) + 1));
}

// Additions modulo 2^32, defined for every input.
std::int32_t wrappingAdd(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
std::int32_t wrappingSubtract(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

// How many byte planes the largest zigzag value needs, 1 to 4.
unsigned planesFor(std::uint32_t largest) {
  unsigned planes = 1;
  while (planes < 4 && (largest >> (8 * planes)) != 0) ++planes;
  return planes;
}

std::size_t maskBytes(std::size_t posts) {
  return (posts + 7) / 8;
}

// What follows the planes: nothing, the void mask, or the mask and the kinds of voids.
enum VoidParts : std::uint8_t { kNoVoids = 0, kMask = 1, kMaskAndKinds = 2 };

std::size_t voidBytes(std::uint8_t parts, std::size_t posts) {
  return (parts >= kMask ? maskBytes(posts) : 0) + (parts == kMaskAndKinds ? posts : 0);
}

bool hasKinds(const HeightArray& array) {
  for (std::size_t k = 0; k < array.void_kinds.size(); ++k) {
    if (array.valid[k] == 0 && array.void_kinds[k] != 0) return true;
  }
  return false;
}

}  // namespace

std::vector<std::int32_t> differencesOf(std::span<const std::int32_t> heights, std::uint32_t columns,
                                        std::uint32_t rows) {
  assert(columns >= 1 && rows >= 1 && heights.size() == static_cast<std::size_t>(columns) * rows);
  std::vector<std::int32_t> differences(heights.size());
  for (std::size_t j = 0; j < rows; ++j) {
    const std::size_t row = j * columns;
    differences[row] = j == 0 ? heights[0] : wrappingSubtract(heights[row], heights[row - columns]);
    for (std::size_t i = 1; i < columns; ++i)
      differences[row + i] = wrappingSubtract(heights[row + i], heights[row + i - 1]);
  }
  return differences;
}

std::vector<std::int32_t> sumsOf(std::span<const std::int32_t> differences, std::uint32_t columns,
                                 std::uint32_t rows) {
  assert(columns >= 1 && rows >= 1 && differences.size() == static_cast<std::size_t>(columns) * rows);
  std::vector<std::int32_t> heights(differences.size());
  for (std::size_t j = 0; j < rows; ++j) {
    const std::size_t row = j * columns;
    heights[row] = j == 0 ? differences[0] : wrappingAdd(heights[row - columns], differences[row]);
    for (std::size_t i = 1; i < columns; ++i)
      heights[row + i] = wrappingAdd(heights[row + i - 1], differences[row + i]);
  }
  return heights;
}

void fillVoids(HeightArray& array) {
  const auto first_valid = std::find(array.valid.begin(), array.valid.end(), std::uint8_t{1});
  const std::int32_t start = first_valid == array.valid.end()
                                 ? 0
                                 : array.heights[static_cast<std::size_t>(first_valid - array.valid.begin())];
  for (std::size_t k = 0; k < array.heights.size(); ++k) {
    if (array.valid[k] != 0) continue;
    if (k == 0) {
      array.heights[k] = start;
    } else {
      array.heights[k] = k % array.columns == 0 ? array.heights[k - array.columns] : array.heights[k - 1];
    }
  }
}

std::vector<std::byte> packHeights(const HeightArray& array, [[maybe_unused]] DeltaPacking packing) {
  assert(packing == DeltaPacking::kPlanes);
  const std::size_t posts = array.heights.size();
  const std::vector<std::int32_t> differences = differencesOf(array.heights, array.columns, array.rows);
  // Post (0,0) is absolute and would widen every plane of an area at altitude: it stands by itself.
  std::uint32_t largest = 0;
  for (std::size_t k = 1; k < posts; ++k) largest = std::max(largest, zigzag(differences[k]));
  const unsigned planes = planesFor(largest);
  const bool has_voids =
      std::find(array.valid.begin(), array.valid.end(), std::uint8_t{0}) != array.valid.end();

  const std::uint8_t parts = !has_voids ? kNoVoids : hasKinds(array) ? kMaskAndKinds : kMask;

  std::vector<std::byte> raw((posts - 1) * planes + voidBytes(parts, posts));
  for (std::size_t k = 1; k < posts; ++k) {
    const std::uint32_t value = zigzag(differences[k]);
    for (unsigned plane = 0; plane < planes; ++plane) {
      raw[(posts - 1) * plane + k - 1] = static_cast<std::byte>((value >> (8 * plane)) & 0xFF);
    }
  }
  if (has_voids) {
    for (std::size_t k = 0; k < posts; ++k) {
      if (array.valid[k] != 0) raw[(posts - 1) * planes + k / 8] |= static_cast<std::byte>(1u << (k % 8));
    }
  }
  if (parts == kMaskAndKinds) {
    const std::size_t kinds = (posts - 1) * planes + maskBytes(posts);
    for (std::size_t k = 0; k < posts; ++k) {
      // What a valid post's kind is means nothing, and is nothing in the file.
      if (array.valid[k] == 0) raw[kinds + k] = static_cast<std::byte>(array.void_kinds[k]);
    }
  }

  ByteWriter writer;
  writer.put(static_cast<std::uint8_t>(planes));
  writer.put(parts);
  writer.put(std::uint16_t{0});
  writer.put(differences[0]);
  writer.putBytes(packBytes(raw));
  return writer.take();
}

Result<HeightArray> unpackHeights(std::span<const std::byte> bytes, DeltaPacking packing,
                                  std::uint32_t columns, std::uint32_t rows, const std::string& where) {
  const auto damaged = [&](const char* why) {
    return invalidError(IssueCode::kHgtDecode, where, "the delta-z array cannot be unpacked", why);
  };
  if (packing != DeltaPacking::kPlanes) {
    return newerFormatError(IssueCode::kHdrFeatureUnknown, where,
                            "the delta-z array is packed in a way this program does not know",
                            "Use a newer deltaz");
  }
  if (bytes.size() < 8) return damaged("it is too short");
  ByteReader reader(bytes);
  const auto planes = reader.get<std::uint8_t>();
  const auto parts = reader.get<std::uint8_t>();
  const auto reserved = reader.get<std::uint16_t>();
  const auto first = reader.get<std::int32_t>();
  if (planes < 1 || planes > 4 || parts > kMaskAndKinds || reserved != 0)
    return damaged("its header has a wrong value");

  const std::size_t posts = static_cast<std::size_t>(columns) * rows;
  const std::size_t raw_size = (posts - 1) * planes + voidBytes(parts, posts);
  std::vector<std::byte> raw(raw_size);
  if (!unpackBytes(reader.rest(), raw)) return damaged("its compressed bytes are not what zstd wrote");

  std::vector<std::int32_t> differences(posts);
  differences[0] = first;
  for (std::size_t k = 1; k < posts; ++k) {
    std::uint32_t value = 0;
    for (unsigned plane = 0; plane < planes; ++plane) {
      value |= std::to_integer<std::uint32_t>(raw[(posts - 1) * plane + k - 1]) << (8 * plane);
    }
    differences[k] = unzigzag(value);
  }
  HeightArray array;
  array.columns = columns;
  array.rows = rows;
  array.heights = sumsOf(differences, columns, rows);
  array.valid.assign(posts, 1);
  if (parts >= kMask) {
    const std::span<const std::byte> mask =
        std::span<const std::byte>(raw).subspan((posts - 1) * planes, maskBytes(posts));
    for (std::size_t k = 0; k < posts; ++k) {
      array.valid[k] = static_cast<std::uint8_t>((std::to_integer<unsigned>(mask[k / 8]) >> (k % 8)) & 1u);
    }
    // The bits after the last post are zero: nothing in a file is without meaning.
    for (std::size_t k = posts; k < mask.size() * 8; ++k) {
      if (((std::to_integer<unsigned>(mask[k / 8]) >> (k % 8)) & 1u) != 0)
        return damaged("its void mask is too long");
    }
  }
  if (parts == kMaskAndKinds) {
    const std::span<const std::byte> kinds =
        std::span<const std::byte>(raw).subspan((posts - 1) * planes + maskBytes(posts));
    array.void_kinds.resize(posts);
    for (std::size_t k = 0; k < posts; ++k) {
      array.void_kinds[k] = std::to_integer<std::uint8_t>(kinds[k]);
      if (array.valid[k] != 0 && array.void_kinds[k] != 0) return damaged("a valid post has a kind of void");
    }
    // One array, one spelling: without kinds they are left out.
    if (!hasKinds(array)) return damaged("it has kinds of voids, and all are the first");
  }
  return array;
}

}  // namespace deltaz
