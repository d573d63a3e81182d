#include "librender/objects/terrain_shading.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "libdb/access/synthetic_color.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/objects/terrain_shading.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_TERRAIN_SHADING_ROW
#define DELTAZ_TERRAIN_SHADING_ROW
namespace deltaz {
namespace {

// What naturalColors asks of one row's posts, padded.
struct SurfaceRow {
  std::vector<double> upness, poleward, snow_line;
};

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

struct Vectors {
  V x, y, z;
};

Vectors loadVectors(const VectorLists& lists, std::size_t k) {
  const D d;
  return {hn::LoadU(d, &lists.x[k]), hn::LoadU(d, &lists.y[k]), hn::LoadU(d, &lists.z[k])};
}
V dotOf(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

void intensities(const VectorLists& normals, const Light& light, double* intensity) {
  const D d;
  const Vectors sun{hn::Set(d, light.to_sun.x), hn::Set(d, light.to_sun.y), hn::Set(d, light.to_sun.z)};
  const V ambient = hn::Set(d, light.ambient), diffuse = hn::Set(d, light.diffuse);
  for (std::size_t k = 0; k < normals.count(); k += hn::Lanes(d)) {
    const V cosine = dotOf(sun, loadVectors(normals, k));
    hn::StoreU(
        hn::IfThenElse(hn::Gt(cosine, hn::Zero(d)), hn::Add(ambient, hn::Mul(diffuse, cosine)), ambient), d,
        intensity + k);
  }
}

// North lies in the plane of the axis and the vertical; at a pole it is what it is on the prime meridian.
void geodeticSurfaceRow(const TilePosts& posts, const VectorLists& normals, int j, SurfaceRow& row) {
  const D d;
  const RowConstants& constants = posts.rows()[static_cast<std::size_t>(j) + 1].at;
  const auto columns = static_cast<std::size_t>(posts.tile().columns);
  const std::size_t first = static_cast<std::size_t>(j) * columns;
  const V b = hn::Set(d, constants.b), s = hn::Set(d, constants.s), minus_s = hn::Set(d, -constants.s);
  const V sign = hn::Set(d, constants.s < 0 ? -1.0 : 1.0);
  const bool pole = !(constants.b > 0);
  for (std::size_t i = 0; i < columns; i += hn::Lanes(d)) {
    const V cosine = hn::LoadU(d, &posts.columns().cosine[i + 1]);
    const V sine = hn::LoadU(d, &posts.columns().sine[i + 1]);
    const Vectors normal = loadVectors(normals, first + i);
    const Vectors up{hn::Mul(b, cosine), hn::Mul(b, sine), s};
    const Vectors north{pole ? minus_s : hn::Mul(minus_s, cosine),
                        pole ? hn::Zero(d) : hn::Mul(minus_s, sine), b};
    hn::StoreU(dotOf(normal, up), d, &row.upness[i]);
    hn::StoreU(hn::Mul(sign, dotOf(normal, north)), d, &row.poleward[i]);
  }
}

void projectedSurfaceRow(const TilePosts& posts, const VectorLists& normals, int j, SurfaceRow& row) {
  const D d;
  const auto columns = static_cast<std::size_t>(posts.tile().columns);
  const std::size_t first = static_cast<std::size_t>(j) * columns, place = posts.tile().index(0, j);
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0);
  for (std::size_t i = 0; i < columns; i += hn::Lanes(d)) {
    const Vectors normal = loadVectors(normals, first + i), up = loadVectors(posts.ups(), place + i);
    const V across = hn::Sqrt(hn::Add(hn::Mul(up.x, up.x), hn::Mul(up.y, up.y)));
    const auto pole = hn::Not(hn::Gt(across, zero));
    const V scale = hn::Div(hn::Neg(up.z), across);
    const Vectors north{hn::IfThenElse(pole, hn::Neg(up.z), hn::Mul(scale, up.x)),
                        hn::IfThenElse(pole, zero, hn::Mul(scale, up.y)), across};
    const V sign = hn::IfThenElse(hn::Lt(up.z, zero), hn::Neg(one), one);
    hn::StoreU(dotOf(normal, up), d, &row.upness[i]);
    hn::StoreU(hn::Mul(sign, dotOf(normal, north)), d, &row.poleward[i]);
  }
}

void scaleRow(const double* scale, std::size_t count, const ColorLists& colors) {
  const D d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V factor = hn::LoadU(d, scale + i);
    for (double* list : {colors.red, colors.green, colors.blue})
      hn::StoreU(hn::Mul(hn::LoadU(d, list + i), factor), d, list + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(intensities);
HWY_EXPORT(geodeticSurfaceRow);
HWY_EXPORT(projectedSurfaceRow);
HWY_EXPORT(scaleRow);

// Of one row's posts. On a geodetic grid a row has one latitude.
void snowLines(const TilePosts& posts, int j, std::vector<double>& snow_line) {
  const TerrainTile& tile = posts.tile();
  if (posts.isGeodetic()) {
    const double latitude = posts.geometry().latitude((tile.first_row + j) * (std::int64_t{1} << tile.level));
    std::fill(snow_line.begin(), snow_line.end(), snowLine(latitude));
    return;
  }
  for (int i = 0; i < tile.columns; ++i) {
    const Vector3 up = posts.ups().at(tile.index(i, j));
    const double latitude =
        std::atan2(up.z, std::sqrt(up.x * up.x + up.y * up.y)) * (180.0 / std::numbers::pi);
    snow_line[static_cast<std::size_t>(i)] = snowLine(latitude);
  }
}

}  // namespace

void terrainIntensity(const VectorLists& normals, const Light& light, std::vector<double>& intensity) {
  resizePadded(intensity, normals.count());
  HWY_DYNAMIC_DISPATCH(intensities)(normals, light, intensity.data());
  resizePadded(intensity, normals.count());
}

void terrainColors(const TilePosts& posts, const VectorLists& normals, const std::vector<double>& intensity,
                   PostColors& colors) {
  const TerrainTile& tile = posts.tile();
  const auto columns = static_cast<std::size_t>(tile.columns);
  thread_local SurfaceRow row;
  for (std::vector<double>* list : {&row.upness, &row.poleward, &row.snow_line}) resizePadded(*list, columns);
  for (std::vector<double>* list : {&colors.red, &colors.green, &colors.blue})
    resizePadded(*list, normals.count());
  for (int j = 0; j < tile.rows; ++j) {
    if (posts.isGeodetic()) {
      HWY_DYNAMIC_DISPATCH(geodeticSurfaceRow)(posts, normals, j, row);
    } else {
      HWY_DYNAMIC_DISPATCH(projectedSurfaceRow)(posts, normals, j, row);
    }
    snowLines(posts, j, row.snow_line);
    const std::size_t first = static_cast<std::size_t>(j) * columns;
    const ColorLists out{&colors.red[first], &colors.green[first], &colors.blue[first]};
    naturalColors({posts.heights().data() + tile.index(0, j), row.upness.data(), row.poleward.data(),
                   row.snow_line.data()},
                  columns, out);
    HWY_DYNAMIC_DISPATCH(scaleRow)(intensity.data() + first, columns, out);
  }
  // Whole vectors were written.
  for (std::vector<double>* list : {&colors.red, &colors.green, &colors.blue})
    resizePadded(*list, normals.count());
}

}  // namespace deltaz
#endif
