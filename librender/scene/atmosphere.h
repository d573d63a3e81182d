// Haze and sky. A scene definition: the same for every engine.
//
// Haze: two exponential layers, molecules (scale height 8 km, scattering blue most) and aerosol (2 km, grey).
// The optical depth of the straight path between two heights h1, h2 over a length L is  beta L H (d1 - d2) /
// (h2 - h1) with d = exp(-h/H): a view from 200 km stays clear, 50 km along the ground fade into the horizon.
// Light lost is replaced by the haze colour, which is the colour of the sky at the horizon. Sky: from the
// haze colour at the eye's horizon (the dip of the ellipsoid seen from its height) to the zenith's.
// Thread-safety: const members from any thread.
#pragma once

#include "formats/area.h"
#include "libdb/access/color.h"
#include "libdb/access/synthetic_color.h"
#include "librender/scene/camera.h"
#include "librender/scene/ray_lists.h"

namespace deltaz {

// What sky and haze are computed from.
struct AtmosphereTerms {
  Vector3 eye, up;
  double inverse_a_squared = 0, inverse_b_squared = 0;
  double eye_height = 0;
  double eye_density = 0;      // exp(-height / 8 km)
  double sine_of_horizon = 0;  // of the elevation angle, negative: below level
  double gradient = 0.25;      // width of the bright band over the horizon
  LinearColor haze_color, zenith_color;
};

class Atmosphere {
 public:
  // `to_sun` dims the sky when the sun is low or down.
  Atmosphere(const EllipsoidShape& ellipsoid, const ViewTransform& view, const Vector3& to_sun);

  // `ray` as of ViewTransform::ray.
  LinearColor sky(const Vector3& ray) const;
  // What is left at the eye of `color` at eye + ray * u.
  LinearColor throughHaze(const LinearColor& color, const Vector3& ray, double u) const;
  const LinearColor& hazeColor() const { return terms_.haze_color; }
  // Brightness of daylight, 0 .. 1.
  double daylight() const { return daylight_; }

  // The same of many rays; `colors` are those at `u`, and what is left of them.
  void skies(const RayLists& rays, const ColorLists& colors) const;
  void throughHaze(const RayLists& rays, const double* u, const ColorLists& colors) const;

 private:
  // Height above the ellipsoid, metres, to first order in the flattening.
  double heightOf(const Vector3& position) const;

  AtmosphereTerms terms_;
  double daylight_ = 1;
};

}  // namespace deltaz
