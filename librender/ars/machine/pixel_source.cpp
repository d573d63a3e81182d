#include "librender/ars/machine/pixel_source.h"

namespace deltaz::ars {

void RecordedPixels::pixels(std::size_t triangle, std::vector<PixelPacket>& result) const {
  for (const SampledPixel& pixel : list[triangle].sampled.pixels) result.push_back(pixel.packet);
}

}  // namespace deltaz::ars
