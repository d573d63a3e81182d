#include "librender/raster/resolver.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>

#include "librender/raster/texture_sampler.h"

namespace deltaz {
namespace {

struct Shade {
  LinearColor color;     // lit, by rule
  double intensity = 0;  // of the light
};

// The vertices' colours weighted in perspective; the weights are kept within the face, as the depth is.
Shade shadeAt(const FacePlanes& face, int j, int i, double u) {
  const double dj = j - face.anchor_j, di = i - face.anchor_i;
  double second = std::clamp(face.weight1.at(dj, di) * u, 0.0, 1.0);
  double third = std::clamp(face.weight2.at(dj, di) * u, 0.0, 1.0);
  const double sum = second + third;
  if (sum > 1) {
    second /= sum;
    third /= sum;
  }
  const double first = std::max(0.0, 1 - second - third);
  const auto channel = [&](std::size_t c) {
    return first * static_cast<double>(face.color[0][c]) + second * static_cast<double>(face.color[1][c]) +
           third * static_cast<double>(face.color[2][c]);
  };
  return {{channel(0), channel(1), channel(2)},
          first * static_cast<double>(face.intensity[0]) + second * static_cast<double>(face.intensity[1]) +
              third * static_cast<double>(face.intensity[2])};
}

// The face seen through a pixel; none where it is empty or the sea, at `sea_u`, is nearer.
struct Seen {
  bool covered = false;  // by some face, behind the sea or not
  const FacePlanes* face = nullptr;
  std::uint16_t grid = 0;
  double inverse_u = 0, u = 0;
};

Seen seenAt(const TiledFrame& frame, int j, int i, double sea_u) {
  const auto tile = static_cast<std::size_t>(i / kTileSide) * static_cast<std::size_t>(frame.across) +
                    static_cast<std::size_t>(j / kTileSide);
  const SettledTile::Seen nearest = frame.tiles[tile].at(j % kTileSide, i % kTileSide);
  if (nearest.face == nullptr) return {};
  const double inverse_u = nearest.face->inverseDepthAt(j, i), u = 1 / inverse_u;
  Seen seen;
  seen.covered = true;
  if (u <= sea_u) {
    seen.face = nearest.face;
    seen.grid = nearest.grid;
    seen.inverse_u = inverse_u;
    seen.u = u;
  }
  return seen;
}

std::optional<TextureRequest> requestAt(const Environment& environment, const Seen& seen, int j, int i) {
  if (environment.color_map == nullptr || seen.face->surface != Surface::kTerrain) return std::nullopt;
  return textureRequest(*environment.color_map, seen.grid, footprintAt(*seen.face, j, i, seen.inverse_u));
}

void sortUnique(std::vector<TextureSquare>& squares) {
  std::sort(squares.begin(), squares.end());
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
}

}  // namespace

std::vector<TextureSquare> visibleSquares(const Environment& environment, const TiledFrame& frame) {
  std::vector<TextureSquare> squares;
  if (environment.color_map == nullptr) return squares;
  std::vector<std::vector<TextureSquare>> of_row(static_cast<std::size_t>(frame.height));
  tbb::parallel_for(0, frame.height, [&](int i) {
    std::vector<TextureSquare>& wanted = of_row[static_cast<std::size_t>(i)];
    // Neighbouring pixels mostly want the same two squares, one of an even level.
    std::array<std::optional<TextureSquare>, 2> last;
    const auto want = [&](const TextureSquare& square) {
      std::optional<TextureSquare>& of_parity = last[square.level & 1];
      if (of_parity != square) wanted.push_back(square);
      of_parity = square;
    };
    for (int j = 0; j < frame.width; ++j) {
      const Seen seen = seenAt(frame, j, i, environment.sea.depth(environment.view.ray(j, i)));
      if (seen.face == nullptr) continue;
      const std::optional<TextureRequest> request = requestAt(environment, seen, j, i);
      if (!request) continue;
      want(request->fine);
      if (request->t > 0) want(request->coarse);
    }
    sortUnique(wanted);
  });
  for (const std::vector<TextureSquare>& row : of_row) squares.insert(squares.end(), row.begin(), row.end());
  sortUnique(squares);
  return squares;
}

ResolverStatistics resolve(const Environment& environment, const TiledFrame& frame,
                           const TextureStore& textures, Picture& picture) {
  std::vector<ResolverStatistics> of_row(static_cast<std::size_t>(frame.height));
  tbb::parallel_for(0, frame.height, [&](int i) {
    ResolverStatistics counts;
    TextureReader reader(textures);
    for (int j = 0; j < frame.width; ++j) {
      const std::size_t pixel =
          static_cast<std::size_t>(i) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(j);
      const Vector3 ray = environment.view.ray(j, i);
      const double sea_u = environment.sea.depth(ray);
      const Seen seen = seenAt(frame, j, i, sea_u);
      counts.covered += seen.covered ? 1 : 0;
      if (seen.face != nullptr) {
        ++counts.shaded;
        const Shade shade = shadeAt(*seen.face, j, i, seen.u);
        LinearColor color = shade.color;
        if (const auto request = requestAt(environment, seen, j, i)) {
          const TextureSample texture = trilinearSample(reader, *request);
          color = color * (1 - texture.cover) + texture.color * shade.intensity;
        }
        storePixel(environment, ray, seen.face->surface, seen.u, color, pixel, picture);
        if (!picture.triangle.empty()) picture.triangle[pixel] = seen.face->identity;
        continue;
      }
      if (sea_u < std::numeric_limits<double>::infinity()) {
        storePixel(environment, ray, Surface::kSea, sea_u, environment.sea.color(ray, sea_u), pixel, picture);
      } else {
        storePixel(environment, ray, Surface::kSky, sea_u, environment.atmosphere.sky(ray), pixel, picture);
      }
    }
    of_row[static_cast<std::size_t>(i)] = counts;
  });
  ResolverStatistics sum;
  for (const ResolverStatistics& counts : of_row) {
    sum.covered += counts.covered;
    sum.shaded += counts.shaded;
  }
  return sum;
}

}  // namespace deltaz
