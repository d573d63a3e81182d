// The 1983 machine behind the interface of the engines: the scene's triangles through pretiler, tilers,
// distribution tree, memories and antialiaser, sub-image by sub-image, colour by colour.
//
// What it takes from the scene is what the fast engine draws (scene_triangles.h). The picture is the
// memories', to the last bit; it depends on no number of threads. Depths are the memories', surfaces and
// triangles those that a frame memory with names would hold. FrameStatistics::ars says what the machine did.
// Errors: kUsage for what it has no hardware for (several samples a pixel but its own, levels by range,
// transforms); whatever reading reports. Thread-safety: as Engine.
#pragma once

#include "librender/ars/words/triangle_stream.h"
#include "librender/scene/render.h"

namespace deltaz {

class ArsEngine final : public Engine {
 public:
  Result<Picture> render(const Database& database, const RenderOptions& options,
                         FrameStatistics& statistics) const override;
};

// The same, and the stream that it was drawn from.
struct RecordedFrame {
  Picture picture;
  ars::TriangleStream stream;
};
Result<RecordedFrame> renderAndRecord(const Database& database, const RenderOptions& options,
                                      FrameStatistics& statistics);

}  // namespace deltaz
