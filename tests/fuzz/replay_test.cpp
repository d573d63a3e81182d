// Runs every fuzz target on its seeds, on every prefix of the small ones, and on random mutations of them.
// The random numbers are the same in every run: what fails here fails again.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "tests/fuzz/targets.h"

namespace deltaz {
namespace {

// How many mutations of each target; DELTAZ_FUZZ_MUTATIONS asks for more.
int mutations() {
  const char* wanted = std::getenv("DELTAZ_FUZZ_MUTATIONS");
  return wanted != nullptr ? std::atoi(wanted) : 3000;
}

FuzzInput mutated(FuzzInput input, std::mt19937& random) {
  const auto below = [&](std::size_t limit) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(limit, 1));
  };
  static constexpr std::array<std::uint8_t, 6> kEdges = {0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF};
  for (std::size_t change = below(6) + 1; change > 0; --change) {
    const std::size_t at = below(input.size());
    switch (below(6)) {
      case 0:
        if (!input.empty()) input[at] ^= static_cast<std::byte>(1u << below(8));
        break;
      case 1:
        if (!input.empty()) input[at] = static_cast<std::byte>(random() & 0xFF);
        break;
      case 2:
        if (!input.empty()) input[at] = static_cast<std::byte>(kEdges[below(kEdges.size())]);
        break;
      case 3:
        if (below(4) == 0) input.resize(at);
        break;
      case 4:
        for (int i = 0; i < 4; ++i) {
          input.insert(input.begin() + static_cast<std::ptrdiff_t>(at),
                       static_cast<std::byte>(random() & 0xFF));
        }
        break;
      default:
        // A run of equal bytes, as wide as a field.
        for (std::size_t i = at; i < std::min(input.size(), at + 8); ++i) input[i] = std::byte{0xFF};
    }
  }
  return input;
}

class Replay : public testing::TestWithParam<FuzzTarget> {};

TEST_P(Replay, seeds_and_their_prefixes_break_no_promise) {
  for (const FuzzInput& seed : GetParam().seeds()) {
    GetParam().run(seed);
    const std::size_t step = std::max<std::size_t>(1, seed.size() / 500);
    for (std::size_t length = 0; length < seed.size(); length += step) {
      // An exactly sized copy, so that a sanitizer sees the first byte read past the end.
      const FuzzInput prefix(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(length));
      GetParam().run(prefix);
    }
  }
}

TEST_P(Replay, random_mutations_break_no_promise) {
  std::mt19937 random(20240229);
  const std::vector<FuzzInput> seeds = GetParam().seeds();
  for (int i = 0; i < mutations() / GetParam().cost; ++i)
    GetParam().run(mutated(seeds[static_cast<std::size_t>(i) % seeds.size()], random));
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, testing::ValuesIn(fuzzTargets().begin(), fuzzTargets().end()),
                         [](const auto& information) { return std::string(information.param.name); });

}  // namespace
}  // namespace deltaz
