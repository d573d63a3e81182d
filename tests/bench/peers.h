// Other renderers on the benchmark's scenes, each behind the same small interface, so that one program times
// all of them in turn. A peer that is not there (its library was missing when this was built, or it does not
// start) is nullptr.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "peer_scenes.h"

namespace deltaz::bench {

enum class PeerMode : std::uint8_t { kGouraud, kTextured };

class Peer {
 public:
  virtual ~Peer() = default;
  virtual std::string name() const = 0;
  // Clears, draws and finishes one frame; buffers are resident.
  virtual void frame() = 0;
  // The last frame: rows from the top, RGBA, red lowest.
  virtual std::vector<std::uint32_t> picture() = 0;
  // Milliseconds spent on a scene before its first frame (acceleration structures), 0 if none.
  virtual double preparation() const { return 0; }
};

// OpenGL 3.3 on Mesa's llvmpipe through EGL, as many threads as the environment's LP_NUM_THREADS says.
std::unique_ptr<Peer> makeLlvmpipe(const PeerScene& scene, PeerMode mode = PeerMode::kGouraud,
                                   int samples = 1);
// Primary rays in packets of 16, `threads` threads.
std::unique_ptr<Peer> makeEmbree(const PeerScene& scene, int threads);

}  // namespace deltaz::bench
