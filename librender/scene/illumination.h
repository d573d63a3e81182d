// Light on the terrain: I = k_a + k_d max(0, S.N), S pointing to the sun (report 5.5), evaluated per vertex.
// A scene definition: the same for every engine. Thread-safety: plain values and pure functions.
#pragma once

#include "formats/area.h"
#include "libdb/access/vector3.h"
#include "librender/scene/render.h"

namespace deltaz {

struct Light {
  Vector3 to_sun;         // Earth-centred unit vector
  double ambient = 0.22;  // k_a
  double diffuse = 1.15;  // k_d
  double intensity(const Vector3& normal) const {
    const double cosine = dot(to_sun, normal);
    return cosine > 0 ? ambient + diffuse * cosine : ambient;
  }
};

// The sun is so far away that its direction, taken at the centre of the area, serves everywhere.
Light makeLight(const AreaHeader& area, const Sun& sun);

}  // namespace deltaz
