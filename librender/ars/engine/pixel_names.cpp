#include "librender/ars/engine/pixel_names.h"

#include <utility>

namespace deltaz::ars {

PixelNames::PixelNames(std::vector<std::uint32_t> names, int lines, int pixels)
    : names_(std::move(names)),
      lines_(lines),
      pixels_(pixels),
      seen_(static_cast<std::size_t>(lines) * static_cast<std::size_t>(pixels)),
      tiled_(names_.size()) {}

std::uint32_t PixelNames::at(int line, int pixel) const {
  const Seen& seen = seen_[static_cast<std::size_t>(line) * static_cast<std::size_t>(pixels_) +
                           static_cast<std::size_t>(pixel)];
  return seen.triangle == kNone ? kOfBackground : names_[seen.triangle];
}

std::vector<std::uint32_t> PixelNames::tiled() const {
  std::vector<std::uint32_t> tiled;
  for (std::size_t triangle = 0; triangle < tiled_.size(); ++triangle)
    if (tiled_[triangle] != 0) tiled.push_back(names_[triangle]);
  return tiled;
}

void NamingSource::sample(std::size_t triangle, SampledTriangle& result) const {
  const std::size_t before = result.pixels.size();
  source_.sample(triangle, result);
  if (!names_.keeps(triangle)) return;
  for (std::size_t k = before; k < result.pixels.size(); ++k) names_.take(triangle, result.pixels[k].packet);
}

void takeAllNames(const PixelSource& source, PixelNames& names) {
  std::vector<PixelPacket> room;
  for (std::size_t triangle = 0; triangle < source.triangles(); ++triangle) {
    if (!names.keeps(triangle)) continue;
    for (const PixelPacket& pixel : source.pixels(triangle, room)) names.take(triangle, pixel);
  }
}

}  // namespace deltaz::ars
