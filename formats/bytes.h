// Little-endian loads and stores: the only way bytes of a file become numbers and back.
// Bounds are the caller's duty: a reader checks the size of its span once, then walks it with a ByteReader.
#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace deltaz {

namespace bytes_detail {
template <std::size_t size>
struct UnsignedOfSize;
template <>
struct UnsignedOfSize<1> {
  using Type = std::uint8_t;
};
template <>
struct UnsignedOfSize<2> {
  using Type = std::uint16_t;
};
template <>
struct UnsignedOfSize<4> {
  using Type = std::uint32_t;
};
template <>
struct UnsignedOfSize<8> {
  using Type = std::uint64_t;
};
}  // namespace bytes_detail

// The value of type T (integer, float or double) stored at `bytes[offset...]`.
template <typename T>
T loadLittleEndian(std::span<const std::byte> bytes, std::size_t offset) {
  using Unsigned = typename bytes_detail::UnsignedOfSize<sizeof(T)>::Type;
  assert(offset + sizeof(T) <= bytes.size());
  Unsigned bits = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bits = static_cast<Unsigned>(
        bits | (static_cast<Unsigned>(std::to_integer<std::uint8_t>(bytes[offset + i])) << (8 * i)));
  }
  return std::bit_cast<T>(bits);
}

// Appends values to a growing buffer.
class ByteWriter {
 public:
  template <typename T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    using Unsigned = typename bytes_detail::UnsignedOfSize<sizeof(T)>::Type;
    const auto bits = std::bit_cast<Unsigned>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_.push_back(static_cast<std::byte>((bits >> (8 * i)) & 0xFF));
  }
  void putBytes(std::span<const std::byte> more) { bytes_.insert(bytes_.end(), more.begin(), more.end()); }
  void putZeros(std::size_t count) { bytes_.insert(bytes_.end(), count, std::byte{0}); }
  std::size_t size() const { return bytes_.size(); }
  std::span<const std::byte> view() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

// Walks a span from the front. The caller has checked that enough bytes are there (remaining()).
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  template <typename T>
  T get() {
    const T value = loadLittleEndian<T>(bytes_, position_);
    position_ += sizeof(T);
    return value;
  }
  void skip(std::size_t count) { position_ += count; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  std::span<const std::byte> rest() const { return bytes_.subspan(position_); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t position_ = 0;
};

}  // namespace deltaz
