// Moves the chosen lanes of vectors to the front, in order. Where each lane comes from is found once for all
// vectors that are moved alike: instructions that move lanes to the front take several times as long as
// permutations. Included once for each instruction set.
#if defined(DELTAZ_COMPACTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_COMPACTION_INL_H
#undef DELTAZ_COMPACTION_INL_H
#else
#define DELTAZ_COMPACTION_INL_H
#endif

#include <cstddef>
#include <cstdint>
#include <hwy/highway.h>

#include "librender/raster/compaction_places.h"

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

// Of vectors of 32-bit lanes, up to 16.
class Compaction {
  using FloatTag = hwy::HWY_NAMESPACE::CappedTag<float, 16>;
  using IntTag = hwy::HWY_NAMESPACE::RebindToSigned<FloatTag>;
  using UnsignedTag = hwy::HWY_NAMESPACE::RebindToUnsigned<FloatTag>;
  using IntMask = hwy::HWY_NAMESPACE::Mask<IntTag>;
  static constexpr std::size_t kLanes = hwy::HWY_NAMESPACE::MaxLanes(IntTag());

 public:
  explicit HWY_INLINE Compaction(IntMask chosen) : chosen_(chosen) {
    namespace hn = hwy::HWY_NAMESPACE;
    if constexpr (kLanes == 4 || kLanes == 8) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(IntTag(), chosen, bits);
      const std::uint8_t* const places =
          kLanes == 8 ? kPlacesOf8[bits[0]].data() : kPlacesOf4[bits[0] & 15].data();
      places_ = hn::PromoteTo(IntTag(), hn::LoadU(hn::Rebind<std::uint8_t, IntTag>(), places));
    } else if constexpr (kLanes == 16) {
      places_ = hn::Compress(hn::Iota(IntTag(), 0), chosen);
    }
  }

  std::size_t count() const { return hwy::HWY_NAMESPACE::CountTrue(IntTag(), chosen_); }

  // Stores a whole vector; what lies behind the chosen ones is unspecified.
  template <class D>
  HWY_INLINE void store(D d, hwy::HWY_NAMESPACE::Vec<D> values, hwy::HWY_NAMESPACE::TFromD<D>* to) const {
    namespace hn = hwy::HWY_NAMESPACE;
    if constexpr (kLanes == 1) {
      hn::StoreU(values, d, to);
    } else {
      hn::StoreU(hn::TableLookupLanes(values, hn::IndicesFromVec(d, places_)), d, to);
    }
  }

 private:
  IntMask chosen_;
  hwy::HWY_NAMESPACE::Vec<IntTag> places_{};
};

// Of one vector alone. Stores a whole vector at `to`; returns how many were chosen.
HWY_INLINE std::size_t storeCompacted(
    hwy::HWY_NAMESPACE::Mask<hwy::HWY_NAMESPACE::CappedTag<std::int32_t, 16>> chosen,
    hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::CappedTag<std::int32_t, 16>> values, std::int32_t* to) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr hn::CappedTag<std::int32_t, 16> d;
  if constexpr (hn::MaxLanes(d) == 16) {
    hn::StoreU(hn::Compress(values, chosen), d, to);
    return hn::CountTrue(d, chosen);
  } else {
    const Compaction compaction(chosen);
    compaction.store(d, values, to);
    return compaction.count();
  }
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
