#include "librender/ars/machine/triangle_source.h"

#include "librender/ars/machine/functional_memory.h"
#include "librender/ars/tiler/span_tiler.h"
#include "librender/ars/tiler/tiler_timing.h"
#include "librender/ars/tiler/triangle_encoder.h"

namespace deltaz::ars {

namespace {

// Goes along the lines of a triangle as the tiling machine does: a line begins below the first valid pixel of
// the last line that had one, and ends behind its last valid pixel, or with the box.
template <typename Accumulator>
void sampleSpans(const TilerSetup& setup, Accumulator&& accumulator, SampledTriangle& result) {
  int start = 0, line_before = -1;
  std::int32_t samples = 0;  // since the last pixel
  const auto pass_empty_lines = [&](int line) {
    samples += (line - line_before - 1) * (setup.pixels - start + 1);
    line_before = line;
  };
  forEachSpan(setup, [&](int line, StepSpan span) {
    pass_empty_lines(line);
    samples += span.first - start;
    accumulator.beginLine(line);
    PixelPacket packet;
    packet.i = static_cast<std::uint16_t>(setup.i_start + line * setup.i_step);
    packet.background = setup.background;
    for (int step = span.first; step <= span.last; ++step) {
      const auto values = accumulator.at(step);
      packet.j = static_cast<std::uint16_t>(setup.j_start + step * setup.j_step);
      packet.color = values.color;
      packet.depth = values.depth;
      result.pixels.push_back({.samples = samples + 1, .packet = packet});
      samples = 0;
    }
    samples = span.last < setup.pixels ? 1 : 0;
    start = span.first;
  });
  pass_empty_lines(setup.lines + 1);
  result.samples_after = samples;
}

}  // namespace

Picoseconds TriangleSource::setUpTime(std::size_t triangle) const {
  return ars::setUpTime(triangles_[triangle].oversample);
}

void TriangleSource::sample(std::size_t triangle, SampledTriangle& result) const {
  const TilerSetup setup = setUpTriangle(triangles_[triangle], configuration_, supplement(triangle));
  if (setup.single_precision) {
    sampleSpans(setup, SingleAccumulator(setup, configuration_.numbers), result);
  } else {
    sampleSpans(setup, ProfileAccumulator(setup, configuration_.numbers), result);
  }
}

std::span<const PixelPacket> TriangleSource::pixels(std::size_t triangle,
                                                    std::vector<PixelPacket>& room) const {
  const TilerSetup setup = setUpTriangle(triangles_[triangle], configuration_, supplement(triangle));
  std::size_t count = 0;
  placePixels(setup, configuration_.numbers, [&](std::size_t more) {
    if (count + more > room.size()) room.resize(2 * (count + more));
    count += more;
    return room.data() + (count - more);
  });
  return std::span(room).first(count);
}

void TriangleSource::write(std::size_t triangle, FunctionalMemory& memory) const {
  memory.write(setUpTriangle(triangles_[triangle], configuration_, supplement(triangle)),
               configuration_.numbers);
}

Result<TriangleSource> triangleSource(const TriangleStream& stream, std::uint32_t sub_image, int pass,
                                      const TilerConfiguration& configuration) {
  const TilerCorrections& corrections = configuration.corrections;
  const bool encode_again =
      !(configuration.numbers == stream.profile) || corrections.clamp_depth || corrections.true_color;
  if (encode_again && !stream.has_sources)
    return usageError("triangle stream",
                      "cannot be drawn in other numbers, or with depth or colour corrected",
                      "it holds the tilers' words and no projected triangles",
                      "record it with them, or draw it as it was recorded");
  TriangleSource source(configuration);
  std::size_t triangles = 0;
  for (const TriangleBatch& batch : stream.batches)
    if (batch.sub_image == sub_image && batch.pass == pass) triangles += batch.triangles.size();
  source.reserve(triangles);
  for (const TriangleBatch& batch : stream.batches) {
    if (batch.sub_image != sub_image || batch.pass != pass) continue;
    source.drain();
    for (std::size_t k = 0; k < batch.triangles.size(); ++k) {
      const TriangleVariables words = decodeTriangleWords(batch.triangles[k], stream.profile);
      if (encode_again) {
        const EncodedTriangle encoded =
            encodeTriangle(batch.sources[k], configuration.numbers,
                           {.oversample = words.oversample, .background = words.background});
        source.add(encoded.variables, encoded.supplement);
      } else {
        source.add(words);
      }
    }
  }
  return source;
}

}  // namespace deltaz::ars
