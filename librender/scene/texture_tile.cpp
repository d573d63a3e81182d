#include "librender/scene/texture_tile.h"

#include <array>
#include <cstddef>

#include "libdb/access/color.h"

namespace deltaz {

void makeLinear(TextureTile& tile) {
  static const std::array<float, 256> cover = [] {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code)
      table[code] = static_cast<float>(static_cast<double>(code) / 255.0);
    return table;
  }();
  static const std::array<float, 256> light = [] {
    std::array<float, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code)
      table[code] = static_cast<float>(decodeSrgb(static_cast<std::uint8_t>(code)));
    return table;
  }();
  tile.linear.resize(tile.texels.size());
  for (std::size_t k = 0; k + 3 < tile.texels.size(); k += 4) {
    const float of_texel = cover[tile.texels[k + 3]];
    for (std::size_t c = 0; c < 3; ++c) tile.linear[k + c] = light[tile.texels[k + c]] * of_texel;
    tile.linear[k + 3] = of_texel;
  }
}

}  // namespace deltaz
