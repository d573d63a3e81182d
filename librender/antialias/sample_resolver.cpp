#include "librender/antialias/sample_resolver.h"

#include <algorithm>
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

// What a fragment shows.
struct Shaded {
  LinearColor color;
  double u = 0;
  Surface surface = Surface::kSky;
  const FaceLanes* face = nullptr;
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
  std::vector<Shaded> shaded;  // of each fragment
  ResolverStatistics counts;
};

void shadeFragments(Worker& worker) {
  SampleBatch& batch = worker.batch;
  worker.shaded.clear();
  for (std::size_t first = 0; first < worker.fragments.size(); first += SampleBatch::kMost) {
    batch.count = std::min(SampleBatch::kMost, worker.fragments.size() - first);
    for (std::size_t n = 0; n < batch.count; ++n) {
      const Fragment& fragment = worker.fragments[first + n];
      batch.j[n] = fragment.j;
      batch.i[n] = fragment.i;
      batch.face[n] = fragment.face;
    }
    worker.shader.shade(batch);
    for (std::size_t n = 0; n < batch.count; ++n) {
      worker.counts.shaded += batch.face[n] == nullptr ? 0 : 1;
      worker.shaded.push_back(
          {{batch.red[n], batch.green[n], batch.blue[n]}, batch.u[n], batch.surface[n], batch.face[n]});
    }
  }
}

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
      for (std::size_t j = 0; j < width; ++j) {
        for (std::size_t c = 0; c < 3; ++c) {
          picture_.rgb[3 * (static_cast<std::size_t>(i) * width + j) + c] =
              encodeSrgb(static_cast<double>(sums[c * width + j]));
        }
      }
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
      shadeFragments(worker);
      const int i = tile_i * side + row;
      for (std::size_t first = 0; first < worker.fragments.size();) {
        std::size_t end = first + 1;
        while (end < worker.fragments.size() &&
               worker.fragments[end].column == worker.fragments[first].column)
          ++end;
        storePixel(worker, first, end, tile_j * side + worker.fragments[first].column, i);
        first = end;
      }
    }
  }

  // Of the fragments first .. end - 1.
  void storePixel(const Worker& worker, std::size_t first, std::size_t end, int j, int i) {
    const std::size_t pixel =
        static_cast<std::size_t>(i) * static_cast<std::size_t>(picture_.width) + static_cast<std::size_t>(j);
    LinearColor mean = worker.shaded[first].color;
    std::size_t central = first;
    if (end - first > 1) {
      mean = {};
      for (std::size_t n = first; n < end; ++n) {
        const Fragment& fragment = worker.fragments[n];
        mean = mean + worker.shaded[n].color * (static_cast<double>(fragment.count) / sampling_.count);
        if ((fragment.samples & central_) != 0) central = n;
      }
    }
    const Shaded& nearest = worker.shaded[central];
    const double u = end - first > 1 ? depthAtCentre(nearest, j, i) : nearest.u;
    if (!picture_.triangle.empty() && nearest.face != nullptr)
      picture_.triangle[pixel] = nearest.face->identity;
    storeSeen(nearest.surface, u, mean, pixel, picture_);
    if (colors_ == nullptr) return;
    colors_->planes[0][pixel] = static_cast<float>(mean.red);
    colors_->planes[1][pixel] = static_cast<float>(mean.green);
    colors_->planes[2][pixel] = static_cast<float>(mean.blue);
    if (end - first == 1) return;
    for (std::size_t n = first; n < end; ++n) {
      const LinearColor& color = worker.shaded[n].color;
      colors_->mixed[static_cast<std::size_t>(i)].push_back(
          {j,
           worker.fragments[n].samples,
           {static_cast<float>(color.red), static_cast<float>(color.green), static_cast<float>(color.blue)}});
    }
  }

  // Of what a fragment shows, at the middle of the pixel.
  double depthAtCentre(const Shaded& shaded, int j, int i) const {
    const double centre_j = grid_.centre(j), centre_i = grid_.centre(i);
    if (shaded.face != nullptr) {
      const FaceLanes& face = *shaded.face;
      const double plane = face.value[kInverseU] + (face.per_j[kInverseU] * (centre_j - face.anchor_j) +
                                                    face.per_i[kInverseU] * (centre_i - face.anchor_i));
      return 1 / std::min(std::max(plane, face.least), face.greatest);
    }
    if (shaded.surface == Surface::kSky) return shaded.u;
    const double u = environment_.sea.depth(environment_.view.ray(centre_j, centre_i));
    return u < std::numeric_limits<double>::infinity() ? u : shaded.u;
  }

  const Environment& environment_;
  const TiledFrame& frame_;
  const Sampling sampling_;
  const SampleGrid grid_;
  const std::uint64_t central_;  // the bit of that sample
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
