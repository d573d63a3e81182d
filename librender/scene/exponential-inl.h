// exponential.h on as many numbers as a vector of doubles holds, operation by operation: the same bits. To be
// included once for each vector target, inside Highway's foreach_target.
#if defined(DELTAZ_EXPONENTIAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_EXPONENTIAL_INL_H
#undef DELTAZ_EXPONENTIAL_INL_H
#else
#define DELTAZ_EXPONENTIAL_INL_H
#endif

#include <hwy/highway.h>

#include "librender/scene/exponential.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V exponentials(D d, V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::RebindToUnsigned<D> du;
  const auto vanishes = hn::Lt(x, hn::Set(d, kLeastExponent));
  const V kept = hn::Min(hn::Max(x, hn::Set(d, kLeastExponent)), hn::Set(d, kGreatestExponent));
  // The last bits of a number with this added are its nearest integer.
  const V bias = hn::Set(d, 0x1.8p52);
  const V biased = hn::Add(hn::Mul(kept, hn::Set(d, kLog2OfE)), bias);
  const V k = hn::Sub(biased, bias);
  const V r = hn::Sub(hn::Sub(kept, hn::Mul(k, hn::Set(d, kLn2High))), hn::Mul(k, hn::Set(d, kLn2Low)));
  V sum = hn::Zero(d);
  for (const double coefficient : kExponentialCoefficients)
    sum = hn::Add(hn::Mul(sum, r), hn::Set(d, coefficient));
  const auto power = hn::ShiftLeft<52>(hn::Add(hn::BitCast(du, biased), hn::Set(du, 1023)));
  return hn::IfThenElse(vanishes, hn::Zero(d), hn::Mul(sum, hn::BitCast(d, power)));
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
