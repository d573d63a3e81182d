#include "librender/scene/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "librender/scene/exponential.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/scene/atmosphere.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "librender/scene/exponential-inl.h"

#ifndef DELTAZ_ATMOSPHERE_CONSTANTS
#define DELTAZ_ATMOSPHERE_CONSTANTS
namespace deltaz {
namespace {

constexpr double kMolecularHeight = 8000;  // metres
constexpr double kPerMolecularHeight = 1 / kMolecularHeight;
// The aerosol's layer is a fourth as high, so that its density is the fourth power of the other's.
constexpr double kAerosolRises = 4;
constexpr double kMolecularRed = 2.5e-6;  // 1/m at height 0; green twice, blue four times as much
constexpr double kAerosol = 2.0e-5;       // 1/m at height 0
// Air has a floor, in metres: no dry land lies lower, but facets of a whole globe sag by kilometres, within a
// pixel of the ground they stand for.
constexpr double kLowestGround = -500;
// For nearly equal heights the quotient of differences loses its digits; the mean of both ends differs from
// it by rise^2 / 12.
constexpr double kLevelRise = 1e-4;  // in scale heights of molecules

// Samples whose intermediate results are kept at a time.
constexpr std::size_t kHazeAtOnce = 64;

}  // namespace
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

struct Vectors {
  V x, y, z;
};

V set(double value) {
  const D d;
  return hn::Set(d, value);
}
Vectors loadRays(const RayLists& rays, std::size_t k) {
  const D d;
  return {hn::LoadU(d, rays.x + k), hn::LoadU(d, rays.y + k), hn::LoadU(d, rays.z + k)};
}
V dotOf(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

// Atmosphere::sky, operation by operation.
void skyColors(const AtmosphereTerms& terms, const RayLists& rays, const ColorLists& colors) {
  const D d;
  const V zero = hn::Zero(d), one = set(1.0);
  const Vectors up{set(terms.up.x), set(terms.up.y), set(terms.up.z)};
  for (std::size_t k = 0; k < rays.count; k += hn::Lanes(d)) {
    const Vectors ray = loadRays(rays, k);
    const V elevation =
        hn::Sub(hn::Div(dotOf(ray, up), hn::Sqrt(dotOf(ray, ray))), set(terms.sine_of_horizon));
    const V above =
        hn::Div(hn::Mul(elevation, set(1 + terms.gradient)), hn::Add(elevation, set(terms.gradient)));
    const V t = hn::IfThenElse(hn::Le(elevation, zero), zero, above), s = hn::Sub(one, t);
    const auto store = [&](double haze, double zenith, double* to) {
      hn::StoreU(hn::Add(hn::Mul(set(haze), s), hn::Mul(set(zenith), t)), d, to + k);
    };
    store(terms.haze_color.red, terms.zenith_color.red, colors.red);
    store(terms.haze_color.green, terms.zenith_color.green, colors.green);
    store(terms.haze_color.blue, terms.zenith_color.blue, colors.blue);
  }
}

// Atmosphere::throughHaze, operation by operation. `rays` are at most kHazeAtOnce.
void hazeColors(const AtmosphereTerms& terms, const RayLists& rays, const double* depths,
                const ColorLists& colors) {
  const D d;
  const std::size_t lanes = hn::Lanes(d), count = (rays.count + lanes - 1) / lanes * lanes;
  const double eye_density2 = terms.eye_density * terms.eye_density;
  alignas(64) double lengths[kHazeAtOnce], heights[kHazeAtOnce], densities[kHazeAtOnce];
  alignas(64) double left[2 * kHazeAtOnce];  // of grey and of red light
  for (std::size_t k = 0; k < count; k += lanes) {
    const Vectors ray = loadRays(rays, k);
    const V u = hn::LoadU(d, depths + k);
    hn::StoreU(hn::Mul(hn::Sqrt(dotOf(ray, ray)), u), d, lengths + k);
    const Vectors p{hn::Add(set(terms.eye.x), hn::Mul(ray.x, u)),
                    hn::Add(set(terms.eye.y), hn::Mul(ray.y, u)),
                    hn::Add(set(terms.eye.z), hn::Mul(ray.z, u))};
    const V across2 = hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y)), z2 = hn::Mul(p.z, p.z);
    const V q =
        hn::Add(hn::Mul(across2, set(terms.inverse_a_squared)), hn::Mul(z2, set(terms.inverse_b_squared)));
    const V above =
        hn::Mul(hn::Sqrt(hn::Add(across2, z2)), hn::Sub(set(1.0), hn::Div(set(1.0), hn::Sqrt(q))));
    const V height = hn::Max(set(kLowestGround), above);
    hn::StoreU(height, d, heights + k);
    hn::StoreU(hn::Mul(hn::Neg(height), set(kPerMolecularHeight)), d, densities + k);
  }
  exponentials(d, densities, count);
  for (std::size_t k = 0; k < count; k += lanes) {
    const V distance = hn::LoadU(d, lengths + k), density = hn::LoadU(d, densities + k);
    const V density2 = hn::Mul(density, density), density4 = hn::Mul(density2, density2);
    const V rise =
        hn::Mul(hn::Sub(hn::LoadU(d, heights + k), set(terms.eye_height)), set(kPerMolecularHeight));
    const auto is_level = hn::Lt(hn::Abs(rise), set(kLevelRise));
    const V per_rise = hn::Div(set(1.0), rise);
    const auto mean = [&](double at_eye, V there, V per_own_rise) {
      return hn::IfThenElse(is_level, hn::Mul(hn::Add(set(at_eye), there), set(0.5)),
                            hn::Mul(hn::Sub(set(at_eye), there), per_own_rise));
    };
    const V molecular =
        hn::Mul(hn::Mul(set(kMolecularRed), distance), mean(terms.eye_density, density, per_rise));
    const V aerosol =
        hn::Mul(hn::Mul(set(kAerosol), distance),
                mean(eye_density2 * eye_density2, density4, hn::Mul(per_rise, set(1 / kAerosolRises))));
    hn::StoreU(hn::Neg(aerosol), d, left + k);
    hn::StoreU(hn::Neg(molecular), d, left + count + k);
  }
  exponentials(d, left, 2 * count);
  for (std::size_t k = 0; k < count; k += lanes) {
    const V grey = hn::LoadU(d, left + k), red = hn::LoadU(d, left + count + k);
    const V green = hn::Mul(red, red), blue = hn::Mul(green, green);
    const auto store = [&](double haze, V light, double* color) {
      const V change = hn::Mul(hn::Sub(hn::LoadU(d, color + k), set(haze)), hn::Mul(grey, light));
      hn::StoreU(hn::Add(set(haze), change), d, color + k);
    };
    store(terms.haze_color.red, red, colors.red);
    store(terms.haze_color.green, green, colors.green);
    store(terms.haze_color.blue, blue, colors.blue);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(skyColors);
HWY_EXPORT(hazeColors);

constexpr LinearColor kHaze{0.60, 0.70, 0.82};
constexpr LinearColor kZenith{0.060, 0.170, 0.480};

}  // namespace

Atmosphere::Atmosphere(const EllipsoidShape& ellipsoid, const ViewTransform& view, const Vector3& to_sun) {
  terms_.eye = view.eye;
  const double a = ellipsoid.semi_major_axis;
  const double flattening = ellipsoid.inverse_flattening != 0 ? 1 / ellipsoid.inverse_flattening : 0;
  const double b = a * (1 - flattening);
  terms_.inverse_a_squared = 1 / (a * a);
  terms_.inverse_b_squared = 1 / (b * b);
  const GeodeticPoint eye = toGeodetic(ellipsoid, view.eye);
  terms_.up = upVector(rowConstants(ellipsoid, eye.latitude), columnConstants(eye.longitude));
  terms_.eye_height = heightOf(terms_.eye);
  terms_.eye_density = exponential(-terms_.eye_height * kPerMolecularHeight);
  const double ratio = a / (a + std::max(terms_.eye_height, 0.0));
  terms_.sine_of_horizon = -std::sqrt(1 - ratio * ratio);

  daylight_ = 0.03 + 0.97 * smoothStep(-0.10, 0.25, dot(to_sun, terms_.up));
  terms_.haze_color = kHaze * daylight_;
  // From high up the sky is dark and its bright band thin.
  const double air = std::min(1.0, terms_.eye_density);
  terms_.zenith_color = kZenith * (daylight_ * (0.02 + 0.98 * air));
  terms_.gradient = 0.02 + 0.23 * air;
}

double Atmosphere::heightOf(const Vector3& p) const {
  const double q = (p.x * p.x + p.y * p.y) * terms_.inverse_a_squared + p.z * p.z * terms_.inverse_b_squared;
  // The point scaled to the ellipsoid along its radius is p / sqrt(q).
  return length(p) * (1 - 1 / std::sqrt(q));
}

LinearColor Atmosphere::sky(const Vector3& ray) const {
  const double elevation = dot(ray, terms_.up) / length(ray) - terms_.sine_of_horizon;
  if (elevation <= 0) return terms_.haze_color;
  return mix(terms_.haze_color, terms_.zenith_color,
             elevation * (1 + terms_.gradient) / (elevation + terms_.gradient));
}

LinearColor Atmosphere::throughHaze(const LinearColor& color, const Vector3& ray, double u) const {
  const double distance = length(ray) * u;
  const double height = std::max(kLowestGround, heightOf(terms_.eye + ray * u));
  const double density = exponential(-height * kPerMolecularHeight);
  const double density2 = density * density, eye_density2 = terms_.eye_density * terms_.eye_density;
  // Mean density of a layer between two heights of densities d1, d2, where d = exp(-h / scale).
  const double rise = (height - terms_.eye_height) * kPerMolecularHeight;
  const bool is_level = std::abs(rise) < kLevelRise;
  const double per_rise = 1 / rise;
  const auto mean = [&](double d1, double d2, double per_own_rise) {
    return is_level ? (d1 + d2) * 0.5 : (d1 - d2) * per_own_rise;
  };
  const double molecular = kMolecularRed * distance * mean(terms_.eye_density, density, per_rise);
  const double aerosol =
      kAerosol * distance *
      mean(eye_density2 * eye_density2, density2 * density2, per_rise * (1 / kAerosolRises));
  const double grey = exponential(-aerosol);
  const double red = exponential(-molecular), green = red * red, blue = green * green;
  return {terms_.haze_color.red + (color.red - terms_.haze_color.red) * (grey * red),
          terms_.haze_color.green + (color.green - terms_.haze_color.green) * (grey * green),
          terms_.haze_color.blue + (color.blue - terms_.haze_color.blue) * (grey * blue)};
}

void Atmosphere::skies(const RayLists& rays, const ColorLists& colors) const {
  HWY_DYNAMIC_DISPATCH(skyColors)(terms_, rays, colors);
}

void Atmosphere::throughHaze(const RayLists& rays, const double* u, const ColorLists& colors) const {
  for (std::size_t k = 0; k < rays.count; k += kHazeAtOnce) {
    HWY_DYNAMIC_DISPATCH(hazeColors)
    (terms_, {rays.x + k, rays.y + k, rays.z + k, std::min(kHazeAtOnce, rays.count - k)}, u + k,
     {colors.red + k, colors.green + k, colors.blue + k});
  }
}

}  // namespace deltaz
#endif
