#include "librender/ars/antialiaser/shift_add_filter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

namespace deltaz::ars {

namespace {

constexpr std::array k121 = {1, 2, 1};
constexpr std::array k1331 = {1, 3, 3, 1};
constexpr std::array k14641 = {1, 4, 6, 4, 1};
constexpr std::array kOnes = {1, 1, 1, 1, 1, 1, 1, 1};
constexpr std::array kPyramid8 = {1, 3, 5, 7, 7, 5, 3, 1};
constexpr std::array kPyramid16 = {1, 3, 5, 7, 9, 11, 13, 15, 15, 13, 11, 9, 7, 5, 3, 1};
// Rows of Pascal's triangle.
constexpr std::array kBinomial8 = {1, 7, 21, 35, 35, 21, 7, 1};
constexpr std::array kBinomial16 = {1,    15,   105,  455,  1365, 3003, 5005, 6435,
                                    6435, 5005, 3003, 1365, 455,  105,  15,   1};

constexpr std::span<const int> kAllOnes(kOnes);
constexpr std::array<ShiftAddKernel, 10> kKernels = {{{"report", 2, k121, 2},
                                                      {"box-2", 2, kAllOnes.first(2), 1},
                                                      {"pyramid-2", 2, k1331, 3},
                                                      {"binomial-2", 2, k14641, 4},
                                                      {"box-4", 4, kAllOnes.first(4), 2},
                                                      {"pyramid-4", 4, kPyramid8, 5},
                                                      {"binomial-4", 4, kBinomial8, 7},
                                                      {"box-8", 8, kAllOnes, 3},
                                                      {"pyramid-8", 8, kPyramid16, 7},
                                                      {"binomial-8", 8, kBinomial16, 15}}};

// One level: `count` pixels of samples that lie `step` apart, each `lanes` values wide.
struct Level {
  const ShiftAddKernel& kernel;
  int shift;
  std::uint32_t half;  // added before the shift

  std::uint32_t at(const std::uint32_t* line, int size, std::size_t step, int pixel) const {
    const int first = kernel.firstSample(pixel);
    std::uint32_t sum = half;
    for (int tap = 0; tap < kernel.taps(); ++tap) {
      const int sample = std::clamp(first + tap, 0, size - 1);
      sum += static_cast<std::uint32_t>(kernel.weights[static_cast<std::size_t>(tap)]) *
             line[static_cast<std::size_t>(sample) * step];
    }
    return sum >> shift;
  }
};

// `values`: width * height. Along rows, or along columns.
std::vector<std::uint32_t> along(const Level& level, const std::vector<std::uint32_t>& values, int width,
                                 int height, bool columns) {
  const int ratio = level.kernel.ratio;
  const int out_width = columns ? width : width / ratio, out_height = columns ? height / ratio : height;
  std::vector<std::uint32_t> result;
  result.reserve(static_cast<std::size_t>(out_width) * static_cast<std::size_t>(out_height));
  const auto row = static_cast<std::size_t>(width);
  for (int i = 0; i < out_height; ++i) {
    for (int j = 0; j < out_width; ++j) {
      result.push_back(columns ? level.at(values.data() + j, height, row, i)
                               : level.at(values.data() + static_cast<std::size_t>(i) * row, width, 1, j));
    }
  }
  return result;
}

}  // namespace

int ShiftAddKernel::firstSample(int pixel) const {
  const int beside = ratio - taps();  // rounded down when halved
  return ratio * pixel + (beside >= 0 ? beside / 2 : -((1 - beside) / 2));
}

int ShiftAddKernel::adders() const {
  int bits = 0;
  for (const int weight : weights) bits += std::popcount(static_cast<unsigned>(weight));
  return bits - 1;
}

std::span<const ShiftAddKernel> shiftAddKernels() {
  return kKernels;
}

std::optional<ShiftAddKernel> shiftAddKernelNamed(std::string_view name) {
  for (const ShiftAddKernel& kernel : kKernels)
    if (kernel.name == name) return kernel;
  return std::nullopt;
}

std::vector<std::uint8_t> filtered(const ShiftAddKernel& kernel, std::span<const std::uint8_t> samples,
                                   int width, int height, const FilterArithmetic& arithmetic) {
  assert(width % kernel.ratio == 0 && height % kernel.ratio == 0);
  assert(samples.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  // 8 bits of colour, up to 15 of weights and the guard bits fit in 32 at both levels.
  const int guard = std::min(arithmetic.guard_bits, kernel.shift);
  assert(arithmetic.guard_bits >= 0 && arithmetic.guard_bits <= 8);
  const auto level = [&](int shift) {
    const std::uint32_t half = arithmetic.rounding && shift > 0 ? std::uint32_t{1} << (shift - 1) : 0;
    return Level{kernel, shift, half};
  };
  const Level first = level(kernel.shift - guard), second = level(kernel.shift + guard);
  const std::vector<std::uint32_t> values(samples.begin(), samples.end());
  const bool down = arithmetic.down_first;
  const std::vector<std::uint32_t> half = along(first, values, width, height, down);
  const std::vector<std::uint32_t> all =
      along(second, half, down ? width : width / kernel.ratio, down ? height / kernel.ratio : height, !down);
  std::vector<std::uint8_t> picture;
  picture.reserve(all.size());
  for (const std::uint32_t value : all) picture.push_back(static_cast<std::uint8_t>(std::min(value, 255U)));
  return picture;
}

std::int64_t latency(const ShiftAddKernel& kernel, int width) {
  const std::int64_t last = kernel.firstSample(0) + kernel.taps() - 1;
  return last * width + last + 1;
}

}  // namespace deltaz::ars
