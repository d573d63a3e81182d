// Run time against error: draws views with every setting of the knobs that trade one for the other, and
// measures both. Nothing of the error is estimated: the geometry is held against the full-resolution surface
// (shown_displacement.h), the colours against a better picture (picture_error.h).
//
// Frames are timed in rounds, every setting once a round, so that what else the machine does meets all alike.
// The first round warms the caches and is not counted. Pictures, and so all errors, are the same for any
// number of threads; times are of this machine and this moment. Errors: those of rendering and reading.
// Thread-safety: one thread a sweep.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "librender/scene/render.h"
#include "librender/sweep/pareto_front.h"
#include "librender/sweep/picture_error.h"
#include "librender/sweep/shown_displacement.h"
#include "librender/sweep/spread.h"

namespace deltaz {

struct SweepView {
  std::string name;
  Camera camera;
};

struct SweepSetting {
  std::size_t database = 0;  // index into what is swept; 0 is the user's own, the others are made of it
  double tolerance = 1;      // pixels; with LodScheme::kReport of models alone
  LodScheme lod = LodScheme::kError;
  TransformKind transform = TransformKind::kExact;
  int samples = 1;  // a pixel
};

struct SweepRequest {
  std::vector<SweepView> views;
  std::vector<SweepSetting> settings;
  // Sun, colour map, poses, pattern and filter of samples, and threads of every frame; its camera and its
  // knobs are not used.
  RenderOptions common;
  // Of the picture that others are held against: pixels, and samples a pixel.
  double reference_tolerance = 0;
  int reference_samples = 1;
  int repeats = 5;  // rounds that are timed, >= 1
  // Called before each frame with the fraction done; may be empty.
  std::function<void(double fraction)> progress = {};
};

// One setting, in one view or in all of them.
struct SweepRow {
  SweepSetting setting;
  Spread milliseconds;  // of a frame; of all views: the means of the views' values
  ShownDisplacement displacement;
  PictureError picture;
  FrameStatistics statistics;  // of the first frame; of all views: only the sums of what is counted
};

struct SweepOfView {
  SweepView view;
  std::vector<SweepRow> rows;  // in the order of the settings
};

// Pre: at least one database, view, setting; settings name databases there are.
Result<std::vector<SweepOfView>> sweep(std::span<const Database* const> databases,
                                       const SweepRequest& request);

// The same settings over all views: the mean time, the worst displacement, the pictures as if they were one.
std::vector<SweepRow> overAllViews(std::span<const SweepOfView> views);

// What a front is drawn over.
enum class SweepMeasure : std::uint8_t {
  kDisplacement,  // pixels, ShownDisplacement::largest
  kPicture,       // root mean square difference of the colours, of 255
};
double errorOf(const SweepRow& row, SweepMeasure measure);

// Indices of the rows worth having, the cheapest first.
std::vector<std::size_t> frontOf(std::span<const SweepRow> rows, SweepMeasure measure);

}  // namespace deltaz
