#include "tools/dbview/sampling_options.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <vector>

namespace deltaz {

void addSamplingOptions(CLI::App& app, SamplingOptions& options) {
  std::vector<std::string> filters;
  for (const FilterKind filter : kFilterKinds) filters.emplace_back(filterName(filter));
  app.add_option(
         "--filter", options.filter,
         "How samples are weighted: box, a pixel wide; pyramid, two pixels, as in 1983; gaussian, three; "
         "mitchell, four (default: box)")
      ->check(CLI::IsMember(filters))
      ->type_name("FILTER");
  app.add_option(
         "--pattern", options.pattern,
         "Where the samples of a pixel lie: rotated, each in a column and row of its own, or ordered, on "
         "a regular grid (default: rotated)")
      ->check(CLI::IsMember({"ordered", "rotated"}))
      ->type_name("PATTERN");
}

Sampling parseSampling(const SamplingOptions& options) {
  Sampling sampling;
  sampling.pattern = options.pattern == "ordered" ? SamplePattern::kOrdered : SamplePattern::kRotated;
  sampling.filter = *std::find_if(kFilterKinds.begin(), kFilterKinds.end(),
                                  [&](FilterKind filter) { return filterName(filter) == options.filter; });
  return sampling;
}

Result<int> parseSampleCount(const std::string& text, const std::string& option) {
  const auto count = std::find_if(std::begin(kSampleCounts), std::end(kSampleCounts),
                                  [&](int each) { return std::to_string(each) == text; });
  if (count == std::end(kSampleCounts))
    return usageError(option, fmt::format("'{}' is none of 1, 4, 16, 64", text), {},
                      "Give one of these numbers of samples a pixel");
  return *count;
}

}  // namespace deltaz
