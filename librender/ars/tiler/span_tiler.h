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

// The steps 0..pixels at which p + step * slope >= 0 for all three edges.
template <typename Integer>
StepSpan validSteps(const std::array<Integer, 3>& p, const std::array<Integer, 3>& slope, int pixels) {
  StepSpan span{.first = 0, .last = pixels};
  for (std::size_t k = 0; k < 3; ++k) {
    if (slope[k] > 0) {
      if (p[k] < 0) {
        const Integer first = (slope[k] - 1 - p[k]) / slope[k];
        span.first = first > pixels ? pixels + 1 : std::max(span.first, static_cast<int>(first));
      }
    } else if (p[k] < 0) {
      return {};
    } else if (slope[k] < 0) {
      const Integer last = p[k] / -slope[k];
      if (last < pixels) span.last = std::min(span.last, static_cast<int>(last));
    }
  }
  return span;
}

// Calls visit(line, span) for each line that has valid pixels; lines and spans count from the corner.
template <typename Integer, typename Visit>
TilingCounts forEachSpanOf(const TilerSetup& setup, Visit&& visit) {
  std::array<Integer, 3> p{}, line_slope{}, slope{};
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = static_cast<Integer>(setup.p_start[k]);
    line_slope[k] = static_cast<Integer>(setup.p_line[k]);
    slope[k] = static_cast<Integer>(setup.p_pixel[k]);
  }
  TilingCounts counts{.triangles = 1, .lines = setup.lines + 1};
  int start = 0;  // where the machine begins a line: at the first valid pixel of the one before
  for (int line = 0; line <= setup.lines; ++line) {
    StepSpan span = validSteps(p, slope, setup.pixels);
    span.first = std::max(span.first, start);
    if (span.first > span.last) {
      // The whole rest of the line is looked through.
      counts.sampled += setup.pixels - start + 1;
      ++counts.empty_lines;
    } else {
      // The pixel behind the last ends the line, unless the box does.
      counts.sampled += std::min(span.last + 1, setup.pixels) - start + 1;
      counts.tiled += span.last - span.first + 1;
      start = span.first;
      visit(line, span);
    }
    for (std::size_t k = 0; k < 3; ++k) p[k] += line_slope[k];
  }
  return counts;
}

template <typename Visit>
TilingCounts forEachSpan(const TilerSetup& setup, Visit&& visit) {
  // P of the machine has 28 bits, with one line beyond the box; finer vertices have more.
  constexpr std::int64_t kLimit = std::int64_t{1} << 28;
  bool narrow = true;
  for (std::size_t k = 0; k < 3; ++k) {
    narrow = narrow && std::max(setup.p_start[k], -setup.p_start[k]) < kLimit &&
             std::max(setup.p_line[k], -setup.p_line[k]) < (kLimit >> 9);
  }
  return narrow ? forEachSpanOf<std::int32_t>(setup, visit) : forEachSpanOf<std::int64_t>(setup, visit);
}

// Calls visit(const PixelPacket&) for each valid pixel, in the order of tiling.
template <typename Visit>
TilingCounts forEachPixel(const TilerSetup& setup, const NumberProfile& numbers, Visit&& visit) {
  const auto with = [&](auto accumulator) {
    return forEachSpan(setup, [&](int line, StepSpan span) {
      accumulator.beginLine(line);
      PixelPacket packet;
      packet.i = static_cast<std::uint16_t>(setup.i_start + line * setup.i_step);
      packet.background = setup.background;
      for (int step = span.first; step <= span.last; ++step) {
        const PixelValues values = accumulator.at(step);
        packet.j = static_cast<std::uint16_t>(setup.j_start + step * setup.j_step);
        packet.color = values.color;
        packet.depth = values.depth;
        visit(packet);
      }
    });
  };
  return setup.single_precision ? with(SingleAccumulator(setup, numbers))
                                : with(ProfileAccumulator(setup, numbers));
}

// Appends the pixels of triangles, in order. Words are sound (checkTriangleWords).
TilingCounts tileTriangles(std::span<const TriangleWords> triangles, const TilerConfiguration& configuration,
                           std::vector<PixelPacket>& pixels);

// What set-up and scanning make of triangles, without their pixels.
TilingCounts countTriangle(const TilerSetup& setup);

}  // namespace deltaz::ars
