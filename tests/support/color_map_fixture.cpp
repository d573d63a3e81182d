#include "tests/support/color_map_fixture.h"

#include <stdexcept>

#include "libdb/access/color.h"
#include "libdb/access/color_map.h"
#include "libdb/build/color_map_edit.h"
#include "libdb/build/color_pyramid.h"
#include "libdb/build/color_texel.h"

namespace deltaz {

namespace {

class FunctionField final : public ColorField {
 public:
  FunctionField(const ColorFunction& color, int leaf_cells, int finest_level)
      : color_(color), leaf_cells_(leaf_cells), finest_level_(finest_level) {}

  bool touches(const TexelBlock&) const override { return true; }
  bool isFiner(const TexelBlock&, int level) const override { return level > finest_level_; }
  Status sample(const TexelBlock& block, std::span<CoveredColor> colors) const override {
    const double texel = colorTexelCells(leaf_cells_, block.level);
    std::size_t k = 0;
    for (int row = 0; row < block.rows; ++row) {
      for (int column = 0; column < block.columns; ++column) {
        const Texel code =
            color_(block.grid, (static_cast<double>(block.first_column + column) + 0.5) * texel,
                   (static_cast<double>(block.first_row + row) + 0.5) * texel);
        const double cover = code[3] / 255.0;
        colors[k++] = {cover * linearOfSrgb(code[0]), cover * linearOfSrgb(code[1]),
                       cover * linearOfSrgb(code[2]), cover};
      }
    }
    return Success{};
  }

 private:
  const ColorFunction& color_;
  int leaf_cells_, finest_level_;
};

}  // namespace

void addColorMapOf(const FileSystem& files, const std::string& path, const std::string& name,
                   const std::function<int(std::uint16_t grid)>& finest_level, const ColorFunction& color) {
  WorkerPool workers(0);
  const AssetHeader header{name, "synthetic", {}, {}};
  const auto added =
      addColorMap(files, path, header, false, [&](const AreaHeader& area, ColorMapWriter& writer) -> Status {
        for (std::size_t g = 0; g < area.grids.size(); ++g) {
          const auto number = static_cast<std::uint16_t>(g);
          const FunctionField field(color, area.grids[g].leaf_cells, finest_level(number));
          DELTAZ_TRY(buildColorPyramid(number, area.grids[g], field, {}, workers, writer));
        }
        return Success{};
      });
  if (!added.ok()) throw std::runtime_error(added.error().message());
}

void addColorMapOf(const FileSystem& files, const std::string& path, const std::string& name,
                   int finest_level, const ColorFunction& color) {
  addColorMapOf(
      files, path, name, [finest_level](std::uint16_t) { return finest_level; }, color);
}

}  // namespace deltaz
