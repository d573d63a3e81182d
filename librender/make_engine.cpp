#include "librender/fast_engine.h"
#include "librender/reference/reference_engine.h"

namespace deltaz {

std::unique_ptr<Engine> makeEngine(EngineKind kind) {
  if (kind == EngineKind::kReference) return std::make_unique<ReferenceEngine>();
  return std::make_unique<FastEngine>();
}

}  // namespace deltaz
