#include "formats/hash.h"

#include <gtest/gtest.h>
#include <string_view>
#include <vector>

namespace deltaz {
namespace {

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// Published values of XXH3 (seed 0) for the empty input.
TEST(Hash, is_xxh3_in_canonical_byte_order) {
  EXPECT_EQ(hash64({}), 0x2D06800538D394C2ull);
  EXPECT_EQ(toHex(hash128({})), "99aa06d3014798d86001c324468d497f");
}

TEST(Hash, pieces_hash_like_the_whole) {
  StreamingHash hash;
  hash.update(bytesOf("Mount "));
  hash.update(bytesOf(""));
  hash.update(bytesOf("Rainier"));
  EXPECT_EQ(hash.digest(), hash128(bytesOf("Mount Rainier")));
}

TEST(Hash, hexadecimal_form_reads_back_and_nothing_else_does) {
  const Hash128 hash = hash128(bytesOf("post"));
  EXPECT_EQ(hashFromHex(toHex(hash)), hash);
  EXPECT_FALSE(hashFromHex("").has_value());
  EXPECT_FALSE(hashFromHex(toHex(hash) + "0").has_value());
  std::string upper = toHex(hash);
  upper[0] = 'A';
  EXPECT_FALSE(hashFromHex(upper).has_value());
}

}  // namespace
}  // namespace deltaz
