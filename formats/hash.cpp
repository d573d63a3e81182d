#include "formats/hash.h"

#include <cstring>
#include <xxhash.h>

namespace deltaz {

namespace {

Hash128 fromNative(XXH128_hash_t native) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, native);
  Hash128 hash;
  std::memcpy(hash.bytes.data(), canonical.digest, hash.bytes.size());
  return hash;
}

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

std::uint64_t hash64(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

Hash128 hash128(std::span<const std::byte> bytes) {
  return fromNative(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string toHex(const Hash128& hash) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::byte b : hash.bytes) {
    text += kDigits[std::to_integer<unsigned>(b) >> 4];
    text += kDigits[std::to_integer<unsigned>(b) & 15];
  }
  return text;
}

std::optional<Hash128> hashFromHex(std::string_view text) {
  Hash128 hash;
  if (text.size() != 2 * hash.bytes.size()) return std::nullopt;
  for (std::size_t i = 0; i < hash.bytes.size(); ++i) {
    const int high = hexDigit(text[2 * i]);
    const int low = hexDigit(text[2 * i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    hash.bytes[i] = static_cast<std::byte>(high * 16 + low);
  }
  return hash;
}

struct StreamingHash::State {
  XXH3_state_t* native = XXH3_createState();
  State() { XXH3_128bits_reset(native); }
  ~State() { XXH3_freeState(native); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

StreamingHash::StreamingHash() : state_(std::make_unique<State>()) {}
StreamingHash::~StreamingHash() = default;
StreamingHash::StreamingHash(StreamingHash&&) noexcept = default;
StreamingHash& StreamingHash::operator=(StreamingHash&&) noexcept = default;

void StreamingHash::update(std::span<const std::byte> bytes) {
  XXH3_128bits_update(state_->native, bytes.data(), bytes.size());
}

Hash128 StreamingHash::digest() const {
  return fromNative(XXH3_128bits_digest(state_->native));
}

}  // namespace deltaz
