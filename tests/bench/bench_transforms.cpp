// Run time versus error of the four transforms of librender/objects/transform_posts.h.
//   bench_transforms [--smoke | --brief] [--json]
// For leaf sizes (with --brief 64 alone), post spacings, latitudes and eye distances it prints, from one run:
// nanoseconds a post (of making a tile ready, once; and of each frame, post by post as defined and on every
// instruction set of this processor), the frame's time on the widest as a share of exact's, the largest error
// in metres against extended precision beside its proved bound, and the same in pixels of a picture 1920 wide
// with a field of view of 60 degrees, over the posts in that picture; how far apart a post lies that the
// tile's western and eastern half share, each transformed as a tile of its own (the width of a crack); and
// the bytes a post that are kept from frame to frame besides the tile. The eye stands south of the tile's
// middle, 30 degrees above its horizon, and looks northwards, 14 degrees down: the middle is near the
// picture's lower edge, the northern half of the tile above it.
//
// Times: the transforms take turns; of each round the median of several batches counts, and of all rounds the
// least. A line whose error exceeds its bound is marked, and the program ends with 1.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "libdb/access/simd_target.h"
#include "librender/objects/transform_error_bound.h"
#include "librender/scene/view_volume.h"
#include "tests/stress/scalar_transforms.h"
#include "tests/stress/stress_grids.h"
#include "tests/stress/true_positions.h"

namespace deltaz {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;
constexpr double kFieldOfView = 60;  // degrees
constexpr double kRadian = 3.14159265358979323846 / 180;

struct Settings {
  bool smoke = false, json = false, brief = false;
  int rounds = 5, batches = 5;
  double batch_seconds = 1e-3;
};

struct Scene {
  int leaf = 64;
  std::int64_t spacing = 1;  // arc-seconds
  double latitude = 0;       // of the tile's middle, or as near to it as the pole allows
};

struct Times {
  double prepare = std::numeric_limits<double>::infinity();  // nanoseconds a post, once a tile
  // Nanoseconds a post, each frame: post by post, then on each of simdTargets().
  double scalar = std::numeric_limits<double>::infinity();
  std::vector<double> frame;
  double kept = 0;  // bytes a post
};

struct Errors {
  double metres = 0, bound = 0;
  double pixels = 0, pixel_bound = 0;
  double crack = 0;    // metres
  int in_picture = 0;  // posts
};

RawGrid gridOf(const Scene& scene) {
  SyntheticGridOptions options;
  const double extent = scene.leaf * static_cast<double>(scene.spacing) / 3600;
  const double middle = std::min(scene.latitude, 90 - extent / 2);
  // On the lattice of posts, so that the northernmost row is never beyond the pole.
  options.south = std::floor((middle - extent / 2 + 90) * 3600 / static_cast<double>(scene.spacing) + 1e-6) *
                      static_cast<double>(scene.spacing) / 3600 -
                  90;
  options.west = 7;
  options.spacing_latitude = options.spacing_longitude = {scene.spacing, 1};
  options.columns = options.rows = scene.leaf + 1;
  options.lowest = 0;
  // Hills as high as a twentieth of the tile is wide.
  options.highest = static_cast<std::int32_t>(std::min(6000.0, extent * 111000 / 20));
  return syntheticGrid(options);
}

// The eye is `distance` metres from the tile's middle post.
ViewTransform viewOf(const TerrainTile& tile, const GridGeometry& geometry, double distance) {
  const int i = tile.columns / 2, j = tile.rows / 2;
  const GeodeticPoint middle = geometry.geodeticAt(tile.first_column + i, tile.first_row + j);
  const RowConstants row = rowConstants(geometry.header().ellipsoid, middle.latitude);
  const ColumnConstants column = columnConstants(middle.longitude);
  const Vector3 up = upVector(row, column), east{-column.sine, column.cosine, 0}, north = cross(up, east);
  const auto downwards = [&](double degrees) {
    return north * std::cos(degrees * kRadian) - up * std::sin(degrees * kRadian);
  };
  ViewTransform view;
  view.forward = downwards(14);
  view.right = east;
  view.down = cross(view.forward, view.right);
  view.eye = earthCentred(row, column, geometry.metres(tile.height(i, j))) - downwards(30) * distance;
  view.width = kWidth;
  view.height = kHeight;
  view.centre_j = (kWidth - 1) / 2.0;
  view.centre_i = (kHeight - 1) / 2.0;
  view.pixels = kWidth / 2.0 / std::tan(kFieldOfView / 2 * kRadian);
  return view;
}

template <typename Work>
double nanosecondsPerPost(const Settings& settings, std::size_t posts, const Work& work) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> batches;
  for (int batch = 0; batch < settings.batches; ++batch) {
    int runs = 0;
    double seconds = 0;
    const Clock::time_point start = Clock::now();
    do {
      work();
      ++runs;
      seconds = std::chrono::duration<double>(Clock::now() - start).count();
    } while (seconds < settings.batch_seconds);
    batches.push_back(seconds * 1e9 / (static_cast<double>(runs) * static_cast<double>(posts)));
  }
  std::nth_element(batches.begin(), batches.begin() + settings.batches / 2, batches.end());
  return batches[static_cast<std::size_t>(settings.batches) / 2];
}

std::vector<Times> measureTimes(const Settings& settings, const TerrainTile& tile,
                                const GridGeometry& geometry, const ViewTransform& view) {
  const std::vector<SimdTarget> targets = simdTargets();
  std::vector<Times> times(kTransformKinds.size());
  std::vector<Vector3> out;
  ViewPositions lists;
  const std::size_t posts = static_cast<std::size_t>(tile.columns) * static_cast<std::size_t>(tile.rows);
  for (int round = 0; round < settings.rounds; ++round) {
    for (std::size_t k = 0; k < kTransformKinds.size(); ++k) {
      std::optional<TileTransform> ready;
      const double prepare = nanosecondsPerPost(settings, posts, [&] {
        ready.reset();
        ready.emplace(std::move(TileTransform::make(kTransformKinds[k], tile, geometry)).value());
      });
      times[k].prepare = std::min(times[k].prepare, prepare);
      times[k].kept = static_cast<double>(ready->storedBytes()) / static_cast<double>(posts);
      const ScalarTransform scalar(kTransformKinds[k], tile, geometry);
      times[k].scalar =
          std::min(times[k].scalar, nanosecondsPerPost(settings, posts, [&] { scalar.apply(view, out); }));
      times[k].frame.resize(targets.size(), std::numeric_limits<double>::infinity());
      for (std::size_t t = 0; t < targets.size(); ++t) {
        limitSimdTarget(targets[t]);
        times[k].frame[t] = std::min(times[k].frame[t],
                                     nanosecondsPerPost(settings, posts, [&] { ready->apply(view, lists); }));
      }
      limitSimdTarget(std::nullopt);
    }
  }
  return times;
}

// Metres between the two places of a post that the tile's halves share.
double crackOf(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry,
               const ViewTransform& view) {
  const int middle = tile.columns / 2;
  const TerrainTile west = columnsOf(tile, 0, middle + 1),
                    east = columnsOf(tile, middle, tile.columns - middle);
  const std::vector<Vector3> of_west = transformPosts(kind, west, geometry, view).value(),
                             of_east = transformPosts(kind, east, geometry, view).value();
  double widest = 0;
  for (int j = 0; j < tile.rows; ++j) {
    const Vector3 apart = of_west[static_cast<std::size_t>((j + 1) * west.columns - 1)] -
                          of_east[static_cast<std::size_t>(j * east.columns)];
    widest = std::max(widest, std::hypot(apart.x, apart.y / view.pixels, apart.z / view.pixels));
  }
  return widest;
}

Errors measureErrors(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry,
                     const ViewTransform& view, const std::vector<LongVector>& truth) {
  const std::vector<Vector3> positions = transformPosts(kind, tile, geometry, view).value();
  Errors errors;
  errors.bound = transformErrorBound(kind, tile, geometry, view);
  errors.metres = largestError(tile, view, positions, truth);
  errors.crack = crackOf(kind, tile, geometry, view);
  for (std::size_t post = 0; post < truth.size(); ++post) {
    const LongVector t = trueView(view, truth[post]);
    const auto u = static_cast<double>(t.x), v = static_cast<double>(t.y / t.x),
               w = static_cast<double>(t.z / t.x);
    if (u < kHither || std::abs(v) * view.pixels > kWidth / 2.0 || std::abs(w) * view.pixels > kHeight / 2.0)
      continue;
    ++errors.in_picture;
    const Vector3& p = positions[post];
    const double off = p.x > 0 ? std::hypot(p.y / p.x - v * view.pixels, p.z / p.x - w * view.pixels)
                               : std::numeric_limits<double>::infinity();
    errors.pixels = std::max(errors.pixels, off);
    // A displacement of e metres moves the projection of a point at depth u by at most this.
    const double depth = u - errors.bound;
    errors.pixel_bound = std::max(
        errors.pixel_bound, depth > 0 ? view.pixels * errors.bound * std::sqrt(1 + v * v + w * w) / depth
                                      : std::numeric_limits<double>::infinity());
  }
  return errors;
}

std::string jsonNumber(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string("null");
}

class Table {
 public:
  explicit Table(bool json) : json_(json) {
    if (json_) {
      fmt::print("{{\"width\": {}, \"field_of_view\": {}, \"rows\": [", kWidth, kFieldOfView);
      return;
    }
    fmt::print("{:>5} {:>4} {:>6} {:>8} {:<7} {:>8} {:>7}", "leaf", "as", "lat", "eye m", "", "make ns",
               "scalar");
    for (const SimdTarget target : simdTargets()) fmt::print(" {:>8}", simdTargetName(target));
    fmt::print(" {:>7} {:>10} {:>10} {:>10} {:>10} {:>10} {:>5}\n", "share", "error m", "bound m", "error px",
               "bound px", "crack m", "bytes");
  }

  void add(const Scene& scene, double distance, TransformKind kind, const Times& times, double exact_frame,
           const Errors& errors) {
    const bool kept = errors.metres <= errors.bound && errors.pixels <= errors.pixel_bound;
    kept_ = kept_ && kept;
    if (json_) {
      std::string frames;
      const std::vector<SimdTarget> targets = simdTargets();
      for (std::size_t t = 0; t < targets.size(); ++t)
        frames +=
            fmt::format("{}\"{}\": {:.3f}", t == 0 ? "" : ", ", simdTargetName(targets[t]), times.frame[t]);
      fmt::print(
          "{}\n {{\"leaf\": {}, \"spacing_arcseconds\": {}, \"latitude\": {}, \"eye_metres\": {}, "
          "\"transform\": \"{}\", \"prepare_ns\": {:.3f}, \"scalar_ns\": {:.3f}, \"frame_ns\": {{{}}}, "
          "\"share_of_exact\": {:.3f}, \"error_metres\": {}, \"bound_metres\": {}, \"posts_in_picture\": {}, "
          "\"error_pixels\": {}, \"bound_pixels\": {}, \"crack_metres\": {}, \"kept_bytes\": {:.3f}}}",
          first_ ? "" : ",", scene.leaf, scene.spacing, scene.latitude, distance, transformName(kind),
          times.prepare, times.scalar, frames, times.frame.back() / exact_frame, jsonNumber(errors.metres),
          jsonNumber(errors.bound), errors.in_picture, jsonNumber(errors.pixels),
          jsonNumber(errors.pixel_bound), jsonNumber(errors.crack), times.kept);
      first_ = false;
      return;
    }
    fmt::print("{:>5} {:>4} {:>6} {:>8.0e} {:<7} {:>8.2f} {:>7.2f}", scene.leaf, scene.spacing,
               scene.latitude, distance, transformName(kind), times.prepare, times.scalar);
    for (const double frame : times.frame) fmt::print(" {:>8.2f}", frame);
    fmt::print(" {:>6.2f}x {:>10.2e} {:>10.2e} {:>10.2e} {:>10.2e} {:>10.2e} {:>5.1f}{}\n",
               times.frame.back() / exact_frame, errors.metres, errors.bound, errors.pixels,
               errors.pixel_bound, errors.crack, times.kept, kept ? "" : "  BROKEN");
  }

  bool finish() const {
    if (json_) fmt::print("\n]}}\n");
    return kept_;
  }

 private:
  bool json_, first_ = true, kept_ = true;
};

bool run(const Settings& settings) {
  const std::vector<int> leaves = settings.smoke   ? std::vector<int>{16}
                                  : settings.brief ? std::vector<int>{64}
                                                   : std::vector<int>{16, 64, 256};
  const std::vector<std::int64_t> spacings =
      settings.smoke ? std::vector<std::int64_t>{1, 30} : std::vector<std::int64_t>{1, 3, 30};
  const std::vector<double> latitudes = settings.smoke   ? std::vector<double>{45, 89.99}
                                        : settings.brief ? std::vector<double>{0, 45, 89.99}
                                                         : std::vector<double>{0, 45, 60, 85, 89.99};
  Table table(settings.json);
  for (const int leaf : leaves) {
    for (const std::int64_t spacing : spacings) {
      for (const double latitude : latitudes) {
        const Scene scene{leaf, spacing, latitude};
        const RawGrid grid = gridOf(scene);
        const GridGeometry geometry(grid.header);
        const TerrainTile tile = wholeTile(grid);
        const std::vector<LongVector> truth = truePositions(tile, geometry);
        for (const double distance : {10.0, 1e3, 1e5, 1e7}) {
          const ViewTransform view = viewOf(tile, geometry, distance);
          const std::vector<Times> times = measureTimes(settings, tile, geometry, view);
          for (std::size_t k = 0; k < kTransformKinds.size(); ++k) {
            table.add(scene, distance, kTransformKinds[k], times[k], times[0].frame.back(),
                      measureErrors(kTransformKinds[k], tile, geometry, view, truth));
          }
        }
      }
    }
  }
  return table.finish();
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  for (const std::string& argument : std::vector<std::string>(argv + 1, argv + argc)) {
    if (argument == "--smoke") {
      settings.smoke = true;
      settings.rounds = settings.batches = 1;
      settings.batch_seconds = 0;
    } else if (argument == "--brief") {
      settings.brief = true;
    } else if (argument == "--json") {
      settings.json = true;
    } else {
      fmt::print(stderr, "bench_transforms: error: {}: is not an option. Use --smoke, --brief, --json\n",
                 argument);
      return 2;
    }
  }
  return deltaz::run(settings) ? 0 : 1;
}
