#include "librender/ars/engine/reference_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "librender/ars/engine/frame_stream.h"
#include "librender/ars/tiler/tiler_setup.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "librender/scene/arena.h"
#include "librender/scene/view_volume.h"
#include "librender/sweep/picture_error.h"

namespace deltaz {
namespace {

using ars::kColors;
using ars::ScreenPlane;
using ars::ScreenPosition;

// Pixels: half of one by tolerance, and what rounding moves the box of a triangle with a narrow corner.
constexpr double kLargestReach = 1;

// Distance of a point to a triangle; 0 inside.
double distanceTo(const std::array<ScreenPosition, 3>& corner, double i, double j) {
  double nearest = 1e300;
  int positive = 0, negative = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenPosition &a = corner[k], &b = corner[(k + 1) % 3];
    const double ei = b.i - a.i, ej = b.j - a.j, length = ei * ei + ej * ej;
    const double side = ei * (j - a.j) - ej * (i - a.i);
    positive += side > 0;
    negative += side < 0;
    const double t = length > 0 ? std::clamp(((i - a.i) * ei + (j - a.j) * ej) / length, 0.0, 1.0) : 0;
    nearest = std::min(nearest, std::hypot(i - a.i - t * ei, j - a.j - t * ej));
  }
  return positive == 0 || negative == 0 ? 0 : nearest;
}

// What a triangle of the scene should show at a pixel, and how far the machine's numbers may be from it.
struct Expected {
  double beside = 1e300;  // pixels from the triangle
  bool taken = false;     // by the tiler: within the triangle's edges and their tolerance
  bool inReach() const { return taken && beside <= kLargestReach; }
  // As the one that the machine has drawn.
  bool isBetterThan(const Expected& other) const {
    return taken != other.taken ? taken : beside < other.beside;
  }
  double inverse_u = 0, depth_bound = 0;
  std::array<double, kColors> color{}, color_bound{};
  std::array<bool, kColors> color_fits{};  // no number on the way to it leaves the format
};

class Expectation {
 public:
  Expectation(const ars::SceneTriangles& scene, const Environment& environment, const ArsOptions& options)
      : scene_(scene),
        options_(options),
        numbers_(ars::frameNumbers(options)),
        pretiler_(screenOf(environment)) {}

  // Of the piece of the triangle that the pixel is taken for.
  Expected at(std::size_t triangle, int i, int j) const {
    std::vector<ars::ScreenTriangle> pieces;
    ars::PretilerCounts counts;
    pretiler_.process(scene_.triangles[triangle], pieces, counts);
    Expected best;
    for (const ars::ScreenTriangle& piece : pieces) {
      Expected expected;
      expected.beside = distanceTo(piece.corner, i, j);
      fill(piece, i, j, expected);
      if (expected.isBetterThan(best)) best = expected;
    }
    return best;
  }

 private:
  static ars::ScreenView screenOf(const Environment& environment) {
    const ViewTransform& view = environment.view;
    return {view.centre_i, view.centre_j, view.height, view.width, kHither};
  }

  // Half a unit of each coefficient times its steps, and of each sum.
  static double planeBound(double start, double per_i, double per_j, double di, double dj, int precision) {
    const double unit = std::ldexp(1, -precision);
    const double sum = std::abs(start) + std::abs(per_i * di) + std::abs(per_j * dj);
    return 2 * unit * sum + unit * std::abs(start + per_i * di + per_j * dj);
  }

  void fill(const ars::ScreenTriangle& piece, int i, int j, Expected& expected) const {
    const ars::ScreenPlanes& shared = piece.planes;
    const double from_i = i - shared.anchor.i, from_j = j - shared.anchor.j;
    expected.inverse_u = shared.inverse_u.at(from_i, from_j);
    for (std::size_t c = 0; c < kColors; ++c) {
      expected.color[c] = shared.color[c].at(from_i, from_j);
      ars::ProjectedTriangle projected;
      for (std::size_t k = 0; k < 3; ++k) projected[k] = {piece.corner[k].i, piece.corner[k].j, 0, 0};
      const ars::EncodedTriangle encoded = ars::encodeTriangle(
          projected,
          {shared.anchor.i, shared.anchor.j, shared.inverse_u, shared.color[c], shared.color_over_u[c]},
          numbers_, {options_.oversample, false});
      const ars::TriangleVariables& v = encoded.variables;
      const ars::TilerSetup setup = ars::setUpTriangle(v, {numbers_, options_.tiler.corrections});
      const double di = i - setup.i_start, dj = j - setup.j_start;
      const double largest = numbers_.color.largest();
      expected.color_fits[c] =
          std::max({std::abs(v.color), std::abs(v.color_i * di), std::abs(v.color_j * dj),
                    std::abs(v.color_i), std::abs(v.color_j)}) < largest;
      expected.color_bound[c] =
          0.5 + planeBound(v.color, v.color_i, v.color_j, di, dj, numbers_.color.precision());
      if (c > 0) continue;
      expected.depth_bound =
          planeBound(v.depth, v.depth_i, v.depth_j, di, dj, numbers_.depth_plane.precision()) +
          std::ldexp(std::abs(expected.inverse_u), -numbers_.depth.precision()) +
          // Depths come back as metres in single precision.
          std::ldexp(std::abs(expected.inverse_u), -23);
      expected.taken = takes(setup, i, j);
    }
  }

  // Whether the pixel is within the edges with their tolerances (Table 5), and in the box.
  static bool takes(const ars::TilerSetup& setup, int i, int j) {
    const std::int64_t line = (i - setup.i_start) * setup.i_step, step = (j - setup.j_start) * setup.j_step;
    if (line < 0 || line > setup.lines || step < 0 || step > setup.pixels) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (setup.p_start[k] + line * setup.p_line[k] + step * setup.p_pixel[k] < 0) return false;
    }
    return true;
  }

  const ars::SceneTriangles& scene_;
  const ArsOptions& options_;
  ars::NumberProfile numbers_;
  ars::Pretiler pretiler_;
};

bool covered(const Picture& picture, std::size_t pixel) {
  return picture.surface[pixel] >= Surface::kTerrain;
}

// Whether the outline of what is covered runs within a pixel.
bool isAtEdge(const Picture& picture, int i, int j) {
  bool any = false, all = true;
  for (int ni = std::max(0, i - 1); ni <= std::min(picture.height - 1, i + 1); ++ni) {
    for (int nj = std::max(0, j - 1); nj <= std::min(picture.width - 1, j + 1); ++nj) {
      const bool here =
          covered(picture, static_cast<std::size_t>(ni) * static_cast<std::size_t>(picture.width) +
                               static_cast<std::size_t>(nj));
      any = any || here;
      all = all && here;
    }
  }
  return any && !all;
}

class Comparer {
 public:
  Comparer(const ars::SceneTriangles& scene, const Expectation& expectation, ComparedPictures& result)
      : expectation_(expectation), result_(result) {
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      const Surface surface = t < scene.terrain ? Surface::kTerrain : Surface::kModel;
      names_[surface == Surface::kTerrain].emplace(scene.identity[t], t);
    }
  }

  void compare(int i, int j) {
    const Picture &machine = result_.machine, &reference = result_.reference;
    const std::size_t pixel =
        static_cast<std::size_t>(i) * static_cast<std::size_t>(machine.width) + static_cast<std::size_t>(j);
    ReferenceComparison& counts = result_.comparison;
    ++counts.pixels;
    bool explained = true;
    if (covered(machine, pixel) != covered(reference, pixel)) {
      bool at_edge = isAtEdge(reference, i, j);
      // A triangle that passes between all pixels is an edge, too.
      if (!at_edge && covered(machine, pixel)) {
        const Expected ours = nearest(machine, pixel, i, j);
        at_edge = ours.beside > 0 && ours.inReach();
      }
      ++(at_edge ? counts.coverage_at_edges : counts.coverage_unexplained);
      explained = at_edge;
    } else if (covered(machine, pixel)) {
      const Expected ours = nearest(machine, pixel, i, j);
      explained = compareValues(machine, pixel, ours);
      if (machine.triangle[pixel] != reference.triangle[pixel] ||
          machine.surface[pixel] != reference.surface[pixel]) {
        ++counts.other_triangle;
        explained = compareOrder(ours, nearest(reference, pixel, i, j)) && explained;
      }
    }
    result_.unexplained[pixel] = explained ? 0 : 1;
  }

 private:
  // Of the triangles of the pixel's name (seams and fans share theirs) the one that it belongs to.
  Expected nearest(const Picture& picture, std::size_t pixel, int i, int j) const {
    Expected best;
    const auto [begin, end] =
        names_[picture.surface[pixel] == Surface::kTerrain].equal_range(picture.triangle[pixel]);
    for (auto name = begin; name != end; ++name) {
      const Expected expected = expectation_.at(name->second, i, j);
      if (expected.isBetterThan(best)) best = expected;
    }
    return best;
  }

  bool compareValues(const Picture& machine, std::size_t pixel, const Expected& expected) {
    ReferenceComparison& counts = result_.comparison;
    bool explained = true;
    if (expected.inverse_u > 0) {
      const double error = std::abs(1 / static_cast<double>(machine.depth[pixel]) - expected.inverse_u);
      ++counts.depth_compared;
      counts.largest_depth_share = std::max(counts.largest_depth_share, error / expected.depth_bound);
      if (error > expected.depth_bound) {
        ++counts.depth_unexplained;
        explained = false;
      }
    }
    for (std::size_t c = 0; c < kColors; ++c) {
      if (!expected.color_fits[c]) {
        ++counts.color_out_of_range;
        continue;
      }
      const double error = std::abs(machine.rgb[3 * pixel + c] - std::clamp(expected.color[c], 0.0, 255.0));
      ++counts.color_compared;
      counts.largest_color_error = std::max(counts.largest_color_error, error);
      counts.largest_color_share = std::max(counts.largest_color_share, error / expected.color_bound[c]);
      if (error > expected.color_bound[c]) {
        ++counts.color_unexplained;
        explained = false;
      }
    }
    return explained;
  }

  bool compareOrder(const Expected& ours, const Expected& theirs) {
    ReferenceComparison& counts = result_.comparison;
    if (ours.beside > 0) {
      const bool within = ours.inReach();
      ++(within ? counts.order_beside : counts.order_unexplained);
      return within;
    }
    const bool within = theirs.inverse_u - ours.inverse_u <= ours.depth_bound + theirs.depth_bound;
    ++(within ? counts.order_in_bounds : counts.order_unexplained);
    return within;
  }

  std::array<std::unordered_multimap<std::uint64_t, std::size_t>, 2> names_;
  const Expectation& expectation_;
  ComparedPictures& result_;
};

}  // namespace

Result<ComparedPictures> compareWithReference(const Database& database, const RenderOptions& asked) {
  RenderOptions options = asked;
  options.tolerance = 0;
  options.fixed_level = 0;
  options.keep_triangle_ids = true;
  options.ars.timed = false;
  if (options.camera.width > ars::kScreenPixels || options.camera.height > ars::kScreenLines)
    return usageError("comparison", "the picture is larger than the machine's screen", {},
                      "Ask for 512 x 512 pixels at most");
  if (!options.ars.antialiaser.empty() || options.ars.passes != ars::kColors)
    return usageError("comparison", "only plain pictures in colour are compared", {},
                      "Leave out antialiaser and passes");
  ComparedPictures result;
  FrameStatistics of_machine, of_reference, of_scene;
  DELTAZ_TRY_ASSIGN(result.machine, makeEngine(EngineKind::kArs)->render(database, options, of_machine));
  DELTAZ_TRY_ASSIGN(result.reference,
                    makeEngine(EngineKind::kReference)->render(database, options, of_reference));
  DELTAZ_TRY_ASSIGN(const Environment environment, makeEnvironment(database, options));
  DELTAZ_TRY_ASSIGN(const ars::SceneTriangles scene,
                    ars::sceneTriangles(database, environment, options, of_scene));
  const Expectation expectation(scene, environment, options.ars);
  result.unexplained.assign(result.machine.surface.size(), 0);
  Comparer comparer(scene, expectation, result);
  for (int i = 0; i < result.machine.height; ++i) {
    for (int j = 0; j < result.machine.width; ++j) comparer.compare(i, j);
  }
  result.comparison.peak_signal_to_noise =
      comparePictures(result.machine, result.reference).peakSignalToNoise();
  return result;
}

}  // namespace deltaz
