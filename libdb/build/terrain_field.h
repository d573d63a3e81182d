// Colours that follow from the terrain itself: a ramp over its heights, or the rules of
// libdb/access/synthetic_color.h. Heights and rule colours are bilinear between posts; past the outermost
// posts theirs hold; void posts count nothing.
//
// Cost: reads each leaf about twice; keeps some tens of megabytes of them. Errors: those of reading the
// database; kInternal for a grid that is not there.
#pragma once

#include <functional>
#include <memory>

#include "libdb/access/database.h"
#include "libdb/access/synthetic_color.h"
#include "libdb/build/color_field.h"
#include "libdb/source/color_ramp.h"

namespace deltaz {

using SurfaceRule = LinearColor (*)(const SurfacePoint&);

class TerrainField final : public ColorField {
 public:
  // `database` and `ramp` must outlive it.
  static Result<std::unique_ptr<TerrainField>> ofRamp(const Database& database, int grid,
                                                      const ColorRamp& ramp);
  static Result<std::unique_ptr<TerrainField>> ofRule(const Database& database, int grid, SurfaceRule rule);
  ~TerrainField() override;

  bool touches(const TexelBlock&) const override { return true; }
  bool isFiner(const TexelBlock& block, int level) const override;
  Status sample(const TexelBlock& block, std::span<CoveredColor> colors) const override;

 private:
  struct Leaves;
  struct Window;
  TerrainField();
  static Result<std::unique_ptr<TerrainField>> make(const Database& database, int grid);
  Status load(Window& window) const;
  CoveredColor colorAt(const Window& window, double column, double row) const;

  const ColorRamp* ramp_ = nullptr;
  SurfaceRule rule_ = nullptr;
  std::unique_ptr<Leaves> leaves_;
};

}  // namespace deltaz
