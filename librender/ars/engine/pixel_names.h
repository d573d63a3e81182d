// Whose pixel is seen, as a memory that keeps names beside depths would tell: the nearest triangle, of
// equally near ones the first in the stream, in whatever order pixels come.
//
// Thread-safety: one thread an object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "librender/ars/machine/pixel_source.h"

namespace deltaz::ars {

inline constexpr std::uint32_t kOfBackground = 0xFFFFFFFF;  // a name that is not kept

// Of one sub-image.
class PixelNames {
 public:
  // A name for each triangle of the stream; the picture has so many lines and pixels of the screen.
  PixelNames(std::vector<std::uint32_t> names, int lines, int pixels);

  void take(std::size_t triangle, const PixelPacket& pixel) {
    ++tiled_pixels_;
    tiled_[triangle] = 1;
    // Tolerances reach beyond a picture that does not fill the screen.
    if (pixel.i >= lines_ || pixel.j >= pixels_) return;
    Seen& seen = seen_[static_cast<std::size_t>(pixel.i) * static_cast<std::size_t>(pixels_) + pixel.j];
    const auto number = static_cast<std::uint32_t>(triangle);
    if (seen.triangle != kNone &&
        (pixel.depth < seen.depth || (pixel.depth == seen.depth && number > seen.triangle)))
      return;
    seen = {pixel.depth, number};
  }
  bool keeps(std::size_t triangle) const { return names_[triangle] != kOfBackground; }

  // kOfBackground where nothing with a name is.
  std::uint32_t at(int line, int pixel) const;
  // Names of the triangles that have pixels, once for each triangle.
  std::vector<std::uint32_t> tiled() const;
  std::uint64_t pixels() const { return tiled_pixels_; }  // of all triangles with names

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Seen {
    std::uint32_t depth = 0, triangle = kNone;
  };

  std::vector<std::uint32_t> names_;
  int lines_, pixels_;
  std::vector<Seen> seen_;
  std::vector<std::uint8_t> tiled_;  // by triangle
  std::uint64_t tiled_pixels_ = 0;
};

// A source whose timed run leaves names: each triangle is sampled once, for the machine and for them.
class NamingSource final : public PixelSource {
 public:
  // Both outlive it.
  NamingSource(const PixelSource& source, PixelNames& names) : source_(source), names_(names) {}

  std::size_t triangles() const override { return source_.triangles(); }
  std::vector<std::size_t> barriers() const override { return source_.barriers(); }
  Picoseconds setUpTime(std::size_t triangle) const override { return source_.setUpTime(triangle); }
  void sample(std::size_t triangle, SampledTriangle& result) const override;
  std::span<const PixelPacket> pixels(std::size_t triangle, std::vector<PixelPacket>& room) const override {
    return source_.pixels(triangle, room);
  }
  // Lines are written in vectors, without pixels that could be named: takeAllNames beside it.
  void write(std::size_t triangle, FunctionalMemory& memory) const override {
    source_.write(triangle, memory);
  }

 private:
  const PixelSource& source_;
  PixelNames& names_;
};

// All of a source, without a run.
void takeAllNames(const PixelSource& source, PixelNames& names);

}  // namespace deltaz::ars
