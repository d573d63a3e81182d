// Triangles as the tilers turn them into pixels, in the order in which the host sends them. The machine asks
// for a triangle when a tiler begins with it; which tiler that is, and when, is the machine's business.
// Thread-safety: const members from any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "librender/ars/simulated_time.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

class FunctionalMemory;

// A pixel of a triangle, and the samples it took to find it.
struct SampledPixel {
  std::int32_t samples = 1;  // since the pixel before, or since the triangle's first; this one included
  PixelPacket packet;
};

// One triangle, sample by sample.
struct SampledTriangle {
  std::vector<SampledPixel> pixels;
  std::int32_t samples_after = 0;  // behind the last pixel

  void clear() {
    pixels.clear();
    samples_after = 0;
  }
};

class PixelSource {
 public:
  PixelSource() = default;
  virtual ~PixelSource() = default;

  virtual std::size_t triangles() const = 0;
  // Numbers of the triangles before which all earlier ones are to be in memory, ascending.
  virtual std::vector<std::size_t> barriers() const = 0;
  // How long set-up takes at the nominal clock.
  virtual Picoseconds setUpTime(std::size_t triangle) const = 0;
  // For a timed run. `result` is cleared first.
  virtual void sample(std::size_t triangle, SampledTriangle& result) const = 0;
  // The same pixels, in any order. They may stand in `room`, which is the caller's to give again and grows as
  // is needed; valid until then.
  virtual std::span<const PixelPacket> pixels(std::size_t triangle, std::vector<PixelPacket>& room) const = 0;
  // Writes the same pixels.
  virtual void write(std::size_t triangle, FunctionalMemory& memory) const = 0;

 protected:
  PixelSource(const PixelSource&) = default;
  PixelSource& operator=(const PixelSource&) = default;
};

// Triangles whose samples are in memory already.
class RecordedPixels final : public PixelSource {
 public:
  struct Triangle {
    SampledTriangle sampled;
    Picoseconds set_up = 0;
  };
  std::vector<Triangle> list;
  std::vector<std::size_t> drains;  // barriers()

  std::size_t triangles() const override { return list.size(); }
  std::vector<std::size_t> barriers() const override { return drains; }
  Picoseconds setUpTime(std::size_t triangle) const override { return list[triangle].set_up; }
  void sample(std::size_t triangle, SampledTriangle& result) const override {
    result = list[triangle].sampled;
  }
  std::span<const PixelPacket> pixels(std::size_t triangle, std::vector<PixelPacket>& room) const override;
  void write(std::size_t triangle, FunctionalMemory& memory) const override;
};

}  // namespace deltaz::ars
