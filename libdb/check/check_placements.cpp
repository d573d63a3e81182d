// Placements: numbers given once, spheres that hold what stands on a page, models that stand on the ground.
#include "libdb/check/check_placements.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/access/ground_query.h"
#include "libdb/access/model.h"
#include "libdb/check/block_reading.h"
#include "libdb/check/node_spheres.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

// A page's placements; nothing if they cannot be read. What is wrong with the contents goes to `report` if
// `first`: it is looked for once.
std::optional<std::vector<Placement>> placementsOn(const CheckContext& context,
                                                   const CheckedPlacements& placements, std::uint32_t page,
                                                   bool first, Report& report) {
  CheckedFile& file = *placements.file;
  const auto bytes = readBlock(file, page, BlockType::kPlacementPage, IssueCode::kPlacementRecord, report);
  if (!bytes) return std::nullopt;
  auto decoded = decodePlacementPage(*bytes, context.area.models.size(), file.container->path());
  if (decoded.ok()) return std::move(decoded).value();
  if (first) addError(report, decoded.error(), whereBlock(file, page));
  return std::nullopt;
}

class PlacedModelRule {
 public:
  explicit PlacedModelRule(CheckContext& context)
      : context_(context), placements_(*context.placements), ellipsoid_(context.area.grids[0].ellipsoid) {}

  void run() {
    openGround();
    parallelReport(context_.report, placements_.directory.pages.size(), 1,
                   [&](std::size_t page, Report& report) {
                     const auto number = static_cast<std::uint32_t>(page);
                     const auto placed = placementsOn(context_, placements_, number, false, report);
                     if (!placed) return;
                     checkSphere(number, *placed, report);
                     if (ground_) checkGround(number, *placed, report);
                   });
  }

 private:
  // The same state of the database through the reader, which asks for ground.
  void openGround() {
    bool sound = context_.tree_sound && context_.positions_known;
    for (const IssueGroup& group : context_.report.groups)
      sound = sound && (group.severity != Severity::kError || group.code >= IssueCode::kColorTree);
    if (!sound) {
      addSkipped(context_.report, "the ground under models, since there are errors in the terrain");
      return;
    }
    auto database = Database::open(context_.files, context_.path);
    if (!database.ok()) {
      // Damage to other files was reported where it was found.
      if (database.error().kind == ErrorKind::kInvalid && context_.report.count(Severity::kError) > 0) {
        addSkipped(context_.report, "the ground under models, since the database cannot be opened");
      } else {
        addError(context_.report, database.error());
      }
      return;
    }
    if (database.value().area() != context_.area) {
      addSkipped(context_.report, "the ground under models, since the database was changed meanwhile");
      return;
    }
    ground_.emplace(std::move(database).value());
  }

  void checkSphere(std::uint32_t page, const std::vector<Placement>& placed, Report& report) const {
    const PlacementSphere& sphere = placements_.directory.pages[page];
    for (const Placement& placement : placed) {
      const CheckedModel& model = context_.models[placement.model];
      if (!model.tree_known) continue;
      const double outside = outsideOf(sphere, model, placement, report);
      if (outside <= NodeSpheres::kTolerance) continue;
      report.add(makeIssue(
          IssueCode::kPlacementSphere,
          fmt::format("instance {} of model {} reaches {:.6f} m out of the sphere of page {}",
                      placement.instance, context_.area.models[placement.model].name, outside, page),
          whereInstance(page, placement), outside));
    }
  }

  // How far a placed model reaches out of a sphere; the model's own sphere, then those of its parts, spare
  // most models the look at their vertices.
  double outsideOf(const PlacementSphere& sphere, const CheckedModel& model, const Placement& placement,
                   Report& report) const {
    const ModelTransform to_earth = placementTransform(placement, model.tree.anchor, ellipsoid_);
    const Vector3 centre{sphere.centre[0], sphere.centre[1], sphere.centre[2]};
    const auto reach = [&](const ModelTransform& transform, const std::array<double, 3>& at, double radius) {
      const Vector3 point = transformPoint(transform, {at[0], at[1], at[2]});
      return length(point - centre) + radius * largestStretch(transform) - sphere.radius;
    };
    if (reach(to_earth, model.tree.centre, model.tree.radius) <= NodeSpheres::kTolerance) return 0;
    double outside = 0;
    for (std::size_t number = 0; number < model.tree.parts.size(); ++number) {
      const ModelPart& part = model.tree.parts[number];
      const ModelTransform transform = concatenate(model.to_model[number], to_earth);
      if (reach(transform, part.centre, part.radius) <= NodeSpheres::kTolerance) continue;
      for (const ModelLod& lod : part.lods) {
        const auto bytes =
            readBlock(*model.file, lod.block, BlockType::kModelMesh, IssueCode::kModelTree, report);
        if (!bytes) continue;
        const auto mesh = decodeModelMesh(*bytes, model.file->container->path());
        if (!mesh.ok()) continue;
        for (const auto& v : mesh.value().vertices) {
          const Vector3 vertex{static_cast<double>(v[0]), static_cast<double>(v[1]),
                               static_cast<double>(v[2])};
          outside = std::max(outside, length(transformPoint(transform, vertex) - centre) - sphere.radius);
        }
      }
    }
    return outside;
  }

  void checkGround(std::uint32_t page, const std::vector<Placement>& placed, Report& report) const {
    for (const Placement& placement : placed) {
      if (!placement.on_ground) continue;
      const auto ground = groundHeight(*ground_, placement.latitude, placement.longitude);
      if (!ground.ok()) {
        addError(report, ground.error());
        continue;
      }
      if (!ground.value()) {
        report.add(
            makeIssue(IssueCode::kPlacementGround,
                      fmt::format("instance {} follows the ground, and there is none", placement.instance),
                      whereInstance(page, placement)));
        continue;
      }
      const double off = std::abs(*ground.value() + placement.above_ground - placement.height);
      if (off <= kPlacementGroundTolerance) continue;
      report.add(makeIssue(
          IssueCode::kPlacementGround,
          fmt::format("instance {} stands {:.3f} m from where the ground puts it", placement.instance, off),
          whereInstance(page, placement), off));
    }
  }

  IssueLocation whereInstance(std::uint32_t page, const Placement& placement) const {
    IssueLocation where = whereBlock(*placements_.file, page);
    where.latitude = placement.latitude;
    where.longitude = placement.longitude;
    return where;
  }

  CheckContext& context_;
  CheckedPlacements& placements_;
  EllipsoidShape ellipsoid_;
  std::optional<Database> ground_;
};

// Pages with placements that name models, and instance numbers given once.
void checkRecords(CheckContext& context, const CheckedPlacements& placements) {
  const PlacementDirectory& directory = placements.directory;
  std::vector<std::vector<std::uint32_t>> numbers(directory.pages.size());
  parallelReport(context.report, numbers.size(), 4, [&](std::size_t item, Report& report) {
    const auto page = static_cast<std::uint32_t>(item);
    const auto placed = placementsOn(context, placements, page, true, report);
    if (!placed) return;
    const std::size_t expected =
        std::min<std::size_t>(kPlacementsPerPage, directory.count - item * kPlacementsPerPage);
    const IssueLocation where = whereBlock(*placements.file, page);
    if (placed->size() != expected) {
      report.add(makeIssue(IssueCode::kPlacementRecord,
                           fmt::format("the page has {} placements, not {}", placed->size(), expected),
                           where));
    }
    for (const Placement& placement : *placed) {
      numbers[item].push_back(placement.instance);
      if (placement.instance < directory.next_instance) continue;
      report.add(makeIssue(IssueCode::kPlacementRecord,
                           fmt::format("instance {} has a number not given yet; the next is {}",
                                       placement.instance, directory.next_instance),
                           where));
    }
  });
  // By number, then page.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
  for (std::uint32_t page = 0; page < numbers.size(); ++page) {
    for (const std::uint32_t number : numbers[page]) all.emplace_back(number, page);
  }
  std::sort(all.begin(), all.end());
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k].first != all[k - 1].first) continue;
    addLazily(context.report, IssueCode::kPlacementRecord, 0, [&] {
      return makeIssue(IssueCode::kPlacementRecord,
                       fmt::format("instance {} stands on page {} and again on page {}", all[k].first,
                                   all[k - 1].second, all[k].second),
                       whereBlock(*placements.file, all[k].second));
    });
  }
}

}  // namespace

void checkPlacementRecords(CheckContext& context) {
  for (CheckedFile& file : context.listed) {
    if (file.reference.role != FileRole::kPlacements || !file.container || context.placements) continue;
    const std::uint32_t blocks = file.container->blockCount();
    if (blocks == 0) {
      IssueLocation where;
      where.file = file.reference.name;
      context.report.add(makeIssue(IssueCode::kPlacementRecord, "the file has no directory", where));
      return;
    }
    const auto bytes = readBlock(file, blocks - 1, BlockType::kPlacementDirectory,
                                 IssueCode::kPlacementRecord, context.report);
    if (bytes) {
      auto directory = decodePlacementDirectory(*bytes, blocks, file.container->path());
      if (directory.ok()) {
        context.placements = CheckedPlacements{&file, std::move(directory).value()};
        return checkRecords(context, *context.placements);
      }
      addError(context.report, directory.error(), whereBlock(file, blocks - 1));
    }
    addSkipped(context.report, "the placements of models, whose directory could not be read");
    return;
  }
}

void checkPlacedModels(CheckContext& context) {
  if (context.placements) PlacedModelRule(context).run();
}

}  // namespace deltaz
