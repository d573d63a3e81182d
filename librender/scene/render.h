// The one interface of the engines: a database and a view in, a picture and its statistics out.
// Three engines stand behind it; each validates the others. `fast` is the product, `reference` the judge
// (double precision, every full-resolution triangle), `ars` the model of a machine of 1983.
//
// Guarantees: the same picture for any thread count. Errors: whatever reading the database reports; kUsage
// for views that make no sense. Thread-safety: several renders of one database may run at once.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/error.h"
#include "libdb/access/database.h"
#include "librender/antialias/filter.h"
#include "librender/ars/engine/ars_options.h"
#include "librender/scene/camera.h"
#include "librender/scene/pose.h"
#include "librender/scene/report_schedule.h"
#include "librender/scene/transform_kind.h"

namespace deltaz {

namespace ars {
struct Frame;
}

struct Sun {
  double azimuth = 225;   // degrees clockwise from north, seen from the centre of the area
  double elevation = 40;  // degrees above the horizon
};

// How coarse the terrain may be: by its errors, or by range (report_schedule.h), which bounds nothing and
// leaves cracks, to compare with. The reference knows neither.
enum class LodScheme : std::uint8_t { kError, kReport };

inline constexpr std::string_view kNoColorMap = "none";

struct RenderOptions {
  Camera camera;
  Sun sun;
  double tolerance = 1.0;  // pixels; 0 draws full resolution; of models alone with LodScheme::kReport
  LodScheme lod = LodScheme::kError;
  ReportLod report_lod;
  // Of terrain posts. All but exact leave cracks between nodes, of the size of their error
  // (objects/transform_posts.h). The reference is always exact.
  TransformKind transform = TransformKind::kExact;
  // Antialiasing. Depth, surface and triangle of a picture are those of the face that the sample nearest to
  // the pixel's centre shows; depth is that of the face's plane at the centre, within the face's own range.
  Sampling sampling;
  ArsOptions ars;  // of that engine alone
  // >= 0: draw this level, of terrain and of models, whatever the tolerance (tests and benches).
  int fixed_level = -1;
  int threads = 0;  // 0: as many as the machine has
  // Name of the colour map; empty for the database's first, kNoColorMap (or no map at all) for colours by
  // rule (libdb/access/synthetic_color.h), which also show where a map has no cover.
  std::string color_map;
  std::vector<PartPose> poses;  // parts of models that do not stand as they do by default
  bool keep_triangle_ids = false;
  // For tests of culling: false draws the nodes that cannot be seen, too.
  bool cull = true;
  // The same of what nearer things hide. Only the fast engine with LodScheme::kError and the exact transform
  // leaves that out.
  bool occlusion = true;
};

// What covers a pixel.
enum class Surface : std::uint8_t { kSky = 0, kSea = 1, kTerrain = 2, kModel = 3 };

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 bytes a pixel, sRGB, row by row from the top
  std::vector<float> depth;       // U, metres along the view axis; +infinity for sky
  std::vector<Surface> surface;
  std::vector<std::uint64_t>
      triangle;  // only with keep_triangle_ids: node record number << 32 | cell << 1 | (1 for the top face);
                 // of a model: instance << 32 | triangle of the drawn mesh
};

// What is counted is counted once, for one reason (conservation.h).
struct FrameStatistics {
  // Of the quadtrees: visited is the sum of the others. Empty nodes have no heights or lie under another
  // grid; opened ones may be seen and gave way to their children.
  struct Nodes {
    std::uint64_t visited = 0, out_of_view = 0, beyond_horizon = 0, facing_away = 0, occluded = 0, drawn = 0;
    std::uint64_t empty = 0, opened = 0;
  } nodes;
  // What became of the full-resolution triangles of all nodes that have heights, before a post was read: by
  // the fate of the node above them. `coarser` are those that coarser levels spared.
  struct FullResolution {
    std::uint64_t out_of_view = 0, beyond_horizon = 0, facing_away = 0, occluded = 0, coarser = 0, drawn = 0;
    std::uint64_t sum() const {
      return out_of_view + beyond_horizon + facing_away + occluded + coarser + drawn;
    }
  } full_resolution;
  // Placed models: those read from the file, those of them that no part of shows in the picture, those whose
  // parts in the picture are all hidden by ground, and those drawn, part or whole. A page of placements that
  // is out of view is not read.
  struct Models {
    std::uint64_t visited = 0, out_of_view = 0, occluded = 0, drawn = 0;  // visited = sum of the others
  } models;
  struct Triangles {
    std::uint64_t in = 0, back_facing = 0, clipped = 0, no_sample = 0, drawn = 0;  // in = sum of the others
    std::uint64_t hidden = 0;  // of those drawn: behind all there was before any of their samples was tested
  } triangles;
  // With LodScheme::kReport: the terrain objects of the nodes drawn, and their faces before back ones are
  // removed, each object's under its (finer) level; those of the coarser level of objects drawn twice.
  struct Objects {
    std::uint64_t out_of_view = 0, drawn = 0, drawn_twice = 0;
    std::array<std::uint64_t, kReportLevels> faces{};
    std::uint64_t faces_twice = 0;

    Objects& operator+=(const Objects& other);
  } objects;
  struct Samples {
    std::uint64_t tested = 0, written = 0, shaded = 0;
  } samples;
  std::uint64_t bytes_read = 0;
  std::uint64_t posts_decoded = 0;
  std::uint64_t color_tiles = 0;      // of the colour map, seen
  int level = 0, coarsest_level = 0;  // of detail, drawn: the finest and the coarsest
  double projected_error = 0;         // pixels, bound of what is drawn; infinity: none
  double transform_error = 0;         // pixels, what of that a transform other than exact may add
  double depth_complexity = 0;        // samples tested per covered pixel
  struct Milliseconds {
    double schedule = 0, read = 0, objects = 0, raster = 0, resolve = 0, total = 0;
  } milliseconds;
  std::shared_ptr<const ars::Frame> ars;  // what the machine did (ars/engine/ars_frame.h), of that engine
};

class Engine {
 public:
  virtual ~Engine() = default;
  virtual Result<Picture> render(const Database& database, const RenderOptions& options,
                                 FrameStatistics& statistics) const = 0;
};

enum class EngineKind : std::uint8_t { kFast, kReference, kArs };
std::unique_ptr<Engine> makeEngine(EngineKind kind);

}  // namespace deltaz
