// The tiler's pixels without its clocks: what the intelligent tiling algorithm (report 4.2.2.7) finds valid,
// in its order, with the spans of lines computed instead of scanned, and how many pixels the machine would
// have sampled for them.
//
// The same pixels, in the same order, as TilingCursor, for any set-up. Thread-safety: reentrant.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "librender/ars/tiler/pixel_values.h"
#include "librender/ars/tiler/tiler_configuration.h"
#include "librender/ars/tiler/tiler_setup.h"
#include "librender/ars/words/pixel_packet.h"
#include "librender/ars/words/triangle_words.h"

namespace deltaz::ars {

struct TilingCounts {
  std::int64_t triangles = 0;
  std::int64_t sampled = 0;  // valid or not; 100 ns each
  std::int64_t tiled = 0;    // valid
  std::int64_t lines = 0, empty_lines = 0;

  bool operator==(const TilingCounts&) const = default;
  TilingCounts& operator+=(const TilingCounts& other) {
    triangles += other.triangles;
    sampled += other.sampled;
    tiled += other.tiled;
    lines += other.lines;
    empty_lines += other.empty_lines;
    return *this;
  }
};

// Steps from the corner, first to last; empty if last < first.
struct StepSpan {
  int first = 0, last = -1;
};

// What the edges allow on each line after the other: p + step * slope >= 0 holds from a step on, or up to
// one. The bound moves by a whole number of steps a line, and by one more whenever the remainder is full:
// exact, without a division a line. Edges are lanes of a vector; those left out allow everything.
template <typename Integer>
class EdgeBounds {
 public:
  explicit EdgeBounds(int pixels) { last_.fill(pixels); }
  // slope is not 0.
  void set(std::size_t edge, Integer p, Integer line, Integer slope) {
    const bool lower = slope > 0;
    const Integer divisor = lower ? slope : -slope;
    const Integer quotient = floorDivide(p, divisor), whole = floorDivide(line, divisor);
    divisor_[edge] = divisor;
    remainder_[edge] = p - quotient * divisor;
    part_[edge] = line - whole * divisor;
    if (lower) {
      first_[edge] = -quotient;
      first_whole_[edge] = -whole;
      first_more_[edge] = -1;
    } else {
      last_[edge] = quotient;
      last_whole_[edge] = whole;
      last_more_[edge] = 1;
    }
  }
  Integer first(Integer least) const { return std::max({least, first_[0], first_[1], first_[2]}); }
  Integer last() const { return std::min({last_[0], last_[1], last_[2]}); }
  void nextLine() {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Integer remainder = remainder_[k] + part_[k];
      const Integer full = remainder >= divisor_[k] ? -1 : 0;
      remainder_[k] = remainder - (divisor_[k] & full);
      first_[k] += first_whole_[k] + (first_more_[k] & full);
      last_[k] += last_whole_[k] + (last_more_[k] & full);
    }
  }

 private:
  static constexpr std::size_t kLanes = 4;  // three are used
  static Integer floorDivide(Integer a, Integer b) { return a / b - (a % b < 0 ? 1 : 0); }
  using Lanes = std::array<Integer, kLanes>;
  Lanes remainder_{}, part_{}, divisor_{1, 1, 1, 1};
  Lanes first_{}, first_whole_{}, first_more_{};
  Lanes last_{}, last_whole_{}, last_more_{};
};

// Calls visit(line, span) for each line that has valid pixels; lines and spans count from the corner.
template <typename Integer, typename Visit>
TilingCounts forEachSpanOf(const TilerSetup& setup, Visit&& visit) {
  EdgeBounds<Integer> edges(setup.pixels);
  int first_line = 0, last_line = setup.lines;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto p = static_cast<Integer>(setup.p_start[k]), line = static_cast<Integer>(setup.p_line[k]);
    if (setup.p_pixel[k] != 0) {
      edges.set(k, p, line, static_cast<Integer>(setup.p_pixel[k]));
      continue;
    }
    // An edge along the lines takes or leaves whole ones.
    while (first_line <= setup.lines && p + first_line * line < 0 && line > 0) ++first_line;
    while (last_line >= 0 && p + last_line * line < 0 && line <= 0) --last_line;
  }
  TilingCounts counts{.triangles = 1, .lines = setup.lines + 1};
  int start = 0;  // where the machine begins a line: at the first valid pixel of the one before
  for (int line = 0; line <= setup.lines; ++line) {
    const Integer first = edges.first(start), last = std::min<Integer>(edges.last(), setup.pixels);
    edges.nextLine();
    if (first > last || line < first_line || line > last_line) {
      // The whole rest of the line is looked through.
      counts.sampled += setup.pixels - start + 1;
      ++counts.empty_lines;
      continue;
    }
    const StepSpan span{.first = static_cast<int>(first), .last = static_cast<int>(last)};
    // The pixel behind the last ends the line, unless the box does.
    counts.sampled += std::min(span.last + 1, setup.pixels) - start + 1;
    counts.tiled += span.last - span.first + 1;
    start = span.first;
    visit(line, span);
  }
  return counts;
}

template <typename Visit>
TilingCounts forEachSpan(const TilerSetup& setup, Visit&& visit) {
  // P of the machine has 28 bits, with a line or two beyond the box; finer vertices have more.
  constexpr std::int64_t kStart = std::int64_t{1} << 28, kStep = std::int64_t{1} << 18;
  bool narrow = true;
  for (std::size_t k = 0; k < 3; ++k) {
    narrow = narrow && std::max(setup.p_start[k], -setup.p_start[k]) < kStart &&
             std::max(setup.p_line[k], -setup.p_line[k]) < kStep &&
             std::max(setup.p_pixel[k], -setup.p_pixel[k]) < kStep;
  }
  return narrow ? forEachSpanOf<std::int32_t>(setup, visit) : forEachSpanOf<std::int64_t>(setup, visit);
}

// Asks place(count) for each span, in the order of tiling, where its pixels go, and writes them there.
template <typename Place>
TilingCounts placePixels(const TilerSetup& setup, const NumberProfile& numbers, Place&& place) {
  const auto with = [&](auto accumulator) {
    return forEachSpan(setup, [&](int line, StepSpan span) {
      accumulator.beginLine(line);
      PixelPacket* out = place(static_cast<std::size_t>(span.last - span.first) + 1);
      const auto i = static_cast<std::uint16_t>(setup.i_start + line * setup.i_step);
      for (int step = span.first; step <= span.last; ++step) {
        const PixelValues values = accumulator.at(step);
        *out++ = {.i = i,
                  .j = static_cast<std::uint16_t>(setup.j_start + step * setup.j_step),
                  .color = values.color,
                  .background = setup.background,
                  .depth = values.depth};
      }
    });
  };
  return setup.single_precision ? with(SingleAccumulator(setup, numbers))
                                : with(ProfileAccumulator(setup, numbers));
}

// Appends the pixels of a triangle in the order of tiling.
TilingCounts tileTriangle(const TilerSetup& setup, const NumberProfile& numbers,
                          std::vector<PixelPacket>& pixels);

// The same for one triangle after the other. Words are sound (checkTriangleWords).
TilingCounts tileTriangles(std::span<const TriangleWords> triangles, const TilerConfiguration& configuration,
                           std::vector<PixelPacket>& pixels);

// What set-up and scanning make of triangles, without their pixels.
TilingCounts countTriangle(const TilerSetup& setup);

}  // namespace deltaz::ars
