// One depth/frame memory module (report 4.1): words of 24 bits of depth, 8 of colour and an INIT flag, and
// the decision which of seven cycles a pixel takes.
//
//   background flag       write; the INIT flag stays as it is
//   else INIT clear       write, set INIT
//   else exponents differ nearer: look-ahead write, farther: look-ahead no-write
//   else                  nearer by its mantissa: read-compare write, else read-compare no-write
//   read                  gives the colour and clears INIT; depth and colour stay
//
// So a word written by BG alone is overwritten by any later pixel, and one that nothing writes shows the
// picture before. Of equal depths the first to arrive stays, which makes a picture depend on the order of
// arrival where surfaces of different colours meet; TieRule::kBrighter, ours, takes the greater colour
// instead and with it no order changes a picture.
//
// Cost: a few nanoseconds a pixel. Thread-safety: one thread a module.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "librender/ars/memory/memory_cycles.h"
#include "librender/ars/words/pixel_packet.h"

namespace deltaz::ars {

inline constexpr int kDepthMantissaBits = 19;                        // below 5 bits of exponent
inline constexpr int kMemoryWordBits = kDepthBits + kColorBits + 1;  // 33

enum class TieRule : std::uint8_t { kFirstStays, kBrighter };
std::string_view tieRuleName(TieRule rule);  // "first", "brighter"
std::optional<TieRule> tieRuleNamed(std::string_view name);

// Depth above colour: two words compare as their depths, and as their colours where these are equal. There is
// room for depths of 32 bits, for studies of wider formats, and for the INIT flag above them.
constexpr std::uint64_t memoryWord(std::uint32_t depth, std::uint8_t color) {
  return std::uint64_t{depth} << kColorBits | color;
}

struct MemoryCounts {
  CycleCounts cycles{};
  std::int64_t ties = 0;        // pixels as near as what was there
  std::int64_t split_ties = 0;  // of these, those of another colour: if none, order changed nothing

  std::int64_t writes() const;  // cycles but READ
  MemoryCounts& operator+=(const MemoryCounts& other);
};

inline constexpr std::uint64_t kInitFlag = std::uint64_t{1} << 63;

class MemoryModule {
 public:
  // `store` outlives the module. Modules may share one if no two use the same words of it: a picture kept in
  // one piece is read and written faster than in interleaved parts. `depth_mantissa_bits`: the exponent that
  // is compared first stands above them.
  explicit MemoryModule(std::span<std::uint64_t> store, TieRule ties = TieRule::kFirstStays,
                        int depth_mantissa_bits = kDepthMantissaBits)
      : store_(store), ties_(ties), exponent_shift_(kColorBits + depth_mantissa_bits) {}

  // A pixel arrives: `word` as memoryWord makes it. The cycle that it takes.
  MemoryCycle write(std::uint32_t address, std::uint64_t word, bool background) {
    const MemoryCycle cycle = decide(address, word, background);
    ++counts_.cycles[static_cast<std::size_t>(cycle)];
    return cycle;
  }

  // What the antialiaser gets.
  std::uint8_t read(std::uint32_t address) {
    store_[address] &= ~kInitFlag;
    ++counts_.cycles[static_cast<std::size_t>(MemoryCycle::kRead)];
    return color(address);
  }

  // Looking changes nothing and takes no cycle.
  std::uint8_t color(std::uint32_t address) const { return static_cast<std::uint8_t>(store_[address]); }
  std::uint32_t depth(std::uint32_t address) const {
    return static_cast<std::uint32_t>((store_[address] & ~kInitFlag) >> kColorBits);
  }
  bool initialized(std::uint32_t address) const { return (store_[address] & kInitFlag) != 0; }

  const MemoryCounts& counts() const { return counts_; }
  void clearCounts() { counts_ = {}; }

 private:
  MemoryCycle decide(std::uint32_t address, std::uint64_t word, bool background) {
    std::uint64_t& held_and_flag = store_[address];
    if (background) {
      held_and_flag = word | (held_and_flag & kInitFlag);
      return MemoryCycle::kBackground;
    }
    if ((held_and_flag & kInitFlag) == 0) {
      held_and_flag = word | kInitFlag;
      return MemoryCycle::kInitialize;
    }
    const std::uint64_t held = held_and_flag & ~kInitFlag;
    const std::uint64_t exponent = word >> exponent_shift_, held_exponent = held >> exponent_shift_;
    if (exponent != held_exponent) {
      if (exponent < held_exponent) return MemoryCycle::kLookAheadNoWrite;
      held_and_flag = word | kInitFlag;
      return MemoryCycle::kLookAheadWrite;
    }
    const std::uint64_t depth = word >> kColorBits, held_depth = held >> kColorBits;
    if (depth == held_depth) {
      ++counts_.ties;
      if (word != held) ++counts_.split_ties;
      if (ties_ == TieRule::kFirstStays || word <= held) return MemoryCycle::kReadCompareNoWrite;
    } else if (depth < held_depth) {
      return MemoryCycle::kReadCompareNoWrite;
    }
    held_and_flag = word | kInitFlag;
    return MemoryCycle::kReadCompareWrite;
  }

  std::span<std::uint64_t> store_;
  TieRule ties_;
  int exponent_shift_;
  MemoryCounts counts_;
};

}  // namespace deltaz::ars
