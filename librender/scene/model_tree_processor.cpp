#include "librender/scene/model_tree_processor.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <utility>

#include "libdb/access/model.h"
#include "librender/scene/posed_tree.h"
#include "librender/scene/scheduler.h"
#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

// More than the rounding of Earth-centred coordinates, metres.
constexpr double kRounding = 1e-6;

// A placement on its way through the queue.
struct Instance {
  std::uint32_t number = 0, model = 0;
  const PosedTree* tree = nullptr;
  ModelTransform to_earth{};  // of model space
  Sphere sphere;              // around all of it, Earth-centred
  bool drawn = false;
};

class ModelTreeProcessor {
 public:
  ModelTreeProcessor(const ModelScene& scene, const PoseTable& poses, const ViewTransform& view,
                     const ModelTreeOptions& options, FrameStatistics::Models& statistics)
      : scene_(scene),
        poses_(poses),
        view_(view),
        options_(options),
        statistics_(statistics),
        volume_(view) {}

  Result<ModelSchedule> run() {
    DELTAZ_TRY_ASSIGN(const double reach, reachOfMotions());
    for (std::uint32_t page = 0; page < scene_.pages.size(); ++page) {
      const PlacementSphere& sphere = scene_.pages[page];
      if (!outside({{sphere.centre[0], sphere.centre[1], sphere.centre[2]}, sphere.radius + reach}))
        queue_.push_back({Kind::kPage, page, 0});
    }
    while (!queue_.empty()) {
      const Entry entry = queue_.front();
      queue_.pop_front();
      if (entry.kind == Kind::kPage) {
        DELTAZ_TRY(processPage(entry.index));
      } else if (entry.kind == Kind::kPlacement) {
        processPlacement(entry.index);
      } else {
        processPart(entry.index, entry.part);
      }
    }
    statistics_.out_of_view = statistics_.visited - statistics_.drawn;
    std::sort(schedule_.parts.begin(), schedule_.parts.end(), [](const DrawnPart& a, const DrawnPart& b) {
      return std::pair(a.instance, a.part) < std::pair(b.instance, b.part);
    });
    return std::move(schedule_);
  }

 private:
  enum class Kind : std::uint8_t { kPage, kPlacement, kPart };
  struct Entry {
    Kind kind;
    std::uint32_t index;  // of the page, or of the instance
    std::uint32_t part;
  };

  bool outside(const Sphere& sphere) const {
    return options_.cull && (sphere.empty() || volume_.isOutside(sphere.centre, sphere.radius + kRounding));
  }

  Result<const PosedTree*> treeOf(std::uint32_t model, std::uint32_t variant) {
    auto found = trees_.find({model, variant});
    if (found == trees_.end()) {
      DELTAZ_TRY_ASSIGN(PosedTree tree, posedTree(*scene_.trees[model], poses_, model, variant));
      found = trees_.emplace(std::pair(model, variant), std::move(tree)).first;
    }
    return &found->second;
  }

  // In model space, around all parts as they stand by default.
  Sphere defaultSphere(std::uint32_t model) const {
    const ModelTree& tree = *scene_.trees[model];
    return {{tree.centre[0], tree.centre[1], tree.centre[2]}, tree.radius};
  }

  // How far motions bring anything out of the sphere its model has by default, metres.
  Result<double> reachOfMotions() {
    double reach = 0;
    for (const auto& [model, variant] : poses_.posedVariants()) {
      DELTAZ_TRY_ASSIGN(const PosedTree* const tree, treeOf(model, variant));
      const Sphere &posed = tree->subtree[0], standing = defaultSphere(model);
      if (!posed.empty())
        reach = std::max(reach, length(posed.centre - standing.centre) + posed.radius - standing.radius);
    }
    return reach;
  }

  Status processPage(std::uint32_t page) {
    DELTAZ_TRY_ASSIGN(const std::vector<Placement> placements, scene_.read_page(page));
    for (const Placement& placement : placements) {
      ++statistics_.visited;
      const std::uint32_t variant = poses_.variant(placement.model, placement.instance);
      Instance instance;
      instance.number = placement.instance;
      instance.model = placement.model;
      DELTAZ_TRY_ASSIGN(instance.tree, treeOf(placement.model, variant));
      instance.to_earth =
          placementTransform(placement, scene_.trees[placement.model]->anchor, scene_.ellipsoid);
      instance.sphere = transformed(
          poses_.posed(placement.model, variant) ? instance.tree->subtree[0] : defaultSphere(placement.model),
          instance.to_earth);
      queue_.push_back({Kind::kPlacement, static_cast<std::uint32_t>(instances_.size()), 0});
      instances_.push_back(instance);
    }
    return Success{};
  }

  void processPlacement(std::uint32_t index) {
    if (!outside(instances_[index].sphere)) queue_.push_back({Kind::kPart, index, 0});
  }

  void processPart(std::uint32_t index, std::uint32_t number) {
    Instance& instance = instances_[index];
    const PosedTree& tree = *instance.tree;
    if (outside(transformed(tree.subtree[number], instance.to_earth))) return;
    const ModelPart& part = scene_.trees[instance.model]->parts[number];
    if (!part.lods.empty()) {
      const Sphere sphere = transformed(tree.own[number], instance.to_earth);
      if (!outside(sphere)) {
        double error = 0;
        const std::uint32_t lod = levelOf(part, sphere, largestStretch(tree.to_model[number]), error);
        schedule_.parts.push_back({instance.number, instance.model, number, lod,
                                   concatenate(tree.to_model[number], instance.to_earth), sphere.centre,
                                   sphere.radius});
        schedule_.projected_error = std::max(schedule_.projected_error, error);
        if (!instance.drawn) ++statistics_.drawn;
        instance.drawn = true;
      }
    }
    for (const std::uint32_t child : tree.children[number]) queue_.push_back({Kind::kPart, index, child});
  }

  // The level of detail to draw; `projected` becomes the bound of its error in pixels.
  std::uint32_t levelOf(const ModelPart& part, const Sphere& sphere, double stretch,
                        double& projected) const {
    const auto bound = [&](std::uint32_t lod) {
      return projectedErrorBound(view_, sphere.centre, sphere.radius,
                                 static_cast<double>(part.lods[lod].error) * stretch);
    };
    const auto coarsest = static_cast<std::uint32_t>(part.lods.size() - 1);
    std::uint32_t lod = 0;
    if (options_.fixed_level >= 0) {
      lod = std::min(static_cast<std::uint32_t>(options_.fixed_level), coarsest);
    } else if (options_.tolerance > 0) {
      for (lod = coarsest; lod > 0 && !(bound(lod) <= options_.tolerance);) --lod;
    }
    projected = bound(lod);
    return lod;
  }

  const ModelScene& scene_;
  const PoseTable& poses_;
  const ViewTransform& view_;
  const ModelTreeOptions& options_;
  FrameStatistics::Models& statistics_;
  ViewVolume volume_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, PosedTree> trees_;  // by model and variant
  std::vector<Instance> instances_;
  std::deque<Entry> queue_;
  ModelSchedule schedule_;
};

}  // namespace

ModelScene modelSceneOf(const Database& database) {
  ModelScene scene;
  scene.ellipsoid = database.area().grids.front().ellipsoid;
  for (const Model& model : database.models()) scene.trees.push_back(&model.tree());
  if (const PlacementSet* placements = database.placements()) {
    scene.pages = placements->directory().pages;
    scene.read_page = [placements](std::uint32_t page) { return placements->page(page); };
  }
  return scene;
}

Result<ModelSchedule> processModelTrees(const ModelScene& scene, const PoseTable& poses,
                                        const ViewTransform& view, const ModelTreeOptions& options,
                                        FrameStatistics::Models& statistics) {
  return ModelTreeProcessor(scene, poses, view, options, statistics).run();
}

}  // namespace deltaz
