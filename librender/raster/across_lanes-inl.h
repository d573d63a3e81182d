// Reductions over the lanes of vectors. Those of Highway copy their result to all lanes of wide vectors,
// which costs as much as a step of them. Included once for each instruction set.
#if defined(DELTAZ_ACROSS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_ACROSS_LANES_INL_H
#undef DELTAZ_ACROSS_LANES_INL_H
#else
#define DELTAZ_ACROSS_LANES_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

// Some targets have no such operations; names are looked up where there are.
// Joins the halves of a vector by two(a, b) until at most four lanes are left.
template <class D, class Two>
HWY_INLINE auto joinedToFour([[maybe_unused]] D d, hwy::HWY_NAMESPACE::Vec<D> values, Two two) {
  if constexpr (hwy::HWY_NAMESPACE::MaxLanes(D()) <= 4) {
    return values;
  } else {
    const hwy::HWY_NAMESPACE::Half<D> half;
    return joinedToFour(half, two(LowerHalf(half, values), UpperHalf(half, values)), two);
  }
}

template <class D>
HWY_INLINE std::uint32_t orOfLanes(D d, hwy::HWY_NAMESPACE::Vec<D> values) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr std::size_t kLeft = std::min<std::size_t>(hn::MaxLanes(D()), 4);
  alignas(16) std::uint32_t lanes[kLeft];
  hn::Store(joinedToFour(d, values, [](auto a, auto b) { return hn::Or(a, b); }),
            hn::CappedTag<std::uint32_t, kLeft>(), lanes);
  std::uint32_t all = 0;
  for (const std::uint32_t lane : lanes) all |= lane;
  return all;
}

// The least lane of each of four vectors, for little more than twice what it takes for one.
template <class D>
HWY_INLINE void leastOfFour(D d, const hwy::HWY_NAMESPACE::Vec<D> (&v)[4], float (&least)[4]) {
  namespace hn = hwy::HWY_NAMESPACE;
  if constexpr (hn::MaxLanes(D()) == 1) {
    for (std::size_t k = 0; k < 4; ++k) least[k] = hn::GetLane(v[k]);
  } else {
    constexpr hn::Repartition<double, D> pairs;
    const auto of_two = [&](hn::Vec<D> a, hn::Vec<D> b) {
      return hn::BitCast(pairs, hn::Min(InterleaveLower(d, a, b), InterleaveUpper(d, a, b)));
    };
    const auto first = of_two(v[0], v[1]), second = of_two(v[2], v[3]);
    const auto four = hn::Min(hn::BitCast(d, InterleaveLower(pairs, first, second)),
                              hn::BitCast(d, InterleaveUpper(pairs, first, second)));
    hn::StoreU(joinedToFour(d, four, [](auto a, auto b) { return hn::Min(a, b); }), hn::CappedTag<float, 4>(),
               least);
  }
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
