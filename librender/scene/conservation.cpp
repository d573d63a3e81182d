#include "librender/scene/conservation.h"

#include <cstdint>
#include <fmt/format.h>

namespace deltaz {

std::string findLoss(const FrameStatistics& statistics) {
  const auto compare = [](const char* what, std::uint64_t in, std::uint64_t out) {
    return in == out ? std::string() : fmt::format("{}: {} came in, {} were accounted for", what, in, out);
  };
  const FrameStatistics::Nodes& n = statistics.nodes;
  const FrameStatistics::Models& m = statistics.models;
  const FrameStatistics::Triangles& t = statistics.triangles;
  std::string loss =
      compare("nodes", n.visited,
              n.empty + n.opened + n.out_of_view + n.beyond_horizon + n.facing_away + n.occluded + n.drawn);
  if (loss.empty()) loss = compare("models", m.visited, m.out_of_view + m.occluded + m.drawn);
  if (loss.empty()) loss = compare("triangles", t.in, t.back_facing + t.clipped + t.no_sample + t.drawn);
  if (loss.empty() && statistics.samples.written > statistics.samples.tested) {
    loss = fmt::format("samples: {} were written of {} tested", statistics.samples.written,
                       statistics.samples.tested);
  }
  return loss;
}

}  // namespace deltaz
