#include "librender/scene/sea.h"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/scene/sea.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_SEA_MIRROR
#define DELTAZ_SEA_MIRROR
namespace deltaz {
namespace {

// Of the light that comes from the sky at right angles; and how much of what is mirrored is seen.
constexpr double kLeastMirror = 0.02, kMirrorSeen = 0.6;

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

Vectors loadRays(const RayLists& rays, std::size_t k) {
  const D d;
  return {hn::LoadU(d, rays.x + k), hn::LoadU(d, rays.y + k), hn::LoadU(d, rays.z + k)};
}
Vectors everywhere(const Vector3& v) {
  const D d;
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
V dotOf(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

// Sea::depth, operation by operation.
void seaDepths(const SeaTerms& terms, const RayLists& rays, double* u) {
  const D d;
  const V none = hn::Set(d, std::numeric_limits<double>::infinity()), zero = hn::Zero(d);
  const V inverse_a = hn::Set(d, terms.inverse_a), inverse_b = hn::Set(d, terms.inverse_b);
  const V outside = hn::Set(d, terms.outside);
  const Vectors scaled_eye = everywhere(terms.scaled_eye);
  for (std::size_t k = 0; k < rays.count; k += hn::Lanes(d)) {
    const Vectors ray = loadRays(rays, k);
    const Vectors scaled{hn::Mul(ray.x, inverse_a), hn::Mul(ray.y, inverse_a), hn::Mul(ray.z, inverse_b)};
    const V half = dotOf(scaled_eye, scaled);
    const V discriminant = hn::Sub(hn::Mul(half, half), hn::Mul(dotOf(scaled, scaled), outside));
    const auto met = hn::And(hn::Gt(outside, zero), hn::And(hn::Lt(half, zero), hn::Ge(discriminant, zero)));
    if (hn::AllFalse(d, met)) {
      hn::StoreU(none, d, u + k);
      continue;
    }
    const V root = hn::Sqrt(hn::IfThenElseZero(met, discriminant));
    hn::StoreU(hn::IfThenElse(met, hn::Div(outside, hn::Sub(root, half)), none), d, u + k);
  }
}

// Sea::color, operation by operation.
void seaColors(const SeaTerms& terms, const RayLists& rays, const double* depths, const ColorLists& colors) {
  const D d;
  const V one = hn::Set(d, 1.0);
  const V inverse_a2 = hn::Set(d, terms.inverse_a * terms.inverse_a);
  const V inverse_b2 = hn::Set(d, terms.inverse_b * terms.inverse_b);
  const Vectors eye = everywhere(terms.eye), sun = everywhere(terms.light.to_sun);
  const V ambient = hn::Set(d, terms.light.ambient), diffuse = hn::Set(d, terms.light.diffuse);
  for (std::size_t k = 0; k < rays.count; k += hn::Lanes(d)) {
    const Vectors ray = loadRays(rays, k);
    const V u = hn::LoadU(d, depths + k);
    const auto steep = [&](V from, V along, V scale) {
      return hn::Mul(hn::Add(from, hn::Mul(along, u)), scale);
    };
    const Vectors gradient{steep(eye.x, ray.x, inverse_a2), steep(eye.y, ray.y, inverse_a2),
                           steep(eye.z, ray.z, inverse_b2)};
    const V scale = hn::Div(one, hn::Sqrt(dotOf(gradient, gradient)));
    const Vectors normal{hn::Mul(gradient.x, scale), hn::Mul(gradient.y, scale), hn::Mul(gradient.z, scale)};
    const V facing = hn::Add(one, hn::Div(dotOf(ray, normal), hn::Sqrt(dotOf(ray, ray))));
    const V facing2 = hn::Mul(facing, facing);
    const V fifth_power = hn::Mul(hn::Mul(facing2, facing2), facing);
    const V mirror = hn::Add(hn::Set(d, kLeastMirror), hn::Mul(hn::Set(d, 1 - kLeastMirror), fifth_power));
    const V share = hn::Mul(mirror, hn::Set(d, kMirrorSeen)), rest = hn::Sub(one, share);
    const V cosine = dotOf(sun, normal);
    const V lit =
        hn::IfThenElse(hn::Gt(cosine, hn::Zero(d)), hn::Add(ambient, hn::Mul(diffuse, cosine)), ambient);
    const auto store = [&](double deep, double reflected, double* to) {
      hn::StoreU(
          hn::Add(hn::Mul(hn::Mul(hn::Set(d, deep), lit), rest), hn::Mul(hn::Set(d, reflected), share)), d,
          to + k);
    };
    store(terms.deep.red, terms.reflected.red, colors.red);
    store(terms.deep.green, terms.reflected.green, colors.green);
    store(terms.deep.blue, terms.reflected.blue, colors.blue);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz {
namespace {

HWY_EXPORT(seaDepths);
HWY_EXPORT(seaColors);

constexpr LinearColor kDeepWater{0.016, 0.060, 0.125};

// Positive outside the ellipsoid: |scaled|^2 - 1, about 2 height / radius near the surface. Its rounding,
// some 4e-16, is a height of nanometres.
double outsideOf(const Vector3& scaled) {
  return scaled.x * scaled.x + scaled.y * scaled.y + (scaled.z * scaled.z - 1);
}

}  // namespace

SeaAxes seaAxes(const AreaHeader& area) {
  const EllipsoidShape ellipsoid = area.grids.empty() ? EllipsoidShape{} : area.grids.front().ellipsoid;
  const double flattening = ellipsoid.inverse_flattening != 0 ? 1 / ellipsoid.inverse_flattening : 0;
  const double height = area.lowest_height - area.sea_drop;
  return {ellipsoid.semi_major_axis + height, ellipsoid.semi_major_axis * (1 - flattening) + height};
}

Sea::Sea(const AreaHeader& area, const ViewTransform& view, const Light& light,
         const Atmosphere& atmosphere) {
  terms_.eye = view.eye;
  terms_.light = light;
  const auto [a, b] = seaAxes(area);
  terms_.inverse_a = 1 / a;
  terms_.inverse_b = 1 / b;
  terms_.scaled_eye = {terms_.eye.x * terms_.inverse_a, terms_.eye.y * terms_.inverse_a,
                       terms_.eye.z * terms_.inverse_b};
  terms_.outside = outsideOf(terms_.scaled_eye);
  terms_.deep = kDeepWater;
  terms_.reflected = atmosphere.hazeColor();
}

double Sea::depth(const Vector3& ray) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (terms_.outside <= 0) return kNone;
  const Vector3 scaled{ray.x * terms_.inverse_a, ray.y * terms_.inverse_a, ray.z * terms_.inverse_b};
  // outside + 2 half u + squared u^2 = 0; the nearer root, in the form that subtracts nothing.
  const double half = dot(terms_.scaled_eye, scaled);
  if (half >= 0) return kNone;
  const double squared = dot(scaled, scaled);
  const double discriminant = half * half - squared * terms_.outside;
  if (discriminant < 0) return kNone;
  return terms_.outside / (std::sqrt(discriminant) - half);
}

LinearColor Sea::color(const Vector3& ray, double u) const {
  const Vector3 p = terms_.eye + ray * u;
  const Vector3 normal =
      normalized({p.x * (terms_.inverse_a * terms_.inverse_a), p.y * (terms_.inverse_a * terms_.inverse_a),
                  p.z * (terms_.inverse_b * terms_.inverse_b)});
  // Water mirrors the more sky the flatter one looks at it (Schlick's approximation, from 2 % at right
  // angles).
  const double facing = 1 + dot(ray, normal) / length(ray);
  const double facing2 = facing * facing;
  const double mirror = kLeastMirror + (1 - kLeastMirror) * (facing2 * facing2 * facing);
  return mix(terms_.deep * terms_.light.intensity(normal), terms_.reflected, mirror * kMirrorSeen);
}

void Sea::depths(const RayLists& rays, double* u) const {
  HWY_DYNAMIC_DISPATCH(seaDepths)(terms_, rays, u);
}

void Sea::colors(const RayLists& rays, const double* u, const ColorLists& colors) const {
  HWY_DYNAMIC_DISPATCH(seaColors)(terms_, rays, u, colors);
}

}  // namespace deltaz
#endif
