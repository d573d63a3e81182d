// Makes a model of a database from mesh files: reads, repairs, makes levels of detail, packs and writes it.
//
// The model does not depend on the number of threads. Errors: those of readMeshSource and putModel; kInvalid
// if nothing is left to draw. Thread-safety: pure function; one writer a database.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/file_system.h"
#include "libdb/build/mesh_repair.h"
#include "libdb/source/mesh_source.h"

namespace deltaz {

enum class ModelAnchor : std::uint8_t {
  kBase,    // the middle of the model's box in plan, its lowest point in height
  kOrigin,  // the origin of the files
};

struct ModelBuildOptions {
  std::string name;
  MeshSourceOptions source;
  ModelAnchor anchor = ModelAnchor::kBase;
  std::size_t lods = kMaximumPartLods;  // of each part, at most
  bool overwrite = false;               // replace a model of that name
  int threads = 0;                      // 0: as many as the machine has
  std::function<void(std::string_view phase, double fraction)> progress = {};
  std::vector<std::pair<std::string, std::string>> provenance = {};  // options in the order of their names
};

struct ModelSummary {
  struct Lod {
    std::size_t triangles = 0;
    double error = 0;  // metres
  };
  struct Part {
    std::string name, parent;  // no parent: the root
    std::vector<Lod> lods;
  };
  std::vector<Part> parts;
  std::array<double, 3> size{};  // of the whole model along x, y, z, metres
  RepairReport repairs;
  std::vector<std::string> warnings;
};

// `meshes` are parts of one model; several become children of a root of its own.
Result<ModelSummary> buildModel(const FileSystem& files, const std::string& target,
                                const std::vector<std::string>& meshes, const ModelBuildOptions& options);

}  // namespace deltaz
