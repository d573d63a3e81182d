#include "librender/raster/texture_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace deltaz {
namespace {

const std::array<double, 256>& linearLight() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> linear{};
    for (std::size_t code = 0; code < linear.size(); ++code)
      linear[code] = decodeSrgb(static_cast<std::uint8_t>(code));
    return linear;
  }();
  return table;
}

TextureSample mix(const TextureSample& a, const TextureSample& b, double t) {
  return {mix(a.color, b.color, t), a.cover * (1 - t) + b.cover * t};
}

// Which texel of a tile, and how far from its centre towards the next one's; -1 is the border's.
struct Tap {
  int index = 0;
  double t = 0;
};

Tap tapAt(double posts, std::int32_t node, double texel_cells) {
  const double texel = posts / texel_cells - static_cast<double>(node) * kColorTileTexels - 0.5;
  const double index = std::clamp(std::floor(texel), -1.0, kColorTileTexels - 1.0);
  return {static_cast<int>(index), std::clamp(texel - index, 0.0, 1.0)};
}

}  // namespace

MipLevels mipLevels(double pixel_size, int leaf_cells, const ColorTree& tree) {
  const double texels = pixel_size / colorTexelCells(leaf_cells, 0);
  if (texels < std::ldexp(1.0, tree.finest_level)) return {tree.finest_level, 0};
  // Also where the pixel's size is beyond all numbers.
  if (!(texels < std::ldexp(1.0, tree.coarsest_level))) return {tree.coarsest_level, 0};
  int exponent = 0;
  const double half = std::frexp(texels, &exponent);
  return {exponent - 1, 2 * half - 1};
}

std::optional<TextureRequest> textureRequest(const ColorMap& map, std::uint16_t grid,
                                             const TextureFootprint& footprint) {
  const ColorTree* const tree = map.treeOf(grid);
  if (tree == nullptr || !std::isfinite(footprint.place.column) || !std::isfinite(footprint.place.row))
    return std::nullopt;
  const int leaf_cells = map.leafCells(grid);
  const MipLevels levels = mipLevels(footprint.size(), leaf_cells, *tree);
  const auto square = [&](int level) {
    return TextureSquare{grid, static_cast<std::int8_t>(level),
                         colorNodeAt(footprint.place.column, leaf_cells, level),
                         colorNodeAt(footprint.place.row, leaf_cells, level)};
  };
  return TextureRequest{footprint.place, square(levels.level),
                        square(levels.t > 0 ? levels.level + 1 : levels.level), levels.t};
}

TextureSample bilinearSample(const TextureTile& tile, const GridCoordinates& place) {
  const double texel_cells = colorTexelCells(tile.leaf_cells, tile.square.level);
  const Tap x = tapAt(place.column, tile.square.x, texel_cells);
  const Tap y = tapAt(place.row, tile.square.y, texel_cells);
  const std::array<double, 256>& linear = linearLight();
  const auto texel = [&](int di, int dj) -> TextureSample {
    const std::size_t offset = 4 * (static_cast<std::size_t>(y.index + 1 + dj) * kColorTileSide +
                                    static_cast<std::size_t>(x.index + 1 + di));
    const std::uint8_t* const codes = tile.texels.data() + offset;
    const double cover = codes[3] / 255.0;
    return {LinearColor{linear[codes[0]], linear[codes[1]], linear[codes[2]]} * cover, cover};
  };
  return mix(mix(texel(0, 0), texel(1, 0), x.t), mix(texel(0, 1), texel(1, 1), x.t), y.t);
}

TextureSample trilinearSample(TextureReader& reader, const TextureRequest& request) {
  const auto sample = [&](const TextureSquare& square) {
    const TextureTile* const tile = reader.find(square);
    return tile == nullptr ? TextureSample{} : bilinearSample(*tile, request.place);
  };
  const TextureSample fine = sample(request.fine);
  return request.t > 0 ? mix(fine, sample(request.coarse), request.t) : fine;
}

}  // namespace deltaz
