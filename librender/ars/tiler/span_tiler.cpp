#include "librender/ars/tiler/span_tiler.h"

namespace deltaz::ars {

TilingCounts tileTriangles(std::span<const TriangleWords> triangles, const TilerConfiguration& configuration,
                           std::vector<PixelPacket>& pixels) {
  TilingCounts counts;
  for (const TriangleWords& words : triangles) {
    const TilerSetup setup = setUpTriangle(decodeTriangleWords(words, configuration.numbers), configuration);
    counts += forEachPixel(setup, configuration.numbers,
                           [&](const PixelPacket& pixel) { pixels.push_back(pixel); });
  }
  return counts;
}

TilingCounts countTriangle(const TilerSetup& setup) {
  return forEachSpan(setup, [](int, StepSpan) {});
}

}  // namespace deltaz::ars
