#include "librender/ars/tiler/span_tiler.h"

namespace deltaz::ars {

TilingCounts tileTriangle(const TilerSetup& setup, const NumberProfile& numbers,
                          std::vector<PixelPacket>& pixels) {
  return placePixels(setup, numbers, [&](std::size_t count) {
    pixels.resize(pixels.size() + count);
    return pixels.data() + (pixels.size() - count);
  });
}

TilingCounts tileTriangles(std::span<const TriangleWords> triangles, const TilerConfiguration& configuration,
                           std::vector<PixelPacket>& pixels) {
  TilingCounts counts;
  for (const TriangleWords& words : triangles) {
    const TilerSetup setup = setUpTriangle(decodeTriangleWords(words, configuration.numbers), configuration);
    counts += tileTriangle(setup, configuration.numbers, pixels);
  }
  return counts;
}

TilingCounts countTriangle(const TilerSetup& setup) {
  return forEachSpan(setup, [](int, StepSpan) {});
}

}  // namespace deltaz::ars
