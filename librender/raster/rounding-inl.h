// Rounding of single-precision numbers to integers for vector code, to nearest with ties to even, as
// std::lrint does. Included once for each instruction set.
#if defined(DELTAZ_ROUNDING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_ROUNDING_INL_H
#undef DELTAZ_ROUNDING_INL_H
#else
#define DELTAZ_ROUNDING_INL_H
#endif

#include <hwy/highway.h>

#include "librender/raster/raster_triangle.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

// Added to a number below 2^22 in size it leaves the nearest integer in the last bits of the sum.
inline constexpr float kRoundingBias = 12582912.0F;  // 1.5 * 2^23
static_assert(kGuardBand * kSubPixels < 1 << 22);

// Of |value| <= kGuardBand * kSubPixels; two operations instead of a conversion that minds overflow.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::RebindToSigned<D>> roundedInGuardBand(
    D d, hwy::HWY_NAMESPACE::Vec<D> value) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::RebindToSigned<D> di;
  constexpr std::int32_t kBiasBits = 0x4B400000;
  return hn::Sub(hn::BitCast(di, hn::Add(value, hn::Set(d, kRoundingBias))), hn::Set(di, kBiasBits));
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
