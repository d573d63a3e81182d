// A mask of vectors of 32-bit lanes, up to 16, as a bit for each lane. Included once for each instruction
// set.
#if defined(DELTAZ_LANE_BITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef DELTAZ_LANE_BITS_INL_H
#undef DELTAZ_LANE_BITS_INL_H
#else
#define DELTAZ_LANE_BITS_INL_H
#endif

#include <cstdint>
#include <cstring>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace deltaz::HWY_NAMESPACE {

HWY_INLINE std::uint32_t laneBits(
    hwy::HWY_NAMESPACE::Mask<hwy::HWY_NAMESPACE::CappedTag<std::uint32_t, 16>> mask) {
  std::uint8_t bytes[8] = {};
  hwy::HWY_NAMESPACE::StoreMaskBits(hwy::HWY_NAMESPACE::CappedTag<std::uint32_t, 16>(), mask, bytes);
  std::uint16_t result = 0;
  std::memcpy(&result, bytes, sizeof(result));
  return result;
}

}  // namespace deltaz::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
