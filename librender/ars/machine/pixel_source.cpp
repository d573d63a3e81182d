#include "librender/ars/machine/pixel_source.h"

namespace deltaz::ars {

std::span<const PixelPacket> RecordedPixels::pixels(std::size_t triangle,
                                                    std::vector<PixelPacket>& room) const {
  room.clear();
  for (const SampledPixel& pixel : list[triangle].sampled.pixels) room.push_back(pixel.packet);
  return room;
}

}  // namespace deltaz::ars
