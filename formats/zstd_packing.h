// Bytes through zstd, always at one level and without a checksum of its own: blocks have theirs. The same
// input gives the same bytes for one version of zstd; readers take what any version wrote. Thread-safety:
// pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace deltaz {

std::vector<std::byte> packBytes(std::span<const std::byte> raw);

// Fills `raw`. False if `packed` is not what zstd wrote of exactly so many bytes.
bool unpackBytes(std::span<const std::byte> packed, std::span<std::byte> raw);

}  // namespace deltaz
