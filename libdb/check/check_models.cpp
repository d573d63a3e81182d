// Models: trees of parts, what their transforms keep, their meshes and the spheres that hold them.
#include "libdb/check/check_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "libdb/access/model.h"
#include "libdb/check/block_reading.h"
#include "libdb/check/node_spheres.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

// How far rows of a rotation may be from equal lengths and right angles, in terms of those lengths.
constexpr double kAngleTolerance = 1e-6;

// Rotation and one scale: rows of equal length at right angles, right-handed.
bool keepsAngles(const ModelTransform& m) {
  const std::array<Vector3, 3> rows = {Vector3{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
  const double mean = (dot(rows[0], rows[0]) + dot(rows[1], rows[1]) + dot(rows[2], rows[2])) / 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::abs(dot(rows[k], rows[k]) - mean) > 2 * kAngleTolerance * mean) return false;
    if (std::abs(dot(rows[k], rows[(k + 1) % 3])) > kAngleTolerance * mean) return false;
  }
  return dot(cross(rows[0], rows[1]), rows[2]) > 0;
}

IssueLocation wherePart(const CheckedModel& model) {
  return whereBlock(*model.file, model.file->container->blockCount() - 1);
}

void checkTree(CheckContext& context, CheckedModel& model) {
  CheckedFile& file = *model.file;
  const std::uint32_t blocks = file.container->blockCount();
  if (blocks == 0) {
    IssueLocation where;
    where.file = file.reference.name;
    context.report.add(makeIssue(IssueCode::kModelTree, "the file has no tree of parts", where));
    return;
  }
  const auto bytes =
      readBlock(file, blocks - 1, BlockType::kModelTree, IssueCode::kModelTree, context.report);
  if (!bytes) return;
  auto tree = decodeModelTree(*bytes, blocks, file.container->path());
  if (!tree.ok()) return addError(context.report, tree.error(), wherePart(model));
  model.tree = std::move(tree).value();
  model.tree_known = true;
  std::vector<std::uint8_t> named(blocks - 1, 0);
  for (const ModelPart& part : model.tree.parts) {
    model.to_model.push_back(
        part.parent == kNoParent ? part.transform : concatenate(part.transform, model.to_model[part.parent]));
    if (!keepsAngles(part.transform)) {
      context.report.add(
          makeIssue(IssueCode::kModelTransform,
                    fmt::format("the transform of part {} stretches, shears or mirrors it", part.name),
                    wherePart(model)));
    }
    for (const ModelLod& lod : part.lods) {
      named[lod.block] = 1;
      const auto location = file.container->locate(lod.block);
      if (!location.ok() || location.value().type == BlockType::kModelMesh) continue;
      context.report.add(makeIssue(
          IssueCode::kModelTree,
          fmt::format("part {} names block {}, which is no mesh", part.name, lod.block), wherePart(model)));
      model.tree_known = false;
    }
  }
  for (std::uint32_t block = 0; block < named.size(); ++block) {
    if (named[block] != 0) continue;
    context.report.add(makeIssue(IssueCode::kModelTree, fmt::format("no part names block {}", block),
                                 whereBlock(file, block)));
  }
}

class ModelMeshRule {
 public:
  ModelMeshRule(CheckContext& context, CheckedModel& model) : context_(context), model_(model) {}

  void run() {
    parallelReport(context_.report, model_.tree.parts.size(), 1, [&](std::size_t number, Report& report) {
      const ModelPart& part = model_.tree.parts[number];
      checkOrder(part, report);
      for (std::size_t lod = 0; lod < part.lods.size(); ++lod) checkMesh(number, lod, report);
    });
  }

 private:
  void checkOrder(const ModelPart& part, Report& report) const {
    const auto complain = [&](std::string message) {
      report.add(makeIssue(IssueCode::kModelLod, std::move(message), wherePart(model_)));
    };
    if (!part.lods.empty() && part.lods[0].error != 0)
      complain(fmt::format("the finest mesh of part {} has error {}", part.name, part.lods[0].error));
    for (std::size_t k = 1; k < part.lods.size(); ++k) {
      const ModelLod &finer = part.lods[k - 1], &coarser = part.lods[k];
      if (coarser.triangle_count > finer.triangle_count) {
        complain(fmt::format("level {} of part {} has {} triangles, the finer one {}", k, part.name,
                             coarser.triangle_count, finer.triangle_count));
      }
      if (coarser.error < finer.error) {
        complain(fmt::format("level {} of part {} has error {}, the finer one {}", k, part.name,
                             coarser.error, finer.error));
      }
    }
  }

  void checkMesh(std::size_t number, std::size_t level, Report& report) {
    const ModelPart& part = model_.tree.parts[number];
    const ModelLod& lod = part.lods[level];
    const auto bytes =
        readBlock(*model_.file, lod.block, BlockType::kModelMesh, IssueCode::kModelTree, report);
    if (!bytes) return;
    const IssueLocation where = whereBlock(*model_.file, lod.block);
    const auto mesh = decodeModelMesh(*bytes, model_.file->container->path());
    if (!mesh.ok()) return addError(report, mesh.error(), where);
    if (mesh.value().triangles.size() != lod.triangle_count) {
      report.add(makeIssue(IssueCode::kModelMesh,
                           fmt::format("the mesh has {} triangles, not the {} part {} announces",
                                       mesh.value().triangles.size(), lod.triangle_count, part.name),
                           where));
    }
    double of_part = 0, of_model = 0;  // outside their spheres
    const auto outside = [](const Vector3& point, const std::array<double, 3>& centre, double radius) {
      return length(point - Vector3{centre[0], centre[1], centre[2]}) - radius;
    };
    for (const auto& vertex : mesh.value().vertices) {
      const Vector3 point{vertex[0], vertex[1], vertex[2]};
      of_part = std::max(of_part, outside(point, part.centre, part.radius));
      of_model = std::max(of_model, outside(transformPoint(model_.to_model[number], point),
                                            model_.tree.centre, model_.tree.radius));
    }
    const auto complain = [&](double metres, const char* whose) {
      if (metres <= NodeSpheres::kTolerance) return;
      report.add(makeIssue(IssueCode::kModelSphere,
                           fmt::format("a vertex of part {} lies {:.6f} m outside the sphere of the {}",
                                       part.name, metres, whose),
                           where, metres));
    };
    complain(of_part, "part");
    complain(of_model, "model");
  }

  CheckContext& context_;
  CheckedModel& model_;
};

}  // namespace

void checkModelTrees(CheckContext& context) {
  context.models.resize(context.area.models.size());
  for (CheckedFile& file : context.listed) {
    if (file.reference.role != FileRole::kModel || file.reference.segment >= context.models.size()) continue;
    CheckedModel& model = context.models[file.reference.segment];
    if (model.file != nullptr || !file.container) continue;
    model.file = &file;
    checkTree(context, model);
    if (!model.tree_known) {
      addSkipped(context.report,
                 fmt::format("the meshes of {}, whose tree of parts is damaged", file.reference.name));
    }
  }
}

void checkModelMeshes(CheckContext& context) {
  for (CheckedModel& model : context.models) {
    if (model.tree_known) ModelMeshRule(context, model).run();
  }
}

}  // namespace deltaz
