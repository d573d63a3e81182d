#include "librender/ars/machine/pixel_source.h"

#include "librender/ars/machine/functional_memory.h"

namespace deltaz::ars {

std::span<const PixelPacket> RecordedPixels::pixels(std::size_t triangle,
                                                    std::vector<PixelPacket>& room) const {
  room.clear();
  for (const SampledPixel& pixel : list[triangle].sampled.pixels) room.push_back(pixel.packet);
  return room;
}

void RecordedPixels::write(std::size_t triangle, FunctionalMemory& memory) const {
  for (const SampledPixel& pixel : list[triangle].sampled.pixels) memory.write(std::span(&pixel.packet, 1));
}

}  // namespace deltaz::ars
