// A view's triangles as the host would send them: pretiled, encoded, sub-image by sub-image and pass by pass.
//
// Thread-safety: pure functions. Cost: that of the triangles each sub-image shows some of.
#pragma once

#include <cstdint>
#include <vector>

#include "librender/ars/engine/ars_options.h"
#include "librender/ars/engine/pixel_names.h"
#include "librender/ars/engine/scene_triangles.h"
#include "librender/ars/pretiler/pretiler.h"
#include "librender/ars/words/triangle_stream.h"

namespace deltaz::ars {

// The numbers of the options, with depths at the hither plane in the top octave.
NumberProfile frameNumbers(const ArsOptions& options);

struct FrameStream {
  TriangleStream stream;  // with its sources
  // For each triangle of each batch, the number of the scene's triangle that it is of, or kOfBackground.
  std::vector<std::vector<std::uint32_t>> owner;
  PretilerCounts counts;  // of all sub-images
  // For each triangle of the scene, whether some sub-image shows some of it.
  std::vector<std::uint8_t> on_screen;
};

// `environment.view` is that of the samples, as large as the stream's picture.
FrameStream makeFrameStream(const SceneTriangles& scene, const Environment& environment,
                            const ArsOptions& options);

}  // namespace deltaz::ars
