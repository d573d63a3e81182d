#include "librender/reference/reference_texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace deltaz {

// With weights of the second and third vertex b = B.r / N.r, c = C.r / N.r on the ray r, where N is the
// face's normal, the quotient rule gives their changes from pixel to pixel, since r changes by (0, 1, 0) or
// (0, 0, 1).
ReferenceFootprint referenceFootprint(const std::array<Vector3, 3>& position,
                                      const std::array<GridCoordinates, 3>& texture, const Vector3& ray) {
  const Vector3 &origin = position[0], to_b = position[1] - origin, to_c = position[2] - origin;
  const Vector3 normal = cross(to_b, to_c), b_plane = cross(to_c, origin), c_plane = cross(origin, to_b);
  const double whole = dot(normal, ray);
  const double b = dot(b_plane, ray) / whole, c = dot(c_plane, ray) / whole;
  const auto along = [&](double b_part, double c_part) {
    return GridCoordinates{
        b_part * (texture[1].column - texture[0].column) + c_part * (texture[2].column - texture[0].column),
        b_part * (texture[1].row - texture[0].row) + c_part * (texture[2].row - texture[0].row)};
  };
  const GridCoordinates offset = along(b, c);
  const GridCoordinates to_right =
      along((b_plane.y - b * normal.y) / whole, (c_plane.y - c * normal.y) / whole);
  const GridCoordinates downward =
      along((b_plane.z - b * normal.z) / whole, (c_plane.z - c * normal.z) / whole);
  ReferenceFootprint footprint;
  footprint.place = {texture[0].column + offset.column, texture[0].row + offset.row};
  footprint.pixel_size =
      std::max(std::hypot(to_right.column, to_right.row), std::hypot(downward.column, downward.row));
  return footprint;
}

Result<ReferenceTexture::Texel> ReferenceTexture::bilinear(std::uint16_t grid, const GridCoordinates& place,
                                                           int level) {
  DELTAZ_TRY_ASSIGN(const auto node, map_->nodeAt(grid, place.column, place.row, level));
  if (!node) return Texel{};
  auto found = tiles_.find(node->block);
  if (found == tiles_.end()) {
    DELTAZ_TRY_ASSIGN(std::vector<std::uint8_t> texels, map_->tile(*node));
    found = tiles_.emplace(node->block, std::move(texels)).first;
  }
  const std::vector<std::uint8_t>& texels = found->second;

  // In texels of the tile with its border, so that texel n has its centre at n + 0.5.
  const double cells = colorNodeCells(map_->leafCells(grid), node->level);
  const double x = (place.column / cells - node->x) * kColorTileTexels + 1;
  const double y = (place.row / cells - node->y) * kColorTileTexels + 1;
  Texel sum{};
  for (int row = static_cast<int>(y - 0.5); row < static_cast<int>(y - 0.5) + 2; ++row) {
    for (int column = static_cast<int>(x - 0.5); column < static_cast<int>(x - 0.5) + 2; ++column) {
      const double weight = (1 - std::abs(x - 0.5 - column)) * (1 - std::abs(y - 0.5 - row));
      if (weight <= 0) continue;
      const std::size_t at = 4 * (static_cast<std::size_t>(std::clamp(row, 0, kColorTileSide - 1)) *
                                      static_cast<std::size_t>(kColorTileSide) +
                                  static_cast<std::size_t>(std::clamp(column, 0, kColorTileSide - 1)));
      const double cover = texels[at + 3] / 255.0;
      for (std::size_t channel = 0; channel < 3; ++channel)
        sum[channel] += weight * cover * decodeSrgb(texels[at + channel]);
      sum[3] += weight * cover;
    }
  }
  return sum;
}

Result<LinearColor> ReferenceTexture::shade(const LinearColor& by_rule, double intensity, std::uint16_t grid,
                                            const ReferenceFootprint& footprint) {
  const ColorTree* const tree = map_ == nullptr ? nullptr : map_->treeOf(grid);
  if (tree == nullptr || std::isnan(footprint.place.column + footprint.place.row)) return by_rule;
  const auto texel = [&](int level) { return colorTexelCells(map_->leafCells(grid), level); };
  int level = tree->finest_level;
  while (level < tree->coarsest_level && footprint.pixel_size >= texel(level + 1)) ++level;
  DELTAZ_TRY_ASSIGN(Texel seen, bilinear(grid, footprint.place, level));
  const double size = footprint.pixel_size / texel(level);
  if (size > 1 && level < tree->coarsest_level) {
    DELTAZ_TRY_ASSIGN(const Texel coarser, bilinear(grid, footprint.place, level + 1));
    for (std::size_t channel = 0; channel < seen.size(); ++channel)
      seen[channel] += (coarser[channel] - seen[channel]) * (size - 1);
  }
  return by_rule * (1 - seen[3]) + LinearColor{seen[0], seen[1], seen[2]} * intensity;
}

}  // namespace deltaz
