#include "librender/raster/sample_shader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/sample_shader.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_SAMPLE_SHADER_ONCE
#define DELTAZ_SAMPLE_SHADER_ONCE
namespace deltaz {
namespace {

// What is known of the samples of a batch on the way.
struct BatchLists {
  template <typename T>
  using List = SampleBatch::List<T>;

  alignas(64) List<double> x, y, z, sea_u, face_u;    // of the rays; where they meet sea and face
  alignas(64) List<double> inverse_u, second, third;  // planes at the sample; 0: there is no face
  alignas(64) List<double> column, row;  // planes at the sample, then places from the first vertex
  alignas(64) List<double> column_j, row_j, inverse_u_j, column_i, row_i, inverse_u_i;  // gradients
  alignas(64) List<double> size;                                                        // of pixels, in posts
  alignas(64) List<float> weight[3];
  alignas(64) float light[4 * (SampleBatch::kMost + kVectorPadding)];  // red, green, blue, intensity
};

constexpr double kTileTexels = kColorTileTexels;

// 2 to the power of a level of detail, or its inverse.
inline double powerOfTwo(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using DoubleTag = hn::CappedTag<double, 8>;
using Doubles = hn::Vec<DoubleTag>;
constexpr DoubleTag kDouble;
constexpr std::size_t kDoubleLanes = hn::MaxLanes(DoubleTag());
using HalfTag = hn::Rebind<float, DoubleTag>;
constexpr HalfTag kHalf;

// ViewTransform::ray, operation by operation.
void makeRays(const ViewTransform& view, const SampleBatch& batch, BatchLists& lists) {
  const auto tangent = [&](Doubles pixel, double centre) {
    return hn::Div(hn::Sub(pixel, hn::Set(kDouble, centre)), hn::Set(kDouble, view.pixels));
  };
  // Mostly all samples are of one row of the picture.
  Doubles row = hn::Load(kDouble, batch.i), down = tangent(row, view.centre_i);
  for (std::size_t n = 0; n < batch.count; n += kDoubleLanes) {
    const Doubles to_right = tangent(hn::Load(kDouble, batch.j + n), view.centre_j);
    const Doubles own_row = hn::Load(kDouble, batch.i + n);
    if (!hn::AllTrue(kDouble, hn::Eq(own_row, row))) {
      row = own_row;
      down = tangent(row, view.centre_i);
    }
    const auto along = [&](double forward, double of_right, double of_down) {
      return hn::Add(hn::Add(hn::Set(kDouble, forward), hn::Mul(hn::Set(kDouble, of_right), to_right)),
                     hn::Mul(hn::Set(kDouble, of_down), down));
    };
    hn::Store(along(view.forward.x, view.right.x, view.down.x), kDouble, lists.x + n);
    hn::Store(along(view.forward.y, view.right.y, view.down.y), kDouble, lists.y + n);
    hn::Store(along(view.forward.z, view.right.z, view.down.z), kDouble, lists.z + n);
  }
}

HWY_INLINE void evaluateAt(const FaceLanes& face, double dj, double di, double* at) {
  const Doubles from_anchor_j = hn::Set(kDouble, dj), from_anchor_i = hn::Set(kDouble, di);
  for (std::size_t lane = 0; lane < kFaceLanes; lane += kDoubleLanes) {
    const Doubles change = hn::Add(hn::Mul(hn::Load(kDouble, face.per_j + lane), from_anchor_j),
                                   hn::Mul(hn::Load(kDouble, face.per_i + lane), from_anchor_i));
    hn::Store(hn::Add(hn::Load(kDouble, face.value + lane), change), kDouble, at + lane);
  }
}

// The planes of each sample's face, evaluated a sample at a time, since neighbours have different faces.
template <bool kTextured>
void evaluatePlanes(const SampleBatch& batch, BatchLists& lists) {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const FaceLanes* const face = batch.face[n];
    if (face == nullptr) {
      lists.inverse_u[n] = lists.second[n] = lists.third[n] = 0;
      if constexpr (kTextured) lists.column[n] = lists.row[n] = 0;
      continue;
    }
    alignas(64) double at[kFaceLanes];
    double dj = batch.j[n] - face->anchor_j, di = batch.i[n] - face->anchor_i;
    evaluateAt(*face, dj, di, at);
    // Weights are below zero beside the face.
    if (std::min({at[kSecondWeight], at[kThirdWeight],
                  at[kInverseU] - at[kSecondWeight] - at[kThirdWeight]}) < 0) {
      moveInside(*face, dj, di);
      evaluateAt(*face, dj, di, at);
    }
    lists.inverse_u[n] = std::min(std::max(at[kInverseU], face->least), face->greatest);
    lists.second[n] = at[kSecondWeight];
    lists.third[n] = at[kThirdWeight];
    if constexpr (kTextured) {
      lists.column[n] = at[kColumn];
      lists.row[n] = at[kRow];
      lists.column_j[n] = face->per_j[kColumn];
      lists.row_j[n] = face->per_j[kRow];
      lists.inverse_u_j[n] = face->per_j[kInverseU];
      lists.column_i[n] = face->per_i[kColumn];
      lists.row_i[n] = face->per_i[kRow];
      lists.inverse_u_i[n] = face->per_i[kInverseU];
    }
  }
}

// Depths; weights within the face, as the depth is; places and sizes of pixels in the grid.
template <bool kTextured>
void makePerspective(SampleBatch& batch, BatchLists& lists) {
  const Doubles zero = hn::Zero(kDouble), one = hn::Set(kDouble, 1.0);
  for (std::size_t n = 0; n < batch.count; n += kDoubleLanes) {
    const Doubles inverse_u = hn::Load(kDouble, lists.inverse_u + n);
    const Doubles sea_u = hn::Load(kDouble, lists.sea_u + n);
    const auto is_face = hn::Gt(inverse_u, zero);
    const Doubles u = hn::Div(one, inverse_u);
    hn::Store(u, kDouble, lists.face_u + n);
    hn::Store(hn::IfThenElse(hn::And(is_face, hn::Le(u, sea_u)), u, sea_u), kDouble, batch.u + n);

    const auto within = [&](const double* plane) {
      return hn::Min(hn::Max(hn::Mul(hn::Load(kDouble, plane + n), u), zero), one);
    };
    Doubles second = within(lists.second), third = within(lists.third);
    const Doubles sum = hn::Add(second, third);
    const auto beyond = hn::Gt(sum, one);
    if (!hn::AllFalse(kDouble, beyond)) {
      second = hn::IfThenElse(beyond, hn::Div(second, sum), second);
      third = hn::IfThenElse(beyond, hn::Div(third, sum), third);
    }
    const Doubles first = hn::Max(zero, hn::Sub(hn::Sub(one, second), third));
    hn::Store(hn::DemoteTo(kHalf, first), kHalf, lists.weight[0] + n);
    hn::Store(hn::DemoteTo(kHalf, second), kHalf, lists.weight[1] + n);
    hn::Store(hn::DemoteTo(kHalf, third), kHalf, lists.weight[2] + n);

    if constexpr (kTextured) {
      const Doubles column = hn::Mul(hn::Load(kDouble, lists.column + n), u);
      const Doubles row = hn::Mul(hn::Load(kDouble, lists.row + n), u);
      hn::Store(column, kDouble, lists.column + n);
      hn::Store(row, kDouble, lists.row + n);
      const auto squared_step = [&](const double* columns, const double* rows, const double* inverse) {
        const Doubles gradient = hn::Load(kDouble, inverse + n);
        const auto step = [&](const double* plane, Doubles place) {
          return hn::Mul(hn::Sub(hn::Load(kDouble, plane + n), hn::Mul(place, gradient)), u);
        };
        const Doubles of_column = step(columns, column), of_row = step(rows, row);
        return hn::Add(hn::Mul(of_column, of_column), hn::Mul(of_row, of_row));
      };
      const Doubles per_j = squared_step(lists.column_j, lists.row_j, lists.inverse_u_j);
      const Doubles per_i = squared_step(lists.column_i, lists.row_i, lists.inverse_u_i);
      hn::Store(hn::Sqrt(hn::Max(per_j, per_i)), kDouble, lists.size + n);
    }
  }
}

using FourTag = hn::CappedTag<float, 4>;
constexpr FourTag kFour;
constexpr std::size_t kFourLanes = hn::MaxLanes(FourTag());
using FourPart = hn::Vec<FourTag>;

// Of four floats at `to`, all or as many as fit into a vector at a time: combine(offset).
template <typename Combine>
HWY_INLINE void setFour(float* to, const Combine& combine) {
  for (std::size_t k = 0; k < 4; k += kFourLanes) hn::Store(combine(k), kFour, to + k);
}
HWY_INLINE FourPart mixed(FourPart a, FourPart rest, FourPart b, FourPart t) {
  return hn::Add(hn::Mul(a, rest), hn::Mul(b, t));
}

// The four texels around a place, and how far it is from the first towards the others.
struct Taps {
  const float* texels = nullptr;  // nullptr: no tile
  float x = 0, y = 0;
};

HWY_INLINE FourPart bilinear(const Taps& taps, std::size_t k) {
  const FourPart x = hn::Set(kFour, taps.x), y = hn::Set(kFour, taps.y), one = hn::Set(kFour, 1.0F);
  const FourPart rest_x = hn::Sub(one, x), rest_y = hn::Sub(one, y);
  const float* const south = taps.texels + k;
  const float* const north = south + 4 * kColorTileSide;
  return mixed(mixed(hn::LoadU(kFour, south), rest_x, hn::LoadU(kFour, south + 4), x), rest_y,
               mixed(hn::LoadU(kFour, north), rest_x, hn::LoadU(kFour, north + 4), x), y);
}

// Where a place lies in the tile that serves it at a level.
HWY_INLINE Taps tapsAt(GridMapping& mapping, TextureStore& textures, double column, double row, int level) {
  LastSquare& last = mapping.last[static_cast<std::size_t>(level & 1)];
  const double texels_per_post = mapping.texels_per_post * powerOfTwo(-level);
  double x = column * texels_per_post, y = row * texels_per_post;
  if (!(last.known && last.level == level && x >= last.west && x < last.west + kTileTexels &&
        y >= last.south && y < last.south + kTileTexels)) {
    const auto node = [](double texel) {
      return static_cast<std::int32_t>(
          std::clamp(std::floor(texel / kTileTexels), -2147483648.0, 2147483647.0));
    };
    const TextureSquare square{mapping.grid, static_cast<std::int8_t>(level), node(x), node(y)};
    last = {true, level, square.x * kTileTexels, square.y * kTileTexels, textures.find(square)};
  }
  if (last.tile == nullptr) return {};
  double west = last.west, south = last.south;
  if (last.tile->square.level != level) {
    const double coarser = powerOfTwo(level - last.tile->square.level);
    x *= coarser;
    y *= coarser;
    west = last.tile->square.x * kTileTexels;
    south = last.tile->square.y * kTileTexels;
  }
  // Texel centres lie half a texel inside; the tile's border is texel -1.
  const auto tap = [](double texel, std::ptrdiff_t& index) {
    const double from_border = std::clamp(texel + 0.5, 0.0, kTileTexels + 0.5);
    index = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(from_border), kColorTileTexels);
    return static_cast<float>(std::min(from_border - static_cast<double>(index), 1.0));
  };
  std::ptrdiff_t column_index = 0, row_index = 0;
  Taps taps;
  taps.x = tap(x - west, column_index);
  taps.y = tap(y - south, row_index);
  taps.texels = last.tile->linear.data() + 4 * (row_index * kColorTileSide + column_index);
  return taps;
}

// The colour map's light and cover where the sample is; false if it has none there.
HWY_INLINE bool sampleMap(GridMapping& mapping, TextureStore& textures, const FaceLanes& face, double column,
                          double row, double size, float* out) {
  const double at_column = face.column + std::min(std::max(column, static_cast<double>(face.least_column)),
                                                  static_cast<double>(face.greatest_column));
  const double at_row = face.row + std::min(std::max(row, static_cast<double>(face.least_row)),
                                            static_cast<double>(face.greatest_row));
  // A place that is not known is not equal to itself.
  if (!(at_column - at_column == 0 && at_row - at_row == 0)) return false;
  const double texels = size * mapping.texels_per_post * mapping.footprint;
  int level = mapping.coarsest;
  float t = 0;
  if (texels < powerOfTwo(mapping.finest)) {
    level = mapping.finest;
  } else if (texels < powerOfTwo(mapping.coarsest)) {
    const auto bits = std::bit_cast<std::uint64_t>(texels);
    level = static_cast<int>(bits >> 52) - 1023;
    constexpr std::uint64_t kFraction = (std::uint64_t{1} << 52) - 1;
    t = static_cast<float>(std::bit_cast<double>((bits & kFraction) | std::uint64_t{1023} << 52) - 1);
  }
  const Taps fine = tapsAt(mapping, textures, at_column, at_row, level);
  if (!(t > 0)) {
    if (fine.texels == nullptr) return false;
    setFour(out, [&](std::size_t k) { return bilinear(fine, k); });
    return true;
  }
  const Taps coarse = tapsAt(mapping, textures, at_column, at_row, level + 1);
  if (fine.texels == nullptr && coarse.texels == nullptr) return false;
  const FourPart share = hn::Set(kFour, t), rest = hn::Set(kFour, 1 - t);
  setFour(out, [&](std::size_t k) {
    const FourPart zero = hn::Zero(kFour);
    return mixed(fine.texels != nullptr ? bilinear(fine, k) : zero, rest,
                 coarse.texels != nullptr ? bilinear(coarse, k) : zero, share);
  });
  return true;
}

// Light of the samples that show a face.
template <bool kTextured>
void lightFaces(const SampleBatch& batch, std::span<GridMapping> mappings, TextureStore& textures,
                BatchLists& lists) {
  for (std::size_t n = 0; n < batch.count; ++n) {
    const FaceLanes* const face = batch.face[n];
    float* const light = lists.light + 4 * n;
    if (face == nullptr) {
      setFour(light, [](std::size_t) { return hn::Zero(kFour); });
      continue;
    }
    const FourPart first = hn::Set(kFour, lists.weight[0][n]), second = hn::Set(kFour, lists.weight[1][n]);
    const FourPart third = hn::Set(kFour, lists.weight[2][n]);
    setFour(light, [&](std::size_t k) {
      return hn::Add(hn::Add(hn::Mul(hn::Load(kFour, face->color[0] + k), first),
                             hn::Mul(hn::Load(kFour, face->color[1] + k), second)),
                     hn::Mul(hn::Load(kFour, face->color[2] + k), third));
    });
    if constexpr (kTextured) {
      if (face->surface != Surface::kTerrain || face->grid >= mappings.size()) continue;
      GridMapping& mapping = mappings[face->grid];
      alignas(16) float texture[4];
      if (!mapping.textured ||
          !sampleMap(mapping, textures, *face, lists.column[n], lists.row[n], lists.size[n], texture))
        continue;
      const FourPart uncovered = hn::Set(kFour, 1 - texture[3]), intensity = hn::Set(kFour, light[3]);
      setFour(light, [&](std::size_t k) {
        return mixed(hn::Load(kFour, light + k), uncovered, hn::Load(kFour, texture + k), intensity);
      });
    }
  }
}

void placeSamples(SampleBatch& batch, bool textured, BatchLists& lists) {
  if (textured) {
    evaluatePlanes<true>(batch, lists);
    makePerspective<true>(batch, lists);
  } else {
    evaluatePlanes<false>(batch, lists);
    makePerspective<false>(batch, lists);
  }
}

void lightSamples(SampleBatch& batch, std::span<GridMapping> mappings, TextureStore& textures,
                  BatchLists& lists) {
  if (mappings.empty()) {
    lightFaces<false>(batch, mappings, textures, lists);
  } else {
    lightFaces<true>(batch, mappings, textures, lists);
  }

  for (std::size_t n = 0; n < batch.count; n += kDoubleLanes) {
    hn::Vec<HalfTag> red, green, blue, intensity;
    hn::LoadInterleaved4(kHalf, lists.light + 4 * n, red, green, blue, intensity);
    hn::Store(hn::PromoteTo(kDouble, red), kDouble, batch.red + n);
    hn::Store(hn::PromoteTo(kDouble, green), kDouble, batch.green + n);
    hn::Store(hn::PromoteTo(kDouble, blue), kDouble, batch.blue + n);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(makeRays);
HWY_EXPORT(placeSamples);
HWY_EXPORT(lightSamples);

}  // namespace

SampleShader::SampleShader(const Environment& environment, TextureStore& textures, double footprint)
    : environment_(environment), textures_(textures) {
  const ColorMap* const map = textures.map();
  if (map == nullptr) return;
  for (const ColorTree& tree : map->directory().trees) {
    if (tree.grid >= mappings_.size()) mappings_.resize(tree.grid + std::size_t{1});
    GridMapping& mapping = mappings_[tree.grid];
    mapping.textured = true;
    mapping.grid = tree.grid;
    mapping.finest = tree.finest_level;
    mapping.coarsest = tree.coarsest_level;
    mapping.footprint = footprint;
    mapping.texels_per_post = 1 / colorTexelCells(map->leafCells(tree.grid), 0);
  }
}

void SampleShader::shade(SampleBatch& batch) {
  // What is behind the last sample is computed with the others: let it be one of them, that shows nothing
  // new.
  constexpr std::size_t kWidest = kVectorPadding;
  for (std::size_t n = batch.count; n % kWidest != 0; ++n) {
    batch.j[n] = batch.j[n - 1];
    batch.i[n] = batch.i[n - 1];
    batch.face[n] = batch.face[n - 1];
  }
  const std::size_t count = batch.count;
  batch.count = (count + kWidest - 1) / kWidest * kWidest;
  BatchLists lists;
  HWY_DYNAMIC_DISPATCH(makeRays)(environment_.view, batch, lists);
  const RayLists rays{lists.x, lists.y, lists.z, batch.count};
  environment_.sea.depths(rays, lists.sea_u);
  HWY_DYNAMIC_DISPATCH(placeSamples)(batch, !mappings_.empty(), lists);

  bool any_face = false, any_sea = false, any_sky = false;
  for (std::size_t n = 0; n < batch.count; ++n) {
    const FaceLanes* const face = batch.face[n];
    if (face != nullptr && lists.face_u[n] <= lists.sea_u[n]) {
      batch.surface[n] = face->surface;
      any_face = true;
      continue;
    }
    batch.face[n] = nullptr;
    const bool sea = lists.sea_u[n] < std::numeric_limits<double>::infinity();
    batch.surface[n] = sea ? Surface::kSea : Surface::kSky;
    any_sea = any_sea || sea;
    any_sky = any_sky || !sea;
  }
  const ColorLists colors{batch.red, batch.green, batch.blue};
  alignas(64) SampleBatch::List<double> red, green, blue;
  const ColorLists other{red, green, blue};
  const auto take = [&](Surface surface) {
    for (std::size_t n = 0; n < batch.count; ++n) {
      if (batch.surface[n] != surface) continue;
      batch.red[n] = red[n];
      batch.green[n] = green[n];
      batch.blue[n] = blue[n];
    }
  };
  if (any_face) HWY_DYNAMIC_DISPATCH(lightSamples)(batch, mappings_, textures_, lists);
  if (any_sea && !any_face) {
    environment_.sea.colors(rays, lists.sea_u, colors);
  } else if (any_sea) {
    environment_.sea.colors(rays, lists.sea_u, other);
    take(Surface::kSea);
  }
  if (any_face || any_sea) environment_.atmosphere.throughHaze(rays, batch.u, colors);
  if (any_sky) {
    environment_.atmosphere.skies(rays, other);
    take(Surface::kSky);
  }
  batch.count = count;
}

}  // namespace deltaz
#endif
