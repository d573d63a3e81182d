// XXH3, the one hash of the formats: 64 bits for blocks, 128 bits for identities.
// Deterministic on every machine; not cryptographic (it finds damage, not malice).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace deltaz {

// 128 bits in the canonical (big-endian) byte order of XXH3, so that the hexadecimal form reads the same
// everywhere.
struct Hash128 {
  std::array<std::byte, 16> bytes{};
  bool operator==(const Hash128&) const = default;
};

std::uint64_t hash64(std::span<const std::byte> bytes);
Hash128 hash128(std::span<const std::byte> bytes);

// 32 lower-case hexadecimal digits, and back; nothing unless exactly that form.
std::string toHex(const Hash128& hash);
std::optional<Hash128> hashFromHex(std::string_view text);

// Hash128 of bytes that arrive in pieces.
class StreamingHash {
 public:
  StreamingHash();
  ~StreamingHash();
  StreamingHash(StreamingHash&&) noexcept;
  StreamingHash& operator=(StreamingHash&&) noexcept;
  void update(std::span<const std::byte> bytes);
  Hash128 digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltaz
