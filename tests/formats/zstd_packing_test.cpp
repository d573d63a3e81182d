#include "formats/zstd_packing.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/byte_changes.h"

namespace deltaz {
namespace {

BlockBytes sampleBytes(std::size_t size) {
  BlockBytes raw(size);
  for (std::size_t k = 0; k < size; ++k) raw[k] = static_cast<std::byte>(k * k % 251);
  return raw;
}

RC_GTEST_PROP(ZstdPacking, bytes_read_back_exactly, ()) {
  const auto values = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
  BlockBytes raw;
  for (const std::uint8_t value : values) raw.push_back(std::byte{value});
  BlockBytes back(raw.size());
  RC_ASSERT(unpackBytes(packBytes(raw), back));
  RC_ASSERT(back == raw);
}

TEST(ZstdPacking, another_length_is_refused) {
  const BlockBytes packed = packBytes(sampleBytes(1000));
  for (const std::size_t size : {0u, 1u, 999u, 1001u, 100000u}) {
    BlockBytes raw(size);
    EXPECT_FALSE(unpackBytes(packed, raw)) << size;
  }
}

TEST(ZstdPacking, every_cut_is_refused) {
  const BlockBytes packed = packBytes(sampleBytes(1000));
  expectCutsRefused(packed, [](std::span<const std::byte> bytes) -> std::optional<BlockBytes> {
    BlockBytes raw(1000);
    return unpackBytes(bytes, raw) ? std::optional(raw) : std::nullopt;
  });
}

// A decompressor takes frames one after the other, empty and skippable ones too; a block has one.
TEST(ZstdPacking, several_frames_are_refused) {
  const BlockBytes first = packBytes(sampleBytes(600)), empty = packBytes({});
  BlockBytes raw(600);
  ASSERT_TRUE(unpackBytes(first, raw));
  BlockBytes behind = first, before = empty;
  behind.insert(behind.end(), empty.begin(), empty.end());
  before.insert(before.end(), first.begin(), first.end());
  EXPECT_FALSE(unpackBytes(behind, raw));
  EXPECT_FALSE(unpackBytes(before, raw));
  BlockBytes skippable = first;
  for (const int value : {0x50, 0x2A, 0x4D, 0x18, 1, 0, 0, 0, 7})
    skippable.push_back(static_cast<std::byte>(value));
  EXPECT_FALSE(unpackBytes(skippable, raw));
  BlockBytes twice = first;
  twice.insert(twice.end(), first.begin(), first.end());
  BlockBytes both(1200);
  EXPECT_FALSE(unpackBytes(twice, both));
}

}  // namespace
}  // namespace deltaz
