// exponential.h on as many numbers as a vector of doubles holds, operation by operation: the same bits. To be
// included once for each vector target, inside Highway's foreach_target.
#if defined(DELTAZ_EXPONENTIAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_EXPONENTIAL_INL_H
#undef DELTAZ_EXPONENTIAL_INL_H
#else
#define DELTAZ_EXPONENTIAL_INL_H
#endif

#include <cstddef>
#include <hwy/highway.h>
#include <type_traits>

#include "librender/scene/exponential.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

// `count` numbers in place, a multiple of the lanes. Several vectors go side by side, since each step waits
// for the one before.
template <class D>
HWY_INLINE void exponentials(D d, double* numbers, std::size_t count) {
  namespace hn = hwy::HWY_NAMESPACE;
  using V = hn::Vec<D>;
  const hn::RebindToUnsigned<D> du;
  // The last bits of a number with this added are its nearest integer.
  const V bias = hn::Set(d, 0x1.8p52), least = hn::Set(d, kLeastExponent);
  const auto of_vectors = [&]<std::size_t kVectors>(double* x,
                                                    std::integral_constant<std::size_t, kVectors>) {
    constexpr std::size_t kLanes = hn::MaxLanes(D());
    V biased[kVectors], r[kVectors], sum[kVectors];
    for (std::size_t n = 0; n < kVectors; ++n) {
      const V kept = hn::Min(hn::Max(hn::LoadU(d, x + n * kLanes), least), hn::Set(d, kGreatestExponent));
      biased[n] = hn::Add(hn::Mul(kept, hn::Set(d, kLog2OfE)), bias);
      const V k = hn::Sub(biased[n], bias);
      r[n] = hn::Sub(hn::Sub(kept, hn::Mul(k, hn::Set(d, kLn2High))), hn::Mul(k, hn::Set(d, kLn2Low)));
      sum[n] = hn::Zero(d);
    }
    for (const double coefficient : kExponentialCoefficients) {
      for (std::size_t n = 0; n < kVectors; ++n)
        sum[n] = hn::Add(hn::Mul(sum[n], r[n]), hn::Set(d, coefficient));
    }
    for (std::size_t n = 0; n < kVectors; ++n) {
      const auto power = hn::ShiftLeft<52>(hn::Add(hn::BitCast(du, biased[n]), hn::Set(du, 1023)));
      const auto vanishes = hn::Lt(hn::LoadU(d, x + n * kLanes), least);
      hn::StoreU(hn::IfThenElse(vanishes, hn::Zero(d), hn::Mul(sum[n], hn::BitCast(d, power))), d,
                 x + n * kLanes);
    }
  };
  const std::size_t lanes = hn::Lanes(d);
  std::size_t k = 0;
  for (; k + 4 * lanes <= count; k += 4 * lanes)
    of_vectors(numbers + k, std::integral_constant<std::size_t, 4>());
  for (; k < count; k += lanes) of_vectors(numbers + k, std::integral_constant<std::size_t, 1>());
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
