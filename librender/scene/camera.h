// The camera and the view space it defines.
//
// View space (report 4.1): U forward, V right, W down, metres, right-handed; V and W include the
// field-of-view scaling in pixels, so that a point projects to column j = centre_j + V/U and row i = centre_i
// + W/U. Pixel centres lie at integer (i, j); (1, 0, 0) is the picture's centre, ((height-1)/2, (width-1)/2).
// Thread-safety: plain values.
#pragma once

#include "formats/area.h"
#include "libdb/access/earth.h"
#include "libdb/access/vector3.h"

namespace deltaz {

struct Camera {
  GeodeticPoint eye;               // degrees, metres above the database's datum
  double heading = 0;              // degrees clockwise from north
  double pitch = 0;                // degrees, positive up
  double roll = 0;                 // degrees, positive tilts the horizon's right side up (right wing down)
  double field_of_view = 60;       // horizontal, degrees, 0 < fov < 180
  int width = 1280, height = 720;  // pixels
};

// Earth-centred -> view space: view = rows * (p - eye), with V and W scaled to pixels.
struct ViewTransform {
  Vector3 eye;                   // Earth-centred metres
  Vector3 forward, right, down;  // Earth-centred unit vectors
  double pixels = 1;             // pixels per unit of tangent
  double centre_j = 0, centre_i = 0;
  int width = 0, height = 0;

  // (U, V, W) of an Earth-centred point.
  Vector3 toView(const Vector3& p) const {
    const Vector3 d = p - eye;
    return {dot(forward, d), dot(right, d) * pixels, dot(down, d) * pixels};
  }
  // Earth-centred direction (not normalised, forward component 1) of the ray through pixel position (j, i).
  Vector3 ray(double j, double i) const {
    return forward + right * ((j - centre_j) / pixels) + down * ((i - centre_i) / pixels);
  }
};

ViewTransform makeViewTransform(const Camera& camera, const EllipsoidShape& ellipsoid);

// The view used when the user gives none: the whole area from the south, looking down at it, every corner of
// its bounds in the picture with a small margin.
Camera wholeAreaCamera(const AreaHeader& area, int width, int height, double field_of_view);

}  // namespace deltaz
