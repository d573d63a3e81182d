// How a part of a model has moved: the motion of a dynamic model (report 5.7), given from outside.
// Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "formats/model_file.h"

namespace deltaz {

struct PartPose {
  std::string model, part;                // names
  std::optional<std::uint32_t> instance;  // of a placement; nothing: every instance of the model
  // Applied in the part's own space, before its default transform; what hangs under the part moves with it.
  ModelTransform motion = kIdentityTransform;
};

}  // namespace deltaz
