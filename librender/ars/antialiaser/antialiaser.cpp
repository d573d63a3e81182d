#include "librender/ars/antialiaser/antialiaser.h"

#include <utility>

namespace deltaz::ars {

std::optional<std::uint8_t> Antialiaser::put(std::uint8_t color) {
  const int i = i_, j = j_;
  j_ = (j_ + 1) % kScreenPixels;
  if (j_ == 0) i_ = (i_ + 1) % kScreenLines;
  if (j == 0) last_ = color;  // column 0
  const std::uint8_t a = before_, b = last_;
  before_ = std::exchange(last_, color);
  if (j % 2 == 0) return std::nullopt;

  const std::uint8_t across = combine(a, b, color);
  const auto pixel = static_cast<std::size_t>(j / 2);
  if (i == 0) delay_256_[pixel] = across;  // row 0
  const std::uint8_t above = delay_512_[pixel], middle = delay_256_[pixel];
  delay_512_[pixel] = std::exchange(delay_256_[pixel], across);
  if (i % 2 == 0) return std::nullopt;
  return combine(above, middle, across);
}

}  // namespace deltaz::ars
