#include "librender/scene/view_volume.h"

namespace deltaz {

ViewVolume::ViewVolume(const ViewTransform& view, double margin) : eye_(view.eye) {
  const double half_width = view.width / 2.0 + margin, half_height = view.height / 2.0 + margin;
  // |V| <= half_width * U and |W| <= half_height * U, written with the unit vectors of the view.
  const Vector3 across = view.right * view.pixels, downward = view.down * view.pixels;
  half_spaces_ = {{{view.forward, kHither},
                   {normalized(view.forward * half_width + across), 0},
                   {normalized(view.forward * half_width - across), 0},
                   {normalized(view.forward * half_height + downward), 0},
                   {normalized(view.forward * half_height - downward), 0}}};
}

bool ViewVolume::isOutside(const Vector3& centre, double radius) const {
  const Vector3 offset = centre - eye_;
  for (const HalfSpace& half_space : half_spaces_) {
    if (dot(half_space.inward, offset) < half_space.distance - radius) return true;
  }
  return false;
}

bool ViewVolume::isOutside(const NodeVolume& volume) const {
  const Vector3 offset = volume.centre - eye_;
  for (const HalfSpace& half_space : half_spaces_) {
    const double short_of = half_space.distance - dot(half_space.inward, offset);
    if (short_of > volume.radius) return true;
    if (short_of > 0 && short_of > reachAlong(volume, half_space.inward)) return true;
  }
  return false;
}

double largestTangentSquared(const ViewTransform& view) {
  const double x = view.width / 2.0 / view.pixels, y = view.height / 2.0 / view.pixels;
  return x * x + y * y;
}

}  // namespace deltaz
