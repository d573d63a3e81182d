#include "librender/scene/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "librender/scene/exponential.h"

namespace deltaz {
namespace {

constexpr double kMolecularHeight = 8000;  // metres
constexpr double kAerosolHeight =
    kMolecularHeight / 4;                 // so that its density is the fourth power of the other's
constexpr double kMolecularRed = 2.5e-6;  // 1/m at height 0; green twice, blue four times as much
constexpr double kAerosol = 2.0e-5;       // 1/m at height 0
// Air has a floor, in metres: no dry land lies lower, but facets of a whole globe sag by kilometres, within a
// pixel of the ground they stand for.
constexpr double kLowestGround = -500;
constexpr LinearColor kHaze{0.60, 0.70, 0.82};
constexpr LinearColor kZenith{0.060, 0.170, 0.480};

// Mean density of a layer between two heights of densities d1, d2, where d = exp(-h / scale).
double meanDensity(double h1, double d1, double h2, double d2, double scale) {
  const double rise = (h2 - h1) / scale;
  // For nearly equal heights the quotient loses its digits; the mean of both ends differs from it by rise^2
  // / 12.
  if (std::abs(rise) < 1e-4) return (d1 + d2) / 2;
  return (d1 - d2) / rise;
}

}  // namespace

Atmosphere::Atmosphere(const EllipsoidShape& ellipsoid, const ViewTransform& view, const Vector3& to_sun)
    : eye_(view.eye) {
  const double a = ellipsoid.semi_major_axis;
  const double flattening = ellipsoid.inverse_flattening != 0 ? 1 / ellipsoid.inverse_flattening : 0;
  const double b = a * (1 - flattening);
  inverse_a_squared_ = 1 / (a * a);
  inverse_b_squared_ = 1 / (b * b);
  const GeodeticPoint eye = toGeodetic(ellipsoid, view.eye);
  up_ = upVector(rowConstants(ellipsoid, eye.latitude), columnConstants(eye.longitude));
  eye_height_ = heightOf(eye_);
  eye_density_ = exponential(-eye_height_ / kMolecularHeight);
  const double ratio = a / (a + std::max(eye_height_, 0.0));
  sine_of_horizon_ = -std::sqrt(1 - ratio * ratio);

  daylight_ = 0.03 + 0.97 * smoothStep(-0.10, 0.25, dot(to_sun, up_));
  haze_color_ = kHaze * daylight_;
  // From high up the sky is dark and its bright band thin.
  const double air = std::min(1.0, eye_density_);
  zenith_color_ = kZenith * (daylight_ * (0.02 + 0.98 * air));
  gradient_ = 0.02 + 0.23 * air;
}

double Atmosphere::heightOf(const Vector3& p) const {
  const double q = (p.x * p.x + p.y * p.y) * inverse_a_squared_ + p.z * p.z * inverse_b_squared_;
  // The point scaled to the ellipsoid along its radius is p / sqrt(q).
  return length(p) * (1 - 1 / std::sqrt(q));
}

LinearColor Atmosphere::sky(const Vector3& ray) const {
  const double elevation = dot(ray, up_) / length(ray) - sine_of_horizon_;
  if (elevation <= 0) return haze_color_;
  return mix(haze_color_, zenith_color_, elevation * (1 + gradient_) / (elevation + gradient_));
}

LinearColor Atmosphere::throughHaze(const LinearColor& color, const Vector3& ray, double u) const {
  const double distance = length(ray) * u;
  const double height = std::max(kLowestGround, heightOf(eye_ + ray * u));
  const double density = exponential(-height / kMolecularHeight);
  const double density2 = density * density, eye_density2 = eye_density_ * eye_density_;
  const double molecular =
      kMolecularRed * distance * meanDensity(eye_height_, eye_density_, height, density, kMolecularHeight);
  const double aerosol =
      kAerosol * distance *
      meanDensity(eye_height_, eye_density2 * eye_density2, height, density2 * density2, kAerosolHeight);
  const double grey = exponential(-aerosol);
  const double red = exponential(-molecular), green = red * red, blue = green * green;
  return {haze_color_.red + (color.red - haze_color_.red) * (grey * red),
          haze_color_.green + (color.green - haze_color_.green) * (grey * green),
          haze_color_.blue + (color.blue - haze_color_.blue) * (grey * blue)};
}

}  // namespace deltaz
