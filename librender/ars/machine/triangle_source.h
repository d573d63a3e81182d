// Triangles as tilers get them, turned into pixels by set-up and the spans of the tiling algorithm. What a
// timed run samples is what TilingCursor samples, pixel by pixel; it is counted from the spans, not scanned.
// Thread-safety: const members from any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "librender/ars/machine/pixel_source.h"
#include "librender/ars/tiler/tiler_configuration.h"
#include "librender/ars/words/triangle_stream.h"
#include "librender/ars/words/triangle_variables.h"

namespace deltaz::ars {

class TriangleSource final : public PixelSource {
 public:
  explicit TriangleSource(const TilerConfiguration& configuration) : configuration_(configuration) {}

  // Tileable (isTileable) in the configuration's vertex fractions. All or none have supplements.
  void add(const TriangleVariables& triangle) { triangles_.push_back(triangle); }
  void add(const TriangleVariables& triangle, const TriangleSupplement& supplement) {
    triangles_.push_back(triangle);
    supplements_.push_back(supplement);
  }
  void reserve(std::size_t triangles) { triangles_.reserve(triangles); }
  // What is added from here on waits until all before is in memory.
  void drain() {
    if (!triangles_.empty()) barriers_.push_back(triangles_.size());
  }

  std::size_t triangles() const override { return triangles_.size(); }
  std::vector<std::size_t> barriers() const override { return barriers_; }
  Picoseconds setUpTime(std::size_t triangle) const override;
  void sample(std::size_t triangle, SampledTriangle& result) const override;
  std::span<const PixelPacket> pixels(std::size_t triangle, std::vector<PixelPacket>& room) const override;
  void write(std::size_t triangle, FunctionalMemory& memory) const override;

  const TilerConfiguration& configuration() const { return configuration_; }

 private:
  const TriangleSupplement* supplement(std::size_t triangle) const {
    return supplements_.empty() ? nullptr : &supplements_[triangle];
  }

  TilerConfiguration configuration_;
  std::vector<TriangleVariables> triangles_;
  std::vector<TriangleSupplement> supplements_;
  std::vector<std::size_t> barriers_;
};

// The batches of one part and pass of a stream, drained between. In the stream's own numbers its words are
// taken; in others, and with corrections that need supplements, the projected triangles beside them, and
// kUsage if it has none. The stream is one that encodeTriangleStream or decodeTriangleStream has accepted.
Result<TriangleSource> triangleSource(const TriangleStream& stream, std::uint32_t sub_image, int pass,
                                      const TilerConfiguration& configuration);

}  // namespace deltaz::ars
