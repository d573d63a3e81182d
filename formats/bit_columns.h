// Columns of integers in few bits: of each its least value, and every value's difference from that in as many
// bits as the largest needs. Small tables of like records pack this way to less than through zstd, which has
// nothing to learn from so few bytes. Specified in node_file.md, section 5.
//
// Guarantees: a table has one form, and only that is taken back; counts are checked before anything is
// allocated. Cost: linear. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace deltaz {

inline constexpr std::size_t kMostBitColumns = 32;
inline constexpr std::size_t kMostBitRows = 255;
// Values lie within this of 0.
inline constexpr std::int64_t kMostBitValue = std::int64_t{1} << 40;

// Rows of one column are together: value `row` of column `column` is values[column * rows + row]. 1 to
// kMostBitRows rows, up to kMostBitColumns columns.
struct BitColumns {
  std::size_t rows = 0;
  std::vector<std::int64_t> values;
  bool operator==(const BitColumns&) const = default;
};

std::vector<std::byte> packColumns(const BitColumns& columns);

// None unless `bytes` are what packColumns writes of `column_count` columns of at most `most_rows` rows.
std::optional<BitColumns> unpackColumns(std::span<const std::byte> bytes, std::size_t column_count,
                                        std::size_t most_rows);

}  // namespace deltaz
