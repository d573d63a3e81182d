#include "formats/bit_columns.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace deltaz {
namespace {

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

BitColumns arbitraryColumns(std::size_t most_rows, std::size_t most_columns) {
  BitColumns columns;
  columns.rows = *rc::gen::inRange<std::size_t>(1, most_rows + 1);
  const auto count = *rc::gen::inRange<std::size_t>(1, most_columns + 1);
  for (std::size_t column = 0; column < count; ++column) {
    const auto limit = *rc::gen::element<std::int64_t>(0, 1, 300, std::int64_t{1} << 32, kMostBitValue);
    const auto base = *rc::gen::inRange<std::int64_t>(-limit, limit + 1);
    for (std::size_t row = 0; row < columns.rows; ++row) {
      const auto value = base + *rc::gen::inRange<std::int64_t>(-limit, limit + 1);
      columns.values.push_back(std::clamp(value, -kMostBitValue, kMostBitValue));
    }
  }
  return columns;
}

RC_GTEST_PROP(BitColumns, values_read_back_exactly, ()) {
  const BitColumns columns = arbitraryColumns(kMostBitRows, kMostBitColumns);
  const std::size_t count = columns.values.size() / columns.rows;
  const std::optional<BitColumns> back = unpackColumns(packColumns(columns), count, kMostBitRows);
  RC_ASSERT(back.has_value());
  RC_ASSERT(*back == columns);
}

TEST(BitColumns, the_ends_of_the_range_read_back) {
  const BitColumns columns{2, {-kMostBitValue, kMostBitValue, kMostBitValue, kMostBitValue, 0, -1}};
  const std::optional<BitColumns> back = unpackColumns(packColumns(columns), 3, 2);
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(*back, columns);
}

// Worked out by hand: three rows; a column of zeros, one of 5s, one of -2, 1 and 0.
TEST(BitColumns, bytes_are_those_of_the_specification) {
  const BitColumns columns{3, {0, 0, 0, 5, 5, 5, -2, 1, 0}};
  // Rows, mask; 5 folded is 10, width 0; -2 folded is 3, width 2; differences 0, 3, 2 from the low bit on.
  EXPECT_EQ(packColumns(columns), bytesOf({3, 0b110, 0, 0, 0, 10, 0, 3, 2, 0b101100}));
}

TEST(BitColumns, a_base_of_several_bytes_has_its_low_bits_first) {
  const BitColumns columns{1, {150}};
  EXPECT_EQ(packColumns(columns), bytesOf({1, 1, 0, 0, 0, 0x80 | (300 & 0x7F), 300 >> 7, 0}));
}

TEST(BitColumns, other_bytes_for_the_same_values_are_refused) {
  const auto taken = [](std::initializer_list<int> values) {
    return unpackColumns(bytesOf(values), 2, 16).has_value();
  };
  EXPECT_TRUE(taken({2, 1, 0, 0, 0, 4, 1, 0b10}));
  EXPECT_FALSE(taken({2, 1, 0, 0, 0, 4, 2, 0b0100})) << "wider than needed";
  EXPECT_FALSE(taken({2, 1, 0, 0, 0, 4, 1, 0b11})) << "no value is the least";
  EXPECT_FALSE(taken({2, 1, 0, 0, 0, 4, 1, 0b110})) << "a bit behind the last value";
  EXPECT_FALSE(taken({2, 1, 0, 0, 0, 0x84, 0, 1, 0b10})) << "a base longer than needed";
  EXPECT_FALSE(taken({2, 3, 0, 0, 0, 4, 1, 0, 0, 0b10})) << "a stored column of zeros";
}

TEST(BitColumns, bytes_that_are_no_table_are_refused) {
  const std::vector<std::byte> good = packColumns({2, {2, 3, -7, 9}});
  ASSERT_TRUE(unpackColumns(good, 2, 2).has_value());
  EXPECT_FALSE(unpackColumns(good, 1, 2).has_value()) << "a column too many";
  EXPECT_FALSE(unpackColumns(good, 2, 1).has_value()) << "a row too many";
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(unpackColumns(std::span(good).first(length), 2, 2).has_value()) << length;
  std::vector<std::byte> longer = good;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(unpackColumns(longer, 2, 2).has_value());
  EXPECT_FALSE(unpackColumns(bytesOf({0, 0, 0, 0, 0}), 2, 2).has_value()) << "no rows";
  EXPECT_FALSE(unpackColumns(bytesOf({1, 1, 0, 0, 0, 4, 255, 0, 0, 0, 0}), 2, 2).has_value()) << "width";
  EXPECT_FALSE(
      unpackColumns(bytesOf({1, 1, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 0}), 2, 2).has_value())
      << "a base without end";
}

// Whatever is taken is what would have been written.
RC_GTEST_PROP(BitColumns, a_table_has_one_form, ()) {
  std::vector<std::byte> bytes = packColumns(arbitraryColumns(6, 4));
  const auto place = *rc::gen::inRange<std::size_t>(0, bytes.size());
  bytes[place] = static_cast<std::byte>(*rc::gen::inRange(0, 256));
  const std::optional<BitColumns> columns = unpackColumns(bytes, 4, 6);
  if (columns) RC_ASSERT(packColumns(*columns) == bytes);
}

}  // namespace
}  // namespace deltaz
