#include "formats/bit_columns.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr int kMostBaseBytes = 6;  // of 7 bits each: enough for kMostBitValue and its sign
constexpr int kMostWidth = 42;     // bits of a difference

// Signed numbers as unsigned ones that are small if the number is near 0: 0, -1, 1, -2, ...
std::uint64_t folded(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  return value < 0 ? ~(bits << 1) : bits << 1;
}

std::int64_t unfolded(std::uint64_t value) {
  const std::uint64_t half = value >> 1;
  return static_cast<std::int64_t>((value & 1) != 0 ? ~half : half);
}

// Bits one after the other, the lowest of each number and of each byte first.
class BitWriter {
 public:
  explicit BitWriter(ByteWriter& bytes) : bytes_(bytes) {}
  void put(std::uint64_t value, int width) {
    for (int bit = 0; bit < width; ++bit) {
      byte_ |= static_cast<unsigned>((value >> bit) & 1) << used_;
      if (++used_ == 8) flush();
    }
  }
  void flush() {
    if (used_ > 0) bytes_.put(static_cast<std::uint8_t>(byte_));
    byte_ = 0;
    used_ = 0;
  }

 private:
  ByteWriter& bytes_;
  unsigned byte_ = 0;
  int used_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t get(int width) {
    std::uint64_t value = 0;
    for (int bit = 0; bit < width; ++bit, ++position_) {
      const auto byte = std::to_integer<std::uint64_t>(bytes_[position_ / 8]);
      value |= ((byte >> (position_ % 8)) & 1) << bit;
    }
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

struct Frame {
  std::int64_t least = 0;
  int width = 0;
};

std::uint64_t difference(std::int64_t value, std::int64_t least) {
  return static_cast<std::uint64_t>(value - least);
}

void putBase(ByteWriter& writer, std::int64_t least) {
  std::uint64_t rest = folded(least);
  while (rest >= 0x80) {
    writer.put(static_cast<std::uint8_t>(rest | 0x80));
    rest >>= 7;
  }
  writer.put(static_cast<std::uint8_t>(rest));
}

std::optional<std::int64_t> getBase(ByteReader& reader) {
  std::uint64_t value = 0;
  for (int i = 0; i < kMostBaseBytes; ++i) {
    if (reader.remaining() == 0) return std::nullopt;
    const auto byte = reader.get<std::uint8_t>();
    value |= std::uint64_t{byte & 0x7Fu} << (7 * i);
    if ((byte & 0x80) == 0) return unfolded(value);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::byte> packColumns(const BitColumns& columns) {
  const std::size_t rows = columns.rows, count = columns.values.size() / rows;
  assert(rows > 0 && rows <= kMostBitRows && count <= kMostBitColumns &&
         columns.values.size() == rows * count);
  ByteWriter frames, packed;
  BitWriter bits(packed);
  std::uint32_t present = 0;
  for (std::size_t column = 0; column < count; ++column) {
    const std::span<const std::int64_t> values = std::span(columns.values).subspan(column * rows, rows);
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    assert(*least >= -kMostBitValue && *greatest <= kMostBitValue);
    if (*least == 0 && *greatest == 0) continue;
    present |= 1u << column;
    const int width = static_cast<int>(std::bit_width(difference(*greatest, *least)));
    putBase(frames, *least);
    frames.put(static_cast<std::uint8_t>(width));
    for (const std::int64_t value : values) bits.put(difference(value, *least), width);
  }
  bits.flush();
  ByteWriter writer;
  writer.put(static_cast<std::uint8_t>(rows));
  writer.put(present);
  writer.putBytes(frames.view());
  writer.putBytes(packed.view());
  return writer.take();
}

std::optional<BitColumns> unpackColumns(std::span<const std::byte> bytes, std::size_t column_count,
                                        std::size_t most_rows) {
  ByteReader reader(bytes);
  if (reader.remaining() < 5) return std::nullopt;
  BitColumns columns;
  columns.rows = reader.get<std::uint8_t>();
  const auto present = reader.get<std::uint32_t>();
  if (columns.rows == 0 || columns.rows > most_rows) return std::nullopt;
  if (column_count < kMostBitColumns && present >> column_count != 0) return std::nullopt;
  std::vector<Frame> frames(column_count);
  std::uint64_t bits = 0;
  for (std::size_t column = 0; column < column_count; ++column) {
    if ((present >> column & 1) == 0) continue;
    const std::optional<std::int64_t> least = getBase(reader);
    if (!least || reader.remaining() == 0) return std::nullopt;
    frames[column] = {*least, reader.get<std::uint8_t>()};
    if (frames[column].width > kMostWidth) return std::nullopt;
    bits += columns.rows * static_cast<std::uint64_t>(frames[column].width);
  }
  if (reader.remaining() != (bits + 7) / 8) return std::nullopt;
  BitReader packed(reader.rest());
  columns.values.reserve(column_count * columns.rows);
  for (const Frame& frame : frames) {
    for (std::size_t row = 0; row < columns.rows; ++row) {
      const std::int64_t value = frame.least + static_cast<std::int64_t>(packed.get(frame.width));
      if (value < -kMostBitValue || value > kMostBitValue) return std::nullopt;
      columns.values.push_back(value);
    }
  }
  // Wider columns than needed, longer numbers, ones that are 0 throughout: other bytes for the same values.
  const std::vector<std::byte> canonical = packColumns(columns);
  if (!std::equal(bytes.begin(), bytes.end(), canonical.begin(), canonical.end())) return std::nullopt;
  return columns;
}

}  // namespace deltaz
