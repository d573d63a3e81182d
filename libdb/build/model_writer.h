// Puts a finished model into a database, replaces it, or takes it out. What stands where is kept in step:
// placements follow their model's number, and the spheres of their pages follow its size.
//
// Each is one edit: it is there completely or not at all, and files of the old state stay for readers that
// have them open. Errors: kUsage (a bad or taken name, a model that is not there or still stands somewhere),
// and whatever Publication and reading report. Thread-safety: pure functions; one writer a database.
#pragma once

#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/file_system.h"
#include "formats/model_file.h"

namespace deltaz {

struct FinishedLod {
  ModelMesh mesh;
  float error = 0;  // metres in the part's space; 0 for the finest
};

struct FinishedPart {
  std::string name;
  std::uint32_t parent = kNoParent;
  ModelTransform transform = kIdentityTransform;
  std::vector<FinishedLod> lods;  // finest first
};

struct FinishedModel {
  std::vector<FinishedPart> parts;  // as ModelTree::parts
  std::array<double, 3> anchor{};
};

// The tree of the file, its spheres included, as if the meshes stood in blocks 0, 1, ... in the order of the
// parts and their levels of detail.
ModelTree modelTreeOf(const FinishedModel& model);

// What putModel would refuse at once, whatever the model.
Status checkModelTarget(const FileSystem& files, const std::string& target, const std::string& name,
                        bool overwrite);

// `header.name` must be isAssetName. With `overwrite` a model of that name is replaced.
Status putModel(const FileSystem& files, const std::string& target, const AssetHeader& header,
                const FinishedModel& model, bool overwrite);

// kUsage if the model still stands somewhere.
Status removeModel(const FileSystem& files, const std::string& target, const std::string& name);

}  // namespace deltaz
