// Models: what a coarser mesh is said to differ from the finest at most, measured anew.
#include <algorithm>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "libdb/check/block_reading.h"
#include "libdb/check/check_models.h"
#include "libdb/check/mesh_deviation.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

// What rounding to floats and of the measure itself may bring, in terms of the part's radius.
constexpr double kRounding = 1e-7;

// Nothing if it cannot be read, which level "decode" reported.
std::optional<ModelMesh> meshOf(const CheckedModel& model, const ModelLod& lod, Report& report) {
  const auto bytes = readBlock(*model.file, lod.block, BlockType::kModelMesh, IssueCode::kModelTree, report);
  if (!bytes) return std::nullopt;
  auto mesh = decodeModelMesh(*bytes, model.file->container->path());
  if (!mesh.ok()) return std::nullopt;
  return std::move(mesh).value();
}

void checkError(const CheckedModel& model, std::size_t number, std::size_t level, Report& report) {
  const ModelPart& part = model.tree.parts[number];
  const ModelLod& lod = part.lods[level];
  const auto finest = meshOf(model, part.lods[0], report), coarse = meshOf(model, lod, report);
  if (!finest || !coarse) return;
  const double stored = static_cast<double>(lod.error), slack = kModelErrorSlack * part.radius;
  const double least = std::max(0.0, (stored - slack) / kModelErrorFactor);
  const double most = stored + kRounding * part.radius;
  const MeshDeviation found = measureDeviation(*finest, *coarse, least, most);
  const auto complain = [&](double measured, const char* word) {
    report.add(makeIssue(IssueCode::kModelError,
                         fmt::format("level {} of part {} has error {:.6g} m; {} {:.6g} m was measured",
                                     level, part.name, stored, word, measured),
                         whereBlock(*model.file, lod.block), std::abs(measured - stored)));
  };
  if (found.sampled > most) {
    complain(found.sampled, "at least");
  } else if (found.bound <= least && stored > slack) {
    complain(found.bound, "at most");
  }
}

}  // namespace

void checkModelErrors(CheckContext& context) {
  for (const CheckedModel& model : context.models) {
    if (!model.tree_known) continue;
    std::vector<std::pair<std::size_t, std::size_t>> coarser;
    for (std::size_t part = 0; part < model.tree.parts.size(); ++part) {
      for (std::size_t level = 1; level < model.tree.parts[part].lods.size(); ++level)
        coarser.emplace_back(part, level);
    }
    parallelReport(context.report, coarser.size(), 1, [&](std::size_t item, Report& report) {
      checkError(model, coarser[item].first, coarser[item].second, report);
    });
  }
}

}  // namespace deltaz
