// What --stats writes: the camera, and for each frame what was skipped, read, drawn, and how long it took.
#pragma once

#include <span>
#include <string>

#include "tools/common/json_output.h"
#include "tools/dbview/options.h"

namespace deltaz {

// Camera and the view space it makes, so that pixels can be brought back to the Earth.
Json cameraJson(const Camera& camera);

// `repeats` are the statistics of one frame rendered again and again, at least once: counts are those of the
// first (what a frame costs when nothing is in memory), times are medians, with the least and the most of the
// whole frame.
Json statisticsJson(const std::string& area, const View& view, std::span<const FrameStatistics> repeats);

}  // namespace deltaz
