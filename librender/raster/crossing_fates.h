// What becomes of triangles that touch several tiles: drawn in one, hidden in another. Each worker notes it
// for itself, so that nobody waits, and all of it is counted when the tiles are done.
//
// Memory is kept from frame to frame. Thread-safety: one set of notes a thread; counting after all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace deltaz {

// Bits of what a tile found.
inline constexpr std::uint8_t kCrossingCovers = 1, kCrossingHidden = 2;

class CrossingFates {
 public:
  struct Counts {
    std::uint64_t covering = 0;  // some sample, in some tile
    std::uint64_t hidden = 0;    // no sample, but only because something lies before them
  };

  // Forgets everything. `numbers`: greater than any RasterTriangle::crossing.
  void reset(std::size_t workers, std::size_t numbers) {
    notes_.resize(workers);
    for (std::vector<std::uint8_t>& notes : notes_) notes.assign(numbers, 0);
  }

  // By RasterTriangle::crossing.
  std::span<std::uint8_t> notesOf(std::size_t worker) { return notes_[worker]; }

  Counts counted() const {
    Counts counts;
    if (notes_.empty()) return counts;
    for (std::size_t number = 1; number < notes_[0].size(); ++number) {
      std::uint8_t bits = 0;
      for (const std::vector<std::uint8_t>& notes : notes_) bits |= notes[number];
      counts.covering += (bits & kCrossingCovers) != 0 ? 1 : 0;
      counts.hidden += bits == kCrossingHidden ? 1 : 0;
    }
    return counts;
  }

 private:
  std::vector<std::vector<std::uint8_t>> notes_;  // of each worker
};

}  // namespace deltaz
