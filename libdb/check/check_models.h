// The rules of models. Internal to libdb/check.
#pragma once

#include <vector>

#include "formats/model_file.h"

namespace deltaz {

struct CheckContext;
struct CheckedFile;

struct CheckedModel {
  CheckedFile* file = nullptr;  // none if it could not be opened
  ModelTree tree;
  bool tree_known = false;
  // Each part's own space to model space, as it stands by default.
  std::vector<ModelTransform> to_model;
};

// A stored error is at most this much larger than the distance it bounds: the factor, and a part of the
// part's radius.
inline constexpr double kModelErrorFactor = 1.2;
inline constexpr double kModelErrorSlack = 2e-4;

// MDL_TREE, MDL_TRANSFORM; fills CheckContext::models.
void checkModelTrees(CheckContext& context);
// MDL_MESH, MDL_SPHERE, MDL_LOD.
void checkModelMeshes(CheckContext& context);
// MDL_ERROR.
void checkModelErrors(CheckContext& context);

}  // namespace deltaz
