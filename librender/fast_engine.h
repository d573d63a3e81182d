// The product's engine: scheduler -> terrain object processor -> pretiler -> tiler -> depth/frame buffer ->
// resolver. Single stages run in parallel over nodes, screen tiles and rows; the picture does not depend on
// how many threads.
#pragma once

#include "librender/frame_scratch.h"
#include "librender/scene/render.h"
#include "librender/scene/texture_cache.h"

namespace deltaz {

class FastEngine : public Engine {
 public:
  Result<Picture> render(const Database& database, const RenderOptions& options,
                         FrameStatistics& statistics) const override;

 private:
  mutable FrameScratchPool scratches_;  // one frame uses one; kept for the next
  mutable TextureCache textures_;       // of all frames
};

}  // namespace deltaz
