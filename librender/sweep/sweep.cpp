#include "librender/sweep/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace deltaz {
namespace {

class Sweeper {
 public:
  Sweeper(std::span<const Database* const> databases, const SweepRequest& request)
      : databases_(databases), request_(request), engine_(makeEngine(EngineKind::kFast)) {
    std::size_t of_view = 1 + request.settings.size() * (1 + static_cast<std::size_t>(request.repeats));
    for (const SweepSetting& setting : request.settings) of_view += setting.samples == 1 ? 0 : 1;
    frames_ = request.views.size() * of_view;
  }

  Result<std::vector<SweepOfView>> run() {
    std::vector<SweepOfView> views;
    for (const SweepView& view : request_.views) {
      DELTAZ_TRY_ASSIGN(SweepOfView swept, sweepView(view));
      views.push_back(std::move(swept));
    }
    return views;
  }

 private:
  Result<Picture> render(const SweepView& view, const SweepSetting& setting, FrameStatistics& statistics) {
    if (request_.progress) request_.progress(static_cast<double>(drawn_++) / static_cast<double>(frames_));
    RenderOptions options = request_.common;
    options.camera = view.camera;
    options.tolerance = setting.tolerance;
    options.lod = setting.lod;
    options.transform = setting.transform;
    options.sampling.count = setting.samples;
    return engine_->render(*databases_[setting.database], options, statistics);
  }

  // Where faces end, depth at the centres of pixels with several samples may be that of a face's plane beyond
  // its edge. The ground is drawn where one sample draws it, so that is measured.
  Result<ShownDisplacement> displacementOf(const SweepView& view, SweepSetting setting,
                                           const Picture& picture) {
    const auto measure = [&](const Picture& shown) {
      return measureShownDisplacement(*databases_.front(), view.camera, shown, request_.common.threads);
    };
    if (setting.samples == 1) return measure(picture);
    setting.samples = 1;
    FrameStatistics unused;
    DELTAZ_TRY_ASSIGN(const Picture of_one, render(view, setting, unused));
    return measure(of_one);
  }

  Result<SweepOfView> sweepView(const SweepView& view) {
    SweepOfView swept{view, {}};
    FrameStatistics unused;
    SweepSetting of_reference;
    of_reference.tolerance = request_.reference_tolerance;
    of_reference.samples = request_.reference_samples;
    DELTAZ_TRY_ASSIGN(const Picture reference, render(view, of_reference, unused));
    for (const SweepSetting& setting : request_.settings) {
      SweepRow row;
      row.setting = setting;
      DELTAZ_TRY_ASSIGN(const Picture picture, render(view, setting, row.statistics));
      DELTAZ_TRY_ASSIGN(row.displacement, displacementOf(view, setting, picture));
      row.picture = comparePictures(picture, reference);
      swept.rows.push_back(row);
    }
    std::vector<std::vector<double>> times(request_.settings.size());
    for (int round = 0; round < request_.repeats; ++round) {
      for (std::size_t k = 0; k < request_.settings.size(); ++k) {
        FrameStatistics statistics;
        DELTAZ_TRY(render(view, request_.settings[k], statistics));
        times[k].push_back(statistics.milliseconds.total);
      }
    }
    for (std::size_t k = 0; k < times.size(); ++k) swept.rows[k].milliseconds = spreadOf(times[k]);
    return swept;
  }

  std::span<const Database* const> databases_;
  const SweepRequest& request_;
  std::unique_ptr<Engine> engine_;
  std::size_t frames_ = 0, drawn_ = 0;
};

// Adds a view's row; `views` is the number of all views.
void add(SweepRow& sum, const SweepRow& row, double views) {
  sum.setting = row.setting;
  sum.milliseconds.minimum += row.milliseconds.minimum / views;
  sum.milliseconds.median += row.milliseconds.median / views;
  sum.milliseconds.maximum += row.milliseconds.maximum / views;
  ShownDisplacement& total = sum.displacement;
  const ShownDisplacement& one = row.displacement;
  const double squares =
      total.root_mean_square * total.root_mean_square * static_cast<double>(total.measured) +
      one.root_mean_square * one.root_mean_square * static_cast<double>(one.measured);
  total.measured += one.measured;
  total.unmeasured += one.unmeasured;
  total.largest = std::max(total.largest, one.largest);
  total.nearly_all = std::max(total.nearly_all, one.nearly_all);
  total.root_mean_square = total.measured > 0 ? std::sqrt(squares / static_cast<double>(total.measured)) : 0;
  sum.picture = joined(sum.picture, row.picture);
  sum.statistics.triangles.drawn += row.statistics.triangles.drawn;
  sum.statistics.triangles.in += row.statistics.triangles.in;
  sum.statistics.bytes_read += row.statistics.bytes_read;
  sum.statistics.posts_decoded += row.statistics.posts_decoded;
  sum.statistics.projected_error = std::max(sum.statistics.projected_error, row.statistics.projected_error);
}

}  // namespace

Result<std::vector<SweepOfView>> sweep(std::span<const Database* const> databases,
                                       const SweepRequest& request) {
  return Sweeper(databases, request).run();
}

std::vector<SweepRow> overAllViews(std::span<const SweepOfView> views) {
  std::vector<SweepRow> rows(views.empty() ? 0 : views.front().rows.size());
  for (const SweepOfView& view : views) {
    for (std::size_t k = 0; k < rows.size(); ++k)
      add(rows[k], view.rows[k], static_cast<double>(views.size()));
  }
  return rows;
}

double errorOf(const SweepRow& row, SweepMeasure measure) {
  return measure == SweepMeasure::kDisplacement ? row.displacement.largest
                                                : std::sqrt(row.picture.mean_square);
}

std::vector<std::size_t> frontOf(std::span<const SweepRow> rows, SweepMeasure measure) {
  std::vector<CostAndError> points;
  for (const SweepRow& row : rows) points.push_back({row.milliseconds.median, errorOf(row, measure)});
  return paretoFront(points);
}

}  // namespace deltaz
