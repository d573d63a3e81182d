// Memory for arrays that are written a cache line at a time: begins with one.
#pragma once

#include <cstddef>
#include <new>

namespace deltaz {

inline constexpr std::size_t kCacheLine = 64;  // bytes

template <typename T>
struct LineAllocator {
  using value_type = T;

  LineAllocator() = default;
  template <typename Other>
  LineAllocator(const LineAllocator<Other>&) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new (count * sizeof(T), std::align_val_t{kCacheLine}));
  }
  void deallocate(T* memory, std::size_t) noexcept {
    ::operator delete (memory, std::align_val_t{kCacheLine});
  }
  bool operator==(const LineAllocator&) const = default;
};

}  // namespace deltaz
