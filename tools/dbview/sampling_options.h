// How many samples a pixel has, where they lie and how they are weighted, as words of the command line.
#pragma once

#include <string>

#include "librender/antialias/filter.h"
#include "tools/common/command_line.h"

namespace deltaz {

// Of all pictures of a command; their number is an option of its own.
struct SamplingOptions {
  std::string pattern = "rotated", filter = "box";
};

void addSamplingOptions(CLI::App& app, SamplingOptions& options);

// The words are known to be right: CLI11 checks them.
Sampling parseSampling(const SamplingOptions& options);

// 1, 4, 16 or 64; anything else is kUsage.
Result<int> parseSampleCount(const std::string& text, const std::string& option);

}  // namespace deltaz
