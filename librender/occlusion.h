// Whether what has been drawn of a frame hides all that a volume may draw: then it need not be read.
//
// Conservative, for these reasons. The volume is grown by what drawn positions may lie beside exact ones (the
// transform's error), so every vertex lies in it but for those a border moved. These lie up to the schedule's
// tolerance of pixels beside it: so far the extent on the screen is widened, and by the snap to 1/256 pixel,
// which bounds where a vertex may cover samples. 1/U that is tiled lies within the range of its vertices in
// single precision, and the volume's greatest is enlarged by more than that rounds. A sample is hidden where
// 1/U is there that is no less: what comes later is seen only if it is greater. The least 1/U of a block or
// tile is a true minimum of its samples.
//
// The sea hides nothing here: ground lies above it, so what it hides lies behind the horizon
// (scene/horizon.h). Thread-safety: const members from any thread while nothing is drawn.
#pragma once

#include "librender/raster/tiler.h"
#include "librender/scene/camera.h"
#include "librender/scene/node_volume.h"

namespace deltaz {

class Occlusion {
 public:
  // Refers to the tiler. `view` is that of its samples, and what is measured in pixels, in its pixels;
  // `reach`: samples lie no farther from the pixels' centres.
  Occlusion(const Tiler& tiler, const ViewTransform& view, double tolerance, double reach = 0)
      : tiler_(tiler), view_(view), margin_(tolerance + reach + kSnap) {}

  bool hides(const NodeVolume& volume) const;
  // All of what is drawn of a part of a model lies in its sphere.
  bool hides(const Vector3& centre, double radius) const;

 private:
  static constexpr double kSnap = 1.0 / 128;  // pixels: both coordinates snapped, and room for rounding

  const Tiler& tiler_;
  ViewTransform view_;
  double margin_;
};

}  // namespace deltaz
