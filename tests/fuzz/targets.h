// What is fuzzed: functions that take any bytes and abort if a promise is broken. libFuzzer drives them with
// clang
// (-DDELTAZ_FUZZ=ON); a test replays seeds and random mutations of them with every compiler.
//
// Checksums would shield everything behind them from a fuzzer, so each target seals what it was given before
// it reads it, as far as that makes sense.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace deltaz {

using FuzzInput = std::vector<std::byte>;

struct FuzzTarget {
  const char* name;
  void (*run)(std::span<const std::byte> input);
  // Small sound inputs to start from.
  std::vector<FuzzInput> (*seeds)();
  // What a run costs, in terms of others: the test replays so many mutations less.
  int cost = 1;
};

std::span<const FuzzTarget> fuzzTargets();

}  // namespace deltaz
