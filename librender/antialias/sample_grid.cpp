#include "librender/antialias/sample_grid.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

#include "librender/scene/environment.h"

namespace deltaz {

Status checkSampling(const RenderOptions& options) {
  const int count = options.sampling.count;
  if (std::find(std::begin(kSampleCounts), std::end(kSampleCounts), count) == std::end(kSampleCounts))
    return usageError("samples", fmt::format("{} is none of 1, 4, 16, 64", count));
  const int largest = kLargestPicture / samplesAcross(count);
  const Camera& camera = options.camera;
  if (count > 1 && std::max(camera.width, camera.height) > largest) {
    return usageError(
        "picture size",
        fmt::format("{} x {} is too large for {} samples a pixel", camera.width, camera.height, count),
        fmt::format("with so many it may be {} pixels each way", largest),
        "Draw a smaller picture, or with fewer samples");
  }
  return Success{};
}

RenderOptions onSampleGrid(const RenderOptions& options) {
  const int across = samplesAcross(options.sampling.count);
  RenderOptions grid = options;
  grid.camera.width *= across;
  grid.camera.height *= across;
  grid.tolerance *= across;
  // Its ranges follow the number of pixels.
  grid.report_lod.first_range /= across;
  return grid;
}

}  // namespace deltaz
