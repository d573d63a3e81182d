#include "librender/raster/vertex_projection.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/raster/vertex_projection.cpp"
#include <algorithm>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "librender/raster/grid_culler.h"
#include "librender/raster/rounding-inl.h"
#include "librender/scene/view_volume.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Snapped positions of vertices at (x, y) pixels from the centre; `before`: not in front of the hither plane.
template <class D, class V, class M, class Out>
HWY_INLINE void storeSnapped(D d, V x, V y, M before, int width, int height, const Out& out,
                             std::size_t first) {
  const hn::RebindToSigned<D> di;
  const auto guard = hn::Set(d, static_cast<float>(kGuardBand)),
             scale = hn::Set(d, static_cast<float>(kSubPixels));
  const auto snapped = [&](V position, int extent) {
    const auto kept = hn::Min(hn::Max(position, hn::Neg(guard)), guard);
    const auto from_first_pixel =
        hn::Add(roundedInGuardBand(d, hn::Mul(kept, scale)), hn::Set(di, (extent - 1) * (kSubPixels / 2)));
    return hn::IfThenElse(hn::RebindMask(di, before), hn::Set(di, kBeforeHitherCoordinate), from_first_pixel);
  };
  hn::StoreU(snapped(x, width), di, out.snapped_x + first);
  hn::StoreU(snapped(y, height), di, out.snapped_y + first);
}

template <class D>
struct OnScreen {
  hn::Vec<D> x, y, inverse_u;
  hn::Mask<D> before;
};

template <class D>
HWY_INLINE OnScreen<D> projected(D d, const MeshProjection& projection, const float* x, const float* y,
                                 const float* z) {
  const auto dx = hn::Sub(hn::LoadU(d, x), hn::Set(d, projection.eye[0]));
  const auto dy = hn::Sub(hn::LoadU(d, y), hn::Set(d, projection.eye[1]));
  const auto dz = hn::Sub(hn::LoadU(d, z), hn::Set(d, projection.eye[2]));
  const auto along = [&](const float(&axis)[3]) {
    return hn::Add(hn::Add(hn::Mul(dx, hn::Set(d, axis[0])), hn::Mul(dy, hn::Set(d, axis[1]))),
                   hn::Mul(dz, hn::Set(d, axis[2])));
  };
  const auto u = along(projection.forward);
  const auto inverse_u = hn::Div(hn::Set(d, 1.0F), u);
  return {hn::Mul(along(projection.right), inverse_u), hn::Mul(along(projection.down), inverse_u), inverse_u,
          hn::Lt(u, hn::Set(d, projection.hither))};
}

void projectMesh(const MeshProjection& projection, const float* x, const float* y, const float* z,
                 const std::uint32_t* payload, std::size_t count, const ProjectedVertices& out) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (std::size_t n = 0; n < count; n += hn::Lanes(d)) {
    const auto at = projected(d, projection, x + n, y + n, z + n);
    hn::StoreInterleaved4(at.x, at.y, at.inverse_u, hn::BitCast(d, hn::LoadU(du, payload + n)), d,
                          &out.vertex[n].x);
    storeSnapped(d, at.x, at.y, at.before, projection.width, projection.height, out, n);
  }
}

void projectArrays(const MeshProjection& projection, const float* x, const float* y, const float* z,
                   std::size_t count, const ProjectedArrays& out) {
  const hn::CappedTag<float, 16> d;
  for (std::size_t n = 0; n < count; n += hn::Lanes(d)) {
    const auto at = projected(d, projection, x + n, y + n, z + n);
    hn::StoreU(at.x, d, out.x + n);
    hn::StoreU(at.y, d, out.y + n);
    hn::StoreU(at.inverse_u, d, out.inverse_u + n);
    storeSnapped(d, at.x, at.y, at.before, projection.width, projection.height, out, n);
  }
}

void projectDoubles(const double* positions, std::size_t count, int width, int height,
                    const ProjectedVertices& out) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::RebindToSigned<decltype(df)> di;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t n = 0; n < count; n += lanes) {
    // Nothing is read behind the last position.
    double rest[3 * 8] = {};
    if (count - n < lanes) std::copy_n(positions + 3 * n, 3 * (count - n), rest);
    hn::Vec<decltype(d)> u, v, w;
    hn::LoadInterleaved3(d, count - n < lanes ? rest : positions + 3 * n, u, v, w);
    const auto before = hn::Lt(u, hn::Set(d, kHither));
    const auto inverse_u = hn::Div(hn::Set(d, 1.0), hn::IfThenElse(before, hn::Set(d, 1.0), u));
    const auto limit = hn::Set(d, 2.0 * kGuardBand);
    const auto on_screen = [&](hn::Vec<decltype(d)> p) {
      return hn::DemoteTo(df, hn::Min(hn::Max(hn::Mul(p, inverse_u), hn::Neg(limit)), limit));
    };
    const auto x = on_screen(v), y = on_screen(w);
    hn::StoreInterleaved4(x, y, hn::DemoteTo(df, inverse_u),
                          hn::BitCast(df, hn::Iota(di, static_cast<std::int32_t>(n))), df, &out.vertex[n].x);
    const auto before_as_float = hn::DemoteTo(df, hn::IfThenElse(before, hn::Set(d, 1.0), hn::Zero(d)));
    storeSnapped(df, x, y, hn::Gt(before_as_float, hn::Zero(df)), width, height, out, n);
  }
}

}  // namespace
}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace deltaz {
namespace {
HWY_EXPORT(projectMesh);
HWY_EXPORT(projectArrays);
HWY_EXPORT(projectDoubles);

void toFloats(const Vector3& v, double scale, float (&out)[3]) {
  out[0] = static_cast<float>(v.x * scale);
  out[1] = static_cast<float>(v.y * scale);
  out[2] = static_cast<float>(v.z * scale);
}
}  // namespace

MeshProjection::MeshProjection(const ViewTransform& view)
    : width(view.width), height(view.height), hither(static_cast<float>(kHither)) {
  toFloats(view.eye, 1, eye);
  toFloats(view.forward, 1, forward);
  toFloats(view.right, view.pixels, right);
  toFloats(view.down, view.pixels, down);
}

void MeshProjection::project(const float* x, const float* y, const float* z, const std::uint32_t* payload,
                             std::size_t count, const ProjectedVertices& out) const {
  HWY_DYNAMIC_DISPATCH(projectMesh)(*this, x, y, z, payload, count, out);
}

void MeshProjection::project(const float* x, const float* y, const float* z, std::size_t count,
                             const ProjectedArrays& out) const {
  HWY_DYNAMIC_DISPATCH(projectArrays)(*this, x, y, z, count, out);
}

void projectViewPositions(std::span<const Vector3> positions, int width, int height,
                          const ProjectedVertices& out) {
  static_assert(sizeof(Vector3) == 3 * sizeof(double));
  HWY_DYNAMIC_DISPATCH(projectDoubles)
  (positions.empty() ? nullptr : &positions.data()->x, positions.size(), width, height, out);
}

}  // namespace deltaz

#endif  // HWY_ONCE
