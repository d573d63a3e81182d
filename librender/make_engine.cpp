#include "librender/ars/engine/ars_engine.h"
#include "librender/fast_engine.h"
#include "librender/reference/reference_engine.h"

namespace deltaz {

std::unique_ptr<Engine> makeEngine(EngineKind kind) {
  switch (kind) {
    case EngineKind::kReference:
      return std::make_unique<ReferenceEngine>();
    case EngineKind::kArs:
      return std::make_unique<ArsEngine>();
    case EngineKind::kFast:
      break;
  }
  return std::make_unique<FastEngine>();
}

}  // namespace deltaz
