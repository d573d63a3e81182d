#include "librender/antialias/sample_resolver.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <vector>

#include "librender/antialias/pixel_filter.h"
#include "librender/antialias/pixel_fragments.h"
#include "librender/raster/sample_shader.h"

namespace deltaz {
namespace {

// A row of pixels of a tile: what its fragments make of it.
struct PixelRow {
  std::array<double, kTileSide> red{}, green{}, blue{};  // the means of the pixels' samples
  // Of the fragment that the sample nearest to the pixel's centre belongs to.
  std::array<double, kTileSide> u{};
  std::array<Surface, kTileSide> surface{};
  std::array<const FaceLanes*, kTileSide> face{};
  std::array<bool, kTileSide> mixed{};  // of several fragments
};

// What a worker keeps from tile to tile.
struct Worker {
  Worker(const Environment& environment, TextureStore& textures, const Sampling& sampling)
      : shader(environment, textures, samplesAcross(sampling.count)), gatherer(environment, sampling) {}
  SampleShader shader;
  FragmentGatherer gatherer;
  SampleBatch batch;
  std::vector<FaceLanes> faces;
  std::vector<Fragment> fragments;
  PixelRow row;
  ResolverStatistics counts;
};

class SampleResolver {
 public:
  SampleResolver(const Environment& environment, const TiledFrame& frame, const Sampling& sampling,
                 Picture& picture)
      : environment_(environment),
        frame_(frame),
        sampling_(sampling),
        grid_(sampling),
        central_(std::uint64_t{1} << centralSample(samplePlaces(sampling.count, sampling.pattern))),
        picture_(picture) {
    for (int n = 1; n <= sampling.count; ++n)
      share_[static_cast<std::size_t>(n)] = static_cast<double>(n) / sampling.count;
    if (sampling.filter != FilterKind::kBox)
      colors_ = std::make_unique<MeanColors>(picture.width, picture.height);
  }

  // Tiles of one row of tiles, which have rows of pixels in common, follow each other.
  void resolveTiles(const ViewTransform& view, std::span<const PretiledNode> nodes, int tile_i,
                    Worker& worker) {
    for (int tile_j = 0; tile_j < frame_.across; ++tile_j) resolveTile(view, nodes, tile_j, tile_i, worker);
  }

  void filter() {
    if (colors_ == nullptr) return;
    const PixelFilter filter(sampling_);
    tbb::parallel_for(0, picture_.height, [&](int i) {
      const auto width = static_cast<std::size_t>(picture_.width);
      std::vector<float> sums(3 * width);
      filter.filterRow(*colors_, i,
                       {std::span(sums).subspan(0, width), std::span(sums).subspan(width, width),
                        std::span(sums).subspan(2 * width, width)});
      const std::vector<double> linear(sums.begin(), sums.end());
      encodeSrgb(linear.data(), linear.data() + width, linear.data() + 2 * width, width,
                 &picture_.rgb[3 * static_cast<std::size_t>(i) * width]);
    });
  }

 private:
  void resolveTile(const ViewTransform& view, std::span<const PretiledNode> nodes, int tile_j, int tile_i,
                   Worker& worker) {
    const SettledTile& tile = frame_.tiles[static_cast<std::size_t>(tile_i * frame_.across + tile_j)];
    makeFaceLanes(view, nodes, tile.faces(), worker.faces);
    worker.gatherer.enter(tile, worker.faces, tile_j, tile_i);
    const int side = kTileSide / grid_.across();
    const int columns = std::min(side, picture_.width - tile_j * side);
    const int rows = std::min(side, picture_.height - tile_i * side);
    for (int row = 0; row < rows; ++row) {
      worker.fragments.clear();
      worker.counts.covered += worker.gatherer.gatherRow(row, columns, worker.fragments);
      const int i = tile_i * side + row;
      shadeRow(worker, tile_j * side, i);
      storeRow(worker.row, tile_j * side, columns, i);
    }
  }

  // Of the fragments of a row of pixels, the first of them pixel (first_j, i) of the picture.
  void shadeRow(Worker& worker, int first_j, int i) {
    SampleBatch& batch = worker.batch;
    PixelRow& row = worker.row;
    const std::span<const Fragment> fragments = worker.fragments;
    std::int32_t last_column = -1;
    for (std::size_t first = 0; first < fragments.size(); first += SampleBatch::kMost) {
      batch.count = std::min(SampleBatch::kMost, fragments.size() - first);
      for (std::size_t n = 0; n < batch.count; ++n) {
        const Fragment& fragment = fragments[first + n];
        batch.j[n] = fragment.j;
        batch.i[n] = fragment.i;
        batch.face[n] = fragment.face;
      }
      worker.shader.shade(batch);
      for (std::size_t n = 0; n < batch.count; ++n) {
        const Fragment& fragment = fragments[first + n];
        const auto column = static_cast<std::size_t>(fragment.column);
        worker.counts.shaded += batch.face[n] == nullptr ? 0 : 1;
        const double share = share_[fragment.count];
        if (fragment.column != last_column) {
          last_column = fragment.column;
          row.mixed[column] = share != 1;
          row.red[column] = row.green[column] = row.blue[column] = 0;
        }
        row.red[column] += batch.red[n] * share;
        row.green[column] += batch.green[n] * share;
        row.blue[column] += batch.blue[n] * share;
        if ((fragment.samples & central_) != 0) {
          row.u[column] = batch.u[n];
          row.surface[column] = batch.surface[n];
          row.face[column] = batch.face[n];
        }
        if (colors_ != nullptr && share != 1) {
          colors_->mixed[static_cast<std::size_t>(i)].push_back(
              {first_j + fragment.column,
               fragment.samples,
               {static_cast<float>(batch.red[n]), static_cast<float>(batch.green[n]),
                static_cast<float>(batch.blue[n])}});
        }
      }
    }
  }

  void storeRow(const PixelRow& row, int first_j, int columns, int i) {
    const std::size_t first = static_cast<std::size_t>(i) * static_cast<std::size_t>(picture_.width) +
                              static_cast<std::size_t>(first_j);
    for (std::size_t n = 0; n < static_cast<std::size_t>(columns); ++n) {
      const std::size_t pixel = first + n;
      const double u = row.mixed[n] ? depthAtCentre(row.face[n], row.surface[n], row.u[n],
                                                    first_j + static_cast<int>(n), i)
                                    : row.u[n];
      picture_.depth[pixel] = static_cast<float>(u);
      picture_.surface[pixel] = row.surface[n];
      if (!picture_.triangle.empty() && row.face[n] != nullptr)
        picture_.triangle[pixel] = row.face[n]->identity;
    }
    if (colors_ == nullptr) {
      encodeSrgb(row.red.data(), row.green.data(), row.blue.data(), static_cast<std::size_t>(columns),
                 &picture_.rgb[3 * first]);
      return;
    }
    for (std::size_t n = 0; n < static_cast<std::size_t>(columns); ++n) {
      colors_->planes[0][first + n] = static_cast<float>(row.red[n]);
      colors_->planes[1][first + n] = static_cast<float>(row.green[n]);
      colors_->planes[2][first + n] = static_cast<float>(row.blue[n]);
    }
  }

  // Of what a fragment shows, at the middle of the pixel.
  double depthAtCentre(const FaceLanes* seen, Surface surface, double sampled_u, int j, int i) const {
    const double centre_j = grid_.centre(j), centre_i = grid_.centre(i);
    if (seen != nullptr) {
      const FaceLanes& face = *seen;
      const double plane = face.value[kInverseU] + (face.per_j[kInverseU] * (centre_j - face.anchor_j) +
                                                    face.per_i[kInverseU] * (centre_i - face.anchor_i));
      return 1 / std::min(std::max(plane, face.least), face.greatest);
    }
    if (surface == Surface::kSky) return sampled_u;
    const double u = environment_.sea.depth(environment_.view.ray(centre_j, centre_i));
    return u < std::numeric_limits<double>::infinity() ? u : sampled_u;
  }

  const Environment& environment_;
  const TiledFrame& frame_;
  const Sampling sampling_;
  const SampleGrid grid_;
  const std::uint64_t central_;     // the bit of that sample
  std::array<double, 65> share_{};  // of a pixel's samples, by their number
  Picture& picture_;
  std::unique_ptr<MeanColors> colors_;  // where a filter reaches beyond a pixel
};

}  // namespace

ResolverStatistics resolveSamples(const Environment& environment, const TiledFrame& frame,
                                  std::span<const PretiledNode> nodes, const Sampling& sampling,
                                  TextureStore& textures, Picture& picture) {
  tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers(
      [&] { return std::make_unique<Worker>(environment, textures, sampling); });
  SampleResolver resolver(environment, frame, sampling, picture);
  const int down = static_cast<int>(frame.tiles.size()) / frame.across;
  tbb::parallel_for(
      0, down, [&](int tile_i) { resolver.resolveTiles(environment.view, nodes, tile_i, *workers.local()); });
  resolver.filter();
  ResolverStatistics sum;
  for (const std::unique_ptr<Worker>& worker : workers) {
    sum.covered += worker->counts.covered;
    sum.shaded += worker->counts.shaded;
  }
  return sum;
}

}  // namespace deltaz
