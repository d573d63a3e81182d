// The sea: the base ellipsoid grown by h = lowest height of the area less the chord sag of its coarsest cell,
// so that it lies below every facet of every level and nothing is seen through the Earth or past the area's
// edge. The grown surface is the ellipsoid of semi-axes a + h, b + h; it lies within |h| f^2 / 2 (1 cm for 2
// km) of the true offset surface. A scene definition: the same for every engine. Thread-safety: const members
// from any thread.
#pragma once

#include "formats/area.h"
#include "libdb/access/color.h"
#include "libdb/access/synthetic_color.h"
#include "librender/scene/atmosphere.h"
#include "librender/scene/camera.h"
#include "librender/scene/illumination.h"
#include "librender/scene/ray_lists.h"

namespace deltaz {

// Semi-axes of the sea's ellipsoid, metres.
struct SeaAxes {
  double a = 0, b = 0;
};
SeaAxes seaAxes(const AreaHeader& area);

// What its depth and colour are computed from.
struct SeaTerms {
  Vector3 eye;
  Vector3 scaled_eye;  // divided by the semi-axes
  double inverse_a = 0, inverse_b = 0;
  double outside = -1;  // |scaled eye|^2 - 1
  Light light;
  LinearColor deep, reflected;
};

class Sea {
 public:
  Sea(const AreaHeader& area, const ViewTransform& view, const Light& light, const Atmosphere& atmosphere);

  // U of the point where the ray (as of ViewTransform::ray) meets the sea; +infinity where it does not, and
  // everywhere when the eye is not above the sea.
  double depth(const Vector3& ray) const;
  // Colour of the sea met at depth `u`, before haze.
  LinearColor color(const Vector3& ray, double u) const;

  // The same of many rays. The colour where the sea is not met means nothing.
  void depths(const RayLists& rays, double* u) const;
  void colors(const RayLists& rays, const double* u, const ColorLists& colors) const;

  const SeaTerms& terms() const { return terms_; }

 private:
  SeaTerms terms_;
};

}  // namespace deltaz
