// Where in a pixel its samples lie.
//
// A picture with N = k x k samples a pixel is settled on a sample grid k times as fine as its pixels: sample
// (j, i) of the grid belongs to pixel (j / k, i / k). Ordered samples are the middles of the grid's cells.
// Rotated ones are moved within their cells, by the same 4 x 4 offsets over the whole grid, so that along the
// way across a nearly level or upright edge every sample counts by itself: for 4 and 16 samples no two of a
// pixel share a column or a row, for 64 no more than two. All are symmetric about the pixel's centre; one
// sample is the centre. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace deltaz {

enum class SamplePattern : std::uint8_t { kOrdered, kRotated };

// "ordered", "rotated".
std::string_view samplePatternName(SamplePattern pattern);

// The numbers of samples a pixel may have.
inline constexpr int kSampleCounts[] = {1, 4, 16, 64};

// k. Pre: `count` is one of kSampleCounts.
int samplesAcross(int count);

// How samples are moved from the middles of their cells, 1/256 of a cell, by place in 4 x 4 cells, row by
// row.
struct alignas(64) SampleOffsets {
  std::int32_t x[16], y[16];
  std::int32_t reach;  // no offset is larger either way
};

// nullptr where none is moved: ordered samples, and one a pixel. Lives as long as the program.
const SampleOffsets* sampleOffsets(int count, SamplePattern pattern);

// From the pixel's centre, 1/256 pixel; both within -128 .. 127.
struct SamplePlace {
  std::int32_t x, y;
};
// The samples of a pixel, row by row of the sample grid.
std::vector<SamplePlace> samplePlaces(int count, SamplePattern pattern);

// Which of them lies nearest to the pixel's centre; the first of equals.
int centralSample(const std::vector<SamplePlace>& places);

}  // namespace deltaz
