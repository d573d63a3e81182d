// Damage to a few bytes that every decoder must bear: cut, lengthened, one byte changed.
#pragma once

#include <cstddef>
#include <functional>
#include <gtest/gtest.h>
#include <optional>
#include <span>
#include <vector>

namespace deltaz {

using BlockBytes = std::vector<std::byte>;
// Decodes and encodes again; nothing if the bytes are refused.
using Recoding = std::function<std::optional<BlockBytes>(std::span<const std::byte>)>;

inline void expectCutsRefused(const BlockBytes& bytes, const Recoding& recode) {
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // An exactly sized copy, so that a sanitizer sees the first byte read past the end.
    const BlockBytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_FALSE(recode(cut).has_value()) << "cut to " << length;
  }
  BlockBytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(recode(longer).has_value()) << "a byte more";
}

// Every value of every byte is refused, or read as what is written in those bytes and no others. Returns how
// many were refused.
inline std::size_t expectOneForm(const BlockBytes& bytes, const Recoding& recode) {
  std::size_t refused = 0;
  for (std::size_t place = 0; place < bytes.size(); ++place) {
    for (unsigned change = 1; change < 256; ++change) {
      BlockBytes changed = bytes;
      changed[place] ^= static_cast<std::byte>(change);
      const std::optional<BlockBytes> again = recode(changed);
      refused += again ? 0 : 1;
      if (!again || *again == changed) continue;
      ADD_FAILURE() << "byte " << place << " changed by " << change << " has another form";
      return refused;
    }
  }
  return refused;
}

}  // namespace deltaz
