#include "tests/librender/ars/machine/random_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace deltaz::ars {

namespace {

struct Corner {
  double i = 0, j = 0;
};

constexpr Picoseconds kOversampleSetUp = 8630 * kNanosecond;

// From the corner of the box at a vertex, line by line, following the leading edge; a line ends at the box's
// edge or behind its last valid pixel.
template <typename Depth>
void tile(std::array<Corner, 3> corners, std::uint8_t color, const Depth& depth, SampledTriangle& result) {
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.i < b.i; });
  const auto& [a, b, c] = corners;
  std::array<double, 3> n_i = {c.j - a.j, a.j - b.j, b.j - c.j};
  std::array<double, 3> n_j = {a.i - c.i, b.i - a.i, c.i - b.i};
  if (n_j[0] * n_i[2] - n_i[0] * n_j[2] < 0) {
    for (double& n : n_i) n = -n;
    for (double& n : n_j) n = -n;
  }
  const auto [least, most] = std::minmax({a.j, b.j, c.j});
  const auto pixel = [](double place) { return static_cast<int>(std::floor(place + 0.5)); };
  const bool from_bottom = c.j == least || c.j == most, top_ok = a.j == least || a.j == most;
  const bool bottom = from_bottom && !top_ok;
  const Corner& start = bottom ? c : a;
  const bool right = start.j == most;
  int i = pixel(bottom ? c.i : a.i), j = pixel(right ? most : least);
  const int stop_i = pixel(bottom ? a.i : c.i), stop_j = pixel(right ? least : most);
  const int di = bottom ? -1 : 1, dj = right ? -1 : 1;
  const auto valid = [&] {
    for (std::size_t k = 0; k < 3; ++k) {
      const double p = (i - corners[k].i) * n_i[k] + (j - corners[k].j) * n_j[k];
      if (p + 0.5 * std::max(std::abs(n_i[k]), std::abs(n_j[k])) < 0) return false;
    }
    return true;
  };
  std::int32_t samples = 0;
  for (int line_start = j;; i += di) {
    bool any = false;
    for (j = line_start;; j += dj) {
      ++samples;
      const bool in = valid();
      if (in) {
        if (!any) line_start = j;
        PixelPacket packet;
        packet.i = static_cast<std::uint16_t>(i);
        packet.j = static_cast<std::uint16_t>(j);
        packet.color = color;
        packet.depth = depth(i, j);
        result.pixels.push_back({.samples = samples, .packet = packet});
        samples = 0;
      }
      if (j == stop_j || (any && !in)) break;
      any = in;
    }
    if (i == stop_i) break;
  }
  result.samples_after = samples;
}

}  // namespace

RecordedPixels randomPixels(const RandomPixelOptions& options) {
  std::mt19937_64 random(options.seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const auto gaussian = [&uniform] {
    return std::sqrt(-2 * std::log(1 - uniform())) * std::cos(2 * 3.14159265358979323846 * uniform());
  };
  RecordedPixels source;
  const double most = 511.0 - options.side;
  // Shuffled, so that they come in no order of depth, and no two are alike.
  std::vector<std::uint32_t> depths;
  for (int k = 0; k < options.triangles; ++k) {
    const double octave = 3.0 * k / options.triangles;
    const double mantissa = std::exp2(octave - std::floor(octave)) - 1;
    depths.push_back(static_cast<std::uint32_t>(20 + std::floor(octave)) << 19 |
                     static_cast<std::uint32_t>(mantissa * 0x1p19));
  }
  std::shuffle(depths.begin(), depths.end(), random);
  while (static_cast<int>(source.list.size()) < options.triangles) {
    std::array<Corner, 3> corners;
    for (Corner& corner : corners) corner = {uniform() * options.side, uniform() * options.side};
    const auto& [a, b, c] = corners;
    const double area = 0.5 * std::abs((b.i - a.i) * (c.j - a.j) - (b.j - a.j) * (c.i - a.i));
    if (area > options.most_area * options.side * options.side) continue;
    const double line = options.line_sigma > 0 ? 255.5 - options.side / 2 + options.line_sigma * gaussian()
                                               : uniform() * most;
    const double left = uniform() * most;
    if (line < 0 || line > most) continue;
    for (Corner& corner : corners) {
      corner.i = std::round((corner.i + line) * 64) / 64;
      corner.j = std::round((corner.j + left) * 64) / 64;
    }
    const std::size_t number = source.list.size();
    RecordedPixels::Triangle triangle;
    triangle.set_up = kOversampleSetUp;
    const std::uint32_t base = depths[number];
    const double slope_i = (uniform() - 0.5) * 4000, slope_j = (uniform() - 0.5) * 4000;
    const Corner anchor = corners[0];
    const auto depth = [&](int i, int j) {
      if (!options.planes) return base;
      const double value = base + slope_i * (i - anchor.i) + slope_j * (j - anchor.j);
      return static_cast<std::uint32_t>(std::clamp(value, 0.0, double{0xFFFFFF})) & ~std::uint32_t{0xFFF};
    };
    tile(corners, static_cast<std::uint8_t>(number % 255 + 1), depth, triangle.sampled);
    source.list.push_back(std::move(triangle));
  }
  return source;
}

void addBackground(RecordedPixels& source, std::uint8_t color) {
  for (int i = 0; i < kScreenLines; ++i) {
    RecordedPixels::Triangle line;
    line.set_up = kOversampleSetUp;
    for (int j = 0; j < kScreenPixels; ++j) {
      PixelPacket packet;
      packet.i = static_cast<std::uint16_t>(i);
      packet.j = static_cast<std::uint16_t>(j);
      packet.color = color;
      packet.background = true;
      line.sampled.pixels.push_back({.samples = 1, .packet = packet});
    }
    source.list.push_back(std::move(line));
  }
}

}  // namespace deltaz::ars
