// The meshes of the parts a frame draws: each level of detail of a model's part is read once, however many
// instances show it.
//
// Errors: whatever reading reports; of several the first part's. Runs on the threads of the caller's TBB
// arena. Thread-safety: const members from any thread.
#pragma once

#include <cstddef>
#include <vector>

#include "formats/error.h"
#include "formats/model_file.h"
#include "libdb/access/database.h"
#include "librender/scene/model_tree_processor.h"

namespace deltaz {

class PartMeshes {
 public:
  static Result<PartMeshes> read(const Database& database, const std::vector<DrawnPart>& parts);

  // Of the n-th of the parts that were asked for.
  const ModelMesh& of(std::size_t n) const { return meshes_[index_[n]]; }

 private:
  std::vector<ModelMesh> meshes_;
  std::vector<std::size_t> index_;
};

}  // namespace deltaz
