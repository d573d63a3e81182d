#include "libdb/build/build_model.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <span>

#include "formats/hash.h"
#include "libdb/access/model.h"
#include "libdb/build/mesh_detail.h"
#include "libdb/build/model_writer.h"
#include "libdb/build/worker_pool.h"

namespace deltaz {

namespace {

constexpr std::size_t kLongestName = 255;

// All files' parts in one tree.
struct Gathered {
  std::vector<ImportedPart> parts;
  std::vector<std::string> warnings;
  std::vector<SourceFile> sources;
};

Result<Gathered> gather(const std::vector<std::string>& meshes, const ModelBuildOptions& options) {
  Gathered gathered;
  if (meshes.size() > 1) {
    gathered.parts.emplace_back();
    gathered.parts.front().name = options.name;
  }
  for (const std::string& path : meshes) {
    DELTAZ_TRY_ASSIGN(ImportedModel model, readMeshSource(path, options.source));
    const auto first = static_cast<std::uint32_t>(gathered.parts.size());
    for (ImportedPart& part : model.parts) {
      part.parent = part.parent != kNoParent ? part.parent + first : first == 0 ? kNoParent : 0;
      gathered.parts.push_back(std::move(part));
    }
    gathered.warnings.insert(gathered.warnings.end(), model.warnings.begin(), model.warnings.end());
    gathered.sources.push_back({baseName(path), model.content});
  }
  if (gathered.parts.size() > kMaximumModelParts) {
    return invalidError(IssueCode::kNone, options.name, "the model has too many parts",
                        fmt::format("it has {}, {} are the most", gathered.parts.size(), kMaximumModelParts),
                        "Join some in the files");
  }
  return gathered;
}

// Names that can be stored and told apart: "wheel", "wheel-2", ...
void nameParts(std::vector<ImportedPart>& parts) {
  std::set<std::string> taken;
  std::map<std::string, int> next;
  for (ImportedPart& part : parts) {
    std::string name = part.name.substr(0, kLongestName - 12);
    if (!isPrintableName(name)) name = "part";
    std::string unique = name;
    for (int& number = next.emplace(name, 2).first->second; !taken.insert(unique).second; ++number)
      unique = fmt::format("{}-{}", name, number);
    part.name = unique;
  }
}

// The box of the whole model as it stands by default.
struct ModelBox {
  std::array<double, 3> low, high;
};

ModelBox boxOf(const std::vector<ImportedPart>& parts) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  ModelBox box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  std::vector<ModelTransform> to_model;
  for (const ImportedPart& part : parts) {
    to_model.push_back(part.parent == kNoParent ? part.transform
                                                : concatenate(part.transform, to_model[part.parent]));
    for (const auto& [x, y, z] : part.mesh.positions) {
      const Vector3 p = transformPoint(
          to_model.back(), {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
      const std::array<double, 3> at = {p.x, p.y, p.z};
      for (std::size_t k = 0; k < 3; ++k) {
        box.low[k] = std::min(box.low[k], at[k]);
        box.high[k] = std::max(box.high[k], at[k]);
      }
    }
  }
  return box;
}

// For each part the first with the same mesh: wheels and bolts come in numbers.
std::vector<std::size_t> firstUses(const std::vector<ImportedPart>& parts) {
  std::map<std::uint64_t, std::vector<std::size_t>> by_hash;
  std::vector<std::size_t> first_use;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const ImportedMesh& mesh = parts[p].mesh;
    std::vector<std::size_t>& alike = by_hash[hash64(std::as_bytes(std::span(mesh.positions)))];
    const auto same = std::find_if(alike.begin(), alike.end(),
                                   [&](std::size_t other) { return parts[other].mesh == mesh; });
    first_use.push_back(same != alike.end() ? *same : p);
    if (same == alike.end()) alike.push_back(p);
  }
  return first_use;
}

Result<ModelSummary> build(const FileSystem& files, const std::string& target,
                           const std::vector<std::string>& meshes, const ModelBuildOptions& options) {
  const auto report = [&](std::string_view phase, double fraction) {
    if (options.progress) options.progress(phase, fraction);
  };
  report("reading", 0);
  DELTAZ_TRY_ASSIGN(Gathered gathered, gather(meshes, options));
  std::vector<ImportedPart>& parts = gathered.parts;
  nameParts(parts);
  ModelSummary summary;
  summary.warnings = gathered.warnings;
  report("repairing", 0.2);
  std::size_t total = 0;
  for (ImportedPart& part : parts) {
    summary.repairs += repairMesh(part.mesh);
    total += part.mesh.triangles.size();
  }
  if (total == 0) {
    return invalidError(IssueCode::kNone, options.name, "there is nothing left to draw",
                        "no triangle of the meshes has an area", "Check the files and --units");
  }
  const std::vector<std::size_t> first_use = firstUses(parts);
  FinishedModel model;
  model.parts.resize(parts.size());
  std::size_t done = 0;
  std::mutex reporting;
  WorkerPool workers(options.threads);
  workers.forEach(parts.size(), [&](std::size_t p) {
    const ImportedPart& part = parts[p];
    FinishedPart& finished = model.parts[p];
    finished.name = part.name;
    finished.parent = part.parent;
    finished.transform = part.transform;
    if (part.mesh.triangles.empty()) return;
    if (first_use[p] == p) finished.lods = makeDetailLevels(part.mesh, options.lods);
    const std::lock_guard guard(reporting);
    done += part.mesh.triangles.size();
    report("levels of detail", 0.2 + 0.7 * static_cast<double>(done) / static_cast<double>(total));
  });
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (first_use[p] != p) model.parts[p].lods = model.parts[first_use[p]].lods;
  }
  const ModelBox box = boxOf(parts);
  for (std::size_t k = 0; k < 3; ++k) summary.size[k] = box.high[k] - box.low[k];
  if (options.anchor == ModelAnchor::kBase)
    model.anchor = {(box.low[0] + box.high[0]) / 2, (box.low[1] + box.high[1]) / 2, box.low[2]};
  for (const FinishedPart& part : model.parts) {
    ModelSummary::Part line;
    line.name = part.name;
    if (part.parent != kNoParent) line.parent = model.parts[part.parent].name;
    for (const FinishedLod& lod : part.lods)
      line.lods.push_back({lod.mesh.triangles.size(), static_cast<double>(lod.error)});
    summary.parts.push_back(std::move(line));
  }
  report("writing", 0.9);
  DELTAZ_TRY(putModel(files, target, {options.name, "mesh", gathered.sources, options.provenance}, model,
                      options.overwrite));
  report("done", 1);
  return summary;
}

}  // namespace

Result<ModelSummary> buildModel(const FileSystem& files, const std::string& target,
                                const std::vector<std::string>& meshes, const ModelBuildOptions& options) {
  // What stands in the way is said before minutes of work.
  DELTAZ_TRY(checkModelTarget(files, target, options.name, options.overwrite));
  if (meshes.empty()) return usageError("MESH", "no mesh is given");
  try {
    return build(files, target, meshes, options);
  } catch (const std::bad_alloc&) {
    return accessError(options.name, "the model cannot be built", "there is not enough memory");
  }
}

}  // namespace deltaz
