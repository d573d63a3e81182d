// What a picture costs in areas of one post spacing that grow: it must depend on what is seen, not on how
// much more there is.
//   bench_growth [--smoke] [--folder FOLDER] [DEM] [REPEATS]
// Builds square areas of 1201, 3601 and 10801 posts a side around the middle of a DEM
// (samples/mt_rainier.tif, voids filled); beyond its borders the DEM goes on as its mirror image. Then the
// same ten views of the middle are drawn in each: three near the ground, three oblique, three straight down
// and one from 200 km. Each looks down as far as it must for every pixel to show ground of the smallest area,
// which is checked. For each view and area: bytes read by opening and the first frame, nodes visited, posts
// decoded, triangles set up, median milliseconds of REPEATS further frames, and milliseconds from open to
// first picture with the page cache dropped; and their ratios to the smallest area. FOLDER keeps the
// databases for the next time.
//
// What grows by kMostGrowth or more is marked, and the program ends with 1: bytes, posts and triangles. Nodes
// visited are only shown, since every level more has some that are opened, and times.
// --smoke: 151, 301 and 601 posts, small pictures; what a node or a page more weighs there says nothing, so
// the program ends with 0.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "libdb/access/ground_query.h"
#include "libdb/build/build_terrain.h"
#include "libdb/source/elevation_source.h"
#include "librender/scene/render.h"
#include "tests/support/temporary_directory.h"

namespace deltaz {
namespace {

constexpr double kMostGrowth = 1.3;

struct Settings {
  bool smoke = false;
  std::string folder, source = DELTAZ_SAMPLES "/mt_rainier.tif";
  int repeats = 9;
  int width = 1280, height = 720;
  std::vector<std::int64_t> sides = {1201, 3601, 10801};
};

// The index of the post that stands at `index` when posts 0 .. count - 1 go on as their mirror image.
std::int64_t mirrored(std::int64_t index, std::int64_t count) {
  const std::int64_t period = 2 * (count - 1);
  const std::int64_t within = ((index % period) + period) % period;
  return std::min(within, period - within);
}

// A square of posts around the middle of `source`.
RawGrid squareAround(const RawGrid& source, std::int64_t side) {
  RawGrid grid;
  grid.header = source.header;
  GridAxis &x = grid.header.x_axis, &y = grid.header.y_axis;
  const std::int64_t west = (x.count - side) / 2, south = (y.count - side) / 2;
  x.first += west;
  y.first += south;
  grid.heights.reserve(static_cast<std::size_t>(side * side));
  for (std::int64_t row = 0; row < side; ++row) {
    for (std::int64_t column = 0; column < side; ++column)
      grid.heights.push_back(source.height(mirrored(west + column, x.count), mirrored(south + row, y.count)));
  }
  x.count = y.count = side;
  for (SourceDescription& description : grid.header.sources) description.columns = description.rows = side;
  return grid;
}

// A view of the middle; its height is over the ground, or over the datum where it is `absolute`.
struct ViewRequest {
  const char* name;
  double x, y;  // of the eye, as a fraction of the smallest area
  double height;
  bool absolute;
  double heading;
  double field_of_view;
};

constexpr std::array<ViewRequest, 10> kViews = {{
    {"2 m above ground, north", 0.50, 0.30, 2, false, 0, 60},
    {"2 m above ground, east", 0.30, 0.55, 2, false, 90, 60},
    {"20 m above ground, west", 0.60, 0.45, 20, false, 270, 60},
    {"500 m, oblique", 0.50, 0.35, 500, false, 10, 60},
    {"1500 m, oblique", 0.45, 0.35, 1500, false, 350, 60},
    {"3000 m, oblique", 0.50, 0.30, 3000, false, 0, 60},
    {"1 km, down", 0.50, 0.50, 1000, false, 0, 60},
    {"5 km, down", 0.45, 0.55, 5000, false, 0, 60},
    {"15 km, down", 0.50, 0.50, 15000, false, 0, 60},
    {"200 km, down", 0.50, 0.50, 200000, true, 0, 10},
}};

// Straight down for what is seen from far above; else as little down as shows nothing but ground.
Result<Camera> cameraFor(const Engine& engine, const Database& smallest, const ViewRequest& request,
                         const Settings& settings) {
  const AreaHeader& area = smallest.area();
  Camera camera;
  camera.eye.latitude = area.south + (area.north - area.south) * request.y;
  camera.eye.longitude = area.west + (area.east - area.west) * request.x;
  DELTAZ_TRY_ASSIGN(const std::optional<double> ground,
                    groundHeight(smallest, camera.eye.latitude, camera.eye.longitude));
  // Smaller areas are looked at from less far.
  const double far = request.height < 100 ? 1 : std::min(1.0, area.north - area.south);
  camera.eye.height = request.height * far + (request.absolute ? 0 : ground.value_or(0));
  camera.heading = request.heading;
  camera.field_of_view = request.field_of_view;
  camera.width = settings.width;
  camera.height = settings.height;
  const bool down = std::string(request.name).ends_with("down");
  for (camera.pitch = down ? -90 : -4; camera.pitch >= -90; camera.pitch -= 2) {
    RenderOptions options;
    options.camera = camera;
    FrameStatistics statistics;
    DELTAZ_TRY_ASSIGN(const Picture picture, engine.render(smallest, options, statistics));
    if (std::all_of(picture.surface.begin(), picture.surface.end(),
                    [](Surface surface) { return surface == Surface::kTerrain; }))
      return camera;
  }
  return usageError(fmt::format("the view '{}' shows more than the smallest area", request.name),
                    "Name a DEM that is larger or has no voids");
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// Asks the system to forget what it holds of a database's files.
void dropFromPageCache(const std::string& folder) {
  const auto names = localFileSystem().list(folder);
  if (!names.ok()) return;
  for (const std::string& name : names.value()) {
    const int file = ::open(joinPath(folder, name).c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) continue;
    static_cast<void>(::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED));
    ::close(file);
  }
}

struct Row {
  FrameStatistics first;  // of the first frame
  std::uint64_t open_bytes = 0;
  double warm = 0, cold = 0;  // milliseconds

  // What must not grow, then what is only shown.
  static constexpr std::size_t kHeld = 4, kCounts = 5, kColumns = 7;
  std::array<double, kColumns> columns() const {
    return {static_cast<double>(open_bytes + first.bytes_read),
            static_cast<double>(open_bytes),
            static_cast<double>(first.posts_decoded),
            static_cast<double>(first.triangles.in),
            static_cast<double>(first.nodes.visited),
            warm,
            cold};
  }
};
constexpr std::array<const char*, Row::kColumns> kHeadings = {
    "bytes", "of them open", "posts decoded", "triangles in", "nodes visited", "warm ms", "cold ms"};

Result<Row> measure(const Engine& engine, const std::string& path, const Camera& camera,
                    const Settings& settings) {
  Row row;
  RenderOptions options;
  options.camera = camera;
  using Clock = std::chrono::steady_clock;
  std::vector<double> cold, warm;
  for (int round = 0; round < std::max(1, settings.repeats / 3); ++round) {
    dropFromPageCache(path);
    const Clock::time_point begin = Clock::now();
    DELTAZ_TRY_ASSIGN(const Database database, Database::open(localFileSystem(), path));
    row.open_bytes = database.bytesRead();
    DELTAZ_TRY_ASSIGN(const Picture picture, engine.render(database, options, row.first));
    cold.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    if (round > 0) continue;
    FrameStatistics again;
    for (int i = 0; i < settings.repeats; ++i) {
      DELTAZ_TRY_ASSIGN(const Picture same, engine.render(database, options, again));
      warm.push_back(again.milliseconds.total);
    }
  }
  row.cold = median(cold);
  row.warm = median(warm);
  return row;
}

// Builds what is not there yet; the paths, smallest area first.
Result<std::vector<std::string>> makeAreas(const Settings& settings, const std::string& folder) {
  std::optional<RawGrid> source;
  std::vector<std::string> paths;
  for (const std::int64_t side : settings.sides) {
    const std::string path = joinPath(folder, fmt::format("growth_{}.dz", side));
    DELTAZ_TRY_ASSIGN(const PathType type, localFileSystem().typeOf(path));
    if (type == PathType::kAbsent) {
      if (!source) {
        SourceOptions options;
        options.voids = VoidPolicy::kFill;
        DELTAZ_TRY_ASSIGN(source, readElevationSource(settings.source, options));
      }
      DELTAZ_TRY_ASSIGN(const BuildSummary summary,
                        buildTerrain(localFileSystem(), squareAround(*source, side), path, {}));
      fmt::print("{}: {} nodes, {} bytes\n", path, summary.nodes, summary.bytes);
      std::fflush(stdout);
    }
    paths.push_back(path);
  }
  return paths;
}

Result<bool> run(const Settings& settings) {
  const TemporaryDirectory temporary;
  DELTAZ_TRY_ASSIGN(const std::vector<std::string> paths,
                    makeAreas(settings, settings.folder.empty() ? temporary.path() : settings.folder));
  const auto engine = makeEngine(EngineKind::kFast);
  DELTAZ_TRY_ASSIGN(const Database smallest, Database::open(localFileSystem(), paths.front()));
  std::array<double, Row::kColumns> worst{}, log_sum{};
  for (const ViewRequest& request : kViews) {
    DELTAZ_TRY_ASSIGN(const Camera camera, cameraFor(*engine, smallest, request, settings));
    fmt::print("\n{}, pitch {}\n{:>12}", request.name, camera.pitch, "posts a side");
    for (const char* heading : kHeadings) fmt::print(" {:>14}", heading);
    fmt::print("\n");
    std::array<double, Row::kColumns> of_smallest{};
    for (std::size_t k = 0; k < paths.size(); ++k) {
      DELTAZ_TRY_ASSIGN(const Row row, measure(*engine, paths[k], camera, settings));
      const auto columns = row.columns();
      if (k == 0) of_smallest = columns;
      fmt::print("{:>12}", settings.sides[k]);
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const double ratio = columns[c] / of_smallest[c];
        worst[c] = std::max(worst[c], ratio);
        if (k + 1 == paths.size()) log_sum[c] += std::log(ratio);
        fmt::print(" {:>8.{}f} {:>4.2f}x", columns[c], c < Row::kCounts ? 0 : 2, ratio);
      }
      fmt::print("\n");
    }
    std::fflush(stdout);
  }
  bool kept = true;
  fmt::print("\nratios to the smallest area\n{:>20} {:>8} {:>14}\n", "", "largest", "mean, largest area");
  for (std::size_t c = 0; c < Row::kColumns; ++c) {
    const bool column_kept = c >= Row::kHeld || worst[c] < kMostGrowth;
    kept = kept && column_kept;
    fmt::print("{:>20} {:>7.3f}x {:>13.3f}x{}\n", kHeadings[c], worst[c],
               std::exp(log_sum[c] / kViews.size()), column_kept ? "" : "  GROWS");
  }
  return kept || settings.smoke;
}

}  // namespace
}  // namespace deltaz

int main(int argc, char** argv) {
  deltaz::Settings settings;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k] == "--smoke") {
      settings.smoke = true;
      settings.sides = {151, 301, 601};
      settings.width = 160;
      settings.height = 90;
      settings.repeats = 1;
    } else if (arguments[k] == "--folder" && k + 1 < arguments.size()) {
      settings.folder = arguments[++k];
    } else if (const int repeats = std::atoi(arguments[k].c_str()); repeats > 0) {
      settings.repeats = repeats;
    } else {
      settings.source = arguments[k];
    }
  }
  const auto kept = deltaz::run(settings);
  if (!kept.ok()) fmt::print(stderr, "bench_growth: error: {}\n", kept.error().message());
  return kept.ok() && kept.value() ? 0 : 1;
}
