// Loads records of four floats from places of their own and turns them into a vector for each of the four.
// Hardware gathers take several times as long. Included once for each instruction set.
#if defined(DELTAZ_LOAD_FOURS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_LOAD_FOURS_INL_H
#undef DELTAZ_LOAD_FOURS_INL_H
#else
#define DELTAZ_LOAD_FOURS_INL_H
#endif

#include <cstddef>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

// Some targets have no such operations; names are looked up where there are.
// Blocks of four lanes: the records at(k), at(k + 4), at(k + 8), ...
template <class D, class At>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> everyFourth(D d, At at, std::size_t k) {
  namespace hn = hwy::HWY_NAMESPACE;
  if constexpr (hn::MaxLanes(D()) <= 4) {
    return hn::LoadU(d, at(k));
  } else {
    const hn::Half<D> half;
    constexpr std::size_t kHalf = hn::MaxLanes(D()) / 2;
    return Combine(d, everyFourth(half, at, k + kHalf), everyFourth(half, at, k));
  }
}

// at(n): the four floats of lane n.
template <class D, class At>
HWY_INLINE void loadFours(D d, At at, hwy::HWY_NAMESPACE::Vec<D> (&out)[4]) {
  namespace hn = hwy::HWY_NAMESPACE;
  if constexpr (hn::MaxLanes(D()) == 1) {
    for (std::size_t k = 0; k < 4; ++k) out[k] = hn::Set(d, at(0)[k]);
  } else {
    const auto v0 = everyFourth(d, at, 0), v1 = everyFourth(d, at, 1), v2 = everyFourth(d, at, 2),
               v3 = everyFourth(d, at, 3);
    const hn::Repartition<double, D> pairs;
    const auto low01 = hn::BitCast(pairs, InterleaveLower(d, v0, v1)),
               high01 = hn::BitCast(pairs, InterleaveUpper(d, v0, v1)),
               low23 = hn::BitCast(pairs, InterleaveLower(d, v2, v3)),
               high23 = hn::BitCast(pairs, InterleaveUpper(d, v2, v3));
    out[0] = hn::BitCast(d, InterleaveLower(pairs, low01, low23));
    out[1] = hn::BitCast(d, InterleaveUpper(pairs, low01, low23));
    out[2] = hn::BitCast(d, InterleaveLower(pairs, high01, high23));
    out[3] = hn::BitCast(d, InterleaveUpper(pairs, high01, high23));
  }
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
