// The memories of a run without clocks: the words of all of them as one picture.
//
// Pixels come one by one, or as the lines of a triangle; lines are accumulated and compared in vectors, with
// the bits of SingleAccumulator and the words and counts of MemoryModule::write, pixel for pixel. Cost: about
// 11 ns a pixel one by one, 25 ns with the tiling of small triangles (bench_ars). Thread-safety: one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "librender/ars/memory/memory_module.h"
#include "librender/ars/tiler/pixel_values.h"
#include "librender/ars/tiler/tiler_setup.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

// Valid pixels of a triangle side by side, j ascending.
struct PixelRow {
  std::uint32_t place = 0;  // of the first pixel in the picture
  std::int32_t count = 0;
  float first_step = 0;        // of the first pixel from the corner; the others are one more or one less each
  float depth = 0, color = 0;  // where the line begins: SingleAccumulator::line
};

class FunctionalMemory {
 public:
  static constexpr std::size_t kWords = std::size_t{kScreenLines} * kScreenPixels;
  // Words behind the picture that vectors read and write back as they were.
  static constexpr std::size_t kPadding = 8;

  // `words` has kWords + kPadding of them and outlives the object.
  FunctionalMemory(std::span<std::uint64_t> words, TieRule ties, int depth_mantissa_bits);

  void write(std::span<const PixelPacket> pixels);
  // Sets up nothing: the valid pixels of a triangle that is.
  void write(const TilerSetup& setup, const NumberProfile& numbers);

  MemoryCounts counts() const;

  static constexpr std::size_t kCounters = 6, kLanes = 8;
  using Counters = std::array<std::array<std::uint64_t, kLanes>, kCounters>;

 private:
  void writeRows(const TilerSetup& setup, const SingleAccumulator& accumulator);

  std::span<std::uint64_t> words_;
  TieRule ties_;
  int exponent_shift_;
  MemoryModule module_;  // for pixels one by one
  std::vector<PixelRow> rows_;
  std::vector<PixelPacket> room_;
  alignas(64) Counters counters_{};
  std::uint64_t pixels_ = 0, background_ = 0;  // of rows
};

}  // namespace deltaz::ars
