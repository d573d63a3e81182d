#include "librender/ars/machine/functional_memory.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "librender/ars/machine/functional_memory.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <numeric>

#include "librender/ars/tiler/span_tiler.h"

#ifndef DELTAZ_FUNCTIONAL_MEMORY_ONCE
#define DELTAZ_FUNCTIONAL_MEMORY_ONCE
namespace deltaz::ars {

// What vectors need to know of a triangle.
struct RowRules {
  SingleAccumulator::Steps steps;
  float direction = 1;  // of tiling along the lines
  int tie_shift = 0;    // words that are greater above it are written
  int exponent_shift = 0;
};

enum Counter : std::size_t {
  kUninitialized,
  kSameExponent,
  kWritten,
  kSameExponentWritten,
  kTies,
  kSplitTies
};

}  // namespace deltaz::ars
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz::ars::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using WordTag = hn::CappedTag<std::uint64_t, FunctionalMemory::kLanes>;
using FloatTag = hn::Rebind<float, WordTag>;
constexpr WordTag kWord;
constexpr hn::RebindToSigned<WordTag> kSigned;
constexpr FloatTag kFloat;
constexpr hn::RebindToSigned<FloatTag> kInt;
constexpr hn::RebindToUnsigned<FloatTag> kUnsigned;
constexpr std::size_t kLanes = hn::MaxLanes(WordTag());
using Words = hn::Vec<WordTag>;
using Floats = hn::Vec<FloatTag>;
using Mask = hn::Mask<WordTag>;

// SingleAccumulator::tenBits.
HWY_INLINE Floats tenBits(Floats x) {
  constexpr int kDropped = 14;
  const auto bits = hn::BitCast(kUnsigned, x);
  const auto odd = hn::And(hn::ShiftRight<kDropped>(bits), hn::Set(kUnsigned, 1));
  const auto rounded = hn::Add(bits, hn::Add(odd, hn::Set(kUnsigned, (1u << (kDropped - 1)) - 1)));
  return hn::BitCast(kFloat, hn::And(rounded, hn::Set(kUnsigned, ~((1u << kDropped) - 1))));
}

// Depth above colour of the pixels `steps` from the corner: SingleAccumulator::at and memoryWord.
HWY_INLINE Words wordsOf(const PixelRow& row, const SingleAccumulator::Steps& rules, Floats steps) {
  const Floats depth = hn::Add(hn::Set(kFloat, row.depth), hn::Mul(steps, hn::Set(kFloat, rules.depth)));
  const Floats shade = tenBits(hn::Mul(steps, hn::Set(kFloat, rules.color)));
  const Floats color = hn::Add(tenBits(hn::Add(hn::Set(kFloat, row.color), shade)), hn::Set(kFloat, 0.5F));
  const Floats byte = hn::Min(hn::Max(color, hn::Zero(kFloat)), hn::Set(kFloat, 255.0F));
  const auto bits = hn::BitCast(kInt, depth);
  const auto odd = hn::And(hn::ShiftRightSame(bits, rules.dropped_bits), hn::Set(kInt, 1));
  const auto half = hn::Add(odd, hn::Set(kInt, (1 << (rules.dropped_bits - 1)) - 1));
  const auto rounded = hn::ShiftRightSame(hn::Add(bits, half), rules.dropped_bits);
  // Depths below 0 have the sign bit and stay below 0 down to here.
  const auto word = hn::Min(hn::Max(hn::Sub(rounded, hn::Set(kInt, rules.offset)), hn::Zero(kInt)),
                            hn::Set(kInt, rules.largest));
  const Words depths = hn::PromoteTo(kWord, hn::BitCast(kUnsigned, word));
  return hn::Or(hn::ShiftLeft<kColorBits>(depths),
                hn::PromoteTo(kWord, hn::BitCast(kUnsigned, hn::ConvertTo(kInt, byte))));
}

HWY_INLINE Mask greater(Words a, Words b) {
  // Below the flag no word has the sign bit.
  return hn::RebindMask(kWord, hn::Gt(hn::BitCast(kSigned, a), hn::BitCast(kSigned, b)));
}

HWY_INLINE Words addTo(Words counter, Mask mask) {
  return hn::Sub(counter, hn::VecFromMask(kWord, mask));
}

template <bool kBackground>
void writeRows(std::span<const PixelRow> rows, const RowRules& rules, std::uint64_t* words,
               FunctionalMemory::Counters& counters) {
  const Words flag = hn::Set(kWord, kInitFlag);
  const Floats iota = hn::Mul(hn::Iota(kFloat, 0), hn::Set(kFloat, rules.direction));
  const int tie_shift = rules.tie_shift, exponent_shift = rules.exponent_shift;
  Words counts[FunctionalMemory::kCounters];
  for (std::size_t k = 0; k < FunctionalMemory::kCounters; ++k)
    counts[k] = hn::Load(kWord, counters[k].data());
  for (const PixelRow& row : rows) {
    const auto count = static_cast<std::size_t>(row.count);
    for (std::size_t begin = 0; begin < count; begin += kLanes) {
      const float first = row.first_step + rules.direction * static_cast<float>(begin);
      const Words word = wordsOf(row, rules.steps, hn::Add(hn::Set(kFloat, first), iota));
      const Mask valid = hn::FirstN(kWord, count - begin);
      std::uint64_t* const place = words + row.place + begin;
      const Words old = hn::LoadU(kWord, place);
      if (kBackground) {
        hn::StoreU(hn::IfThenElse(valid, hn::Or(word, hn::And(old, flag)), old), kWord, place);
        continue;
      }
      const Words held = hn::AndNot(flag, old);
      const Mask initialized = hn::And(valid, hn::Ne(old, held));
      const Mask first_time = hn::AndNot(initialized, valid);
      const Mask nearer = hn::And(
          initialized, greater(hn::ShiftRightSame(word, tie_shift), hn::ShiftRightSame(held, tie_shift)));
      hn::StoreU(hn::IfThenElse(hn::Or(first_time, nearer), hn::Or(word, flag), old), kWord, place);
      const Mask same_exponent = hn::And(initialized, hn::Eq(hn::ShiftRightSame(word, exponent_shift),
                                                             hn::ShiftRightSame(held, exponent_shift)));
      const Mask tie =
          hn::And(initialized, hn::Eq(hn::ShiftRight<kColorBits>(word), hn::ShiftRight<kColorBits>(held)));
      counts[kUninitialized] = addTo(counts[kUninitialized], first_time);
      counts[kSameExponent] = addTo(counts[kSameExponent], same_exponent);
      counts[kWritten] = addTo(counts[kWritten], nearer);
      counts[kSameExponentWritten] = addTo(counts[kSameExponentWritten], hn::And(same_exponent, nearer));
      counts[kTies] = addTo(counts[kTies], tie);
      counts[kSplitTies] = addTo(counts[kSplitTies], hn::And(tie, hn::Ne(word, held)));
    }
  }
  for (std::size_t k = 0; k < FunctionalMemory::kCounters; ++k)
    hn::Store(counts[k], kWord, counters[k].data());
}

void writeNearer(std::span<const PixelRow> rows, const RowRules& rules, std::uint64_t* words,
                 FunctionalMemory::Counters& counters) {
  writeRows<false>(rows, rules, words, counters);
}

void writeBackground(std::span<const PixelRow> rows, const RowRules& rules, std::uint64_t* words,
                     FunctionalMemory::Counters& counters) {
  writeRows<true>(rows, rules, words, counters);
}

}  // namespace
}  // namespace deltaz::ars::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace deltaz::ars {

HWY_EXPORT(writeNearer);
HWY_EXPORT(writeBackground);

FunctionalMemory::FunctionalMemory(std::span<std::uint64_t> words, TieRule ties, int depth_mantissa_bits)
    : words_(words),
      ties_(ties),
      exponent_shift_(kColorBits + depth_mantissa_bits),
      module_(words.first(kWords), ties, depth_mantissa_bits),
      rows_(kScreenLines) {}

void FunctionalMemory::write(std::span<const PixelPacket> pixels) {
  for (const PixelPacket& pixel : pixels) {
    module_.write(static_cast<std::uint32_t>(pixel.i * kScreenPixels + pixel.j),
                  memoryWord(pixel.depth, pixel.color), pixel.background);
  }
}

void FunctionalMemory::write(const TilerSetup& setup, const NumberProfile& numbers) {
  if (setup.single_precision) return writeRows(setup, SingleAccumulator(setup, numbers));
  room_.clear();
  tileTriangle(setup, numbers, room_);
  write(room_);
}

void FunctionalMemory::writeRows(const TilerSetup& setup, const SingleAccumulator& accumulator) {
  std::size_t count = 0;
  const bool ascending = setup.j_step > 0;
  const TilingCounts counts = forEachSpan(setup, [&](int line, StepSpan span) {
    const SingleAccumulator::Line begin = accumulator.line(line);
    const int step = ascending ? span.first : span.last;
    const auto place = static_cast<std::uint32_t>((setup.i_start + line * setup.i_step) * kScreenPixels +
                                                  setup.j_start + step * setup.j_step);
    // Triangles come from anywhere in the picture; its words are on their way while the rest is set up.
    hwy::Prefetch(words_.data() + place);
    rows_[count++] = {.place = place,
                      .count = span.last - span.first + 1,
                      .first_step = static_cast<float>(step),
                      .depth = begin.depth,
                      .color = begin.color};
  });
  const RowRules rules{.steps = accumulator.steps(),
                       .direction = static_cast<float>(setup.j_step),
                       .tie_shift = ties_ == TieRule::kFirstStays ? kColorBits : 0,
                       .exponent_shift = exponent_shift_};
  const std::span<const PixelRow> rows(rows_.data(), count);
  const auto pixels = static_cast<std::uint64_t>(counts.tiled);
  if (setup.background) {
    background_ += pixels;
    HWY_DYNAMIC_DISPATCH(writeBackground)(rows, rules, words_.data(), counters_);
  } else {
    pixels_ += pixels;
    HWY_DYNAMIC_DISPATCH(writeNearer)(rows, rules, words_.data(), counters_);
  }
}

MemoryCounts FunctionalMemory::counts() const {
  const auto total = [&](Counter counter) {
    return static_cast<std::int64_t>(
        std::accumulate(counters_[counter].begin(), counters_[counter].end(), std::uint64_t{0}));
  };
  MemoryCounts counts = module_.counts();
  const auto add = [&](MemoryCycle cycle, std::int64_t more) {
    counts.cycles[static_cast<std::size_t>(cycle)] += more;
  };
  const std::int64_t first_time = total(kUninitialized), same = total(kSameExponent),
                     written = total(kWritten);
  const std::int64_t same_written = total(kSameExponentWritten),
                     compared = static_cast<std::int64_t>(pixels_) - first_time;
  add(MemoryCycle::kBackground, static_cast<std::int64_t>(background_));
  add(MemoryCycle::kInitialize, first_time);
  add(MemoryCycle::kReadCompareWrite, same_written);
  add(MemoryCycle::kReadCompareNoWrite, same - same_written);
  add(MemoryCycle::kLookAheadWrite, written - same_written);
  add(MemoryCycle::kLookAheadNoWrite, compared - same - (written - same_written));
  counts.ties += total(kTies);
  counts.split_ties += total(kSplitTies);
  return counts;
}

}  // namespace deltaz::ars
#endif
