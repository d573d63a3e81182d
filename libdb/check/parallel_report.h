// Runs a rule over numbered items on several threads with the same report for any number of threads. Internal
// to libdb/check.
#pragma once

#include <algorithm>
#include <cstddef>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <utility>
#include <vector>

#include "libdb/check/report_detail.h"

namespace deltaz {

// Calls rule(item, report) for each item below `count`; findings come out in the order of the items. `grain`
// items share a partial report.
template <typename Rule>
void parallelReport(Report& report, std::size_t count, std::size_t grain, Rule rule) {
  // Parts are merged a round at a time, so that their number stays bounded however many items there are.
  constexpr std::size_t kPartsPerRound = 1024;
  for (std::size_t begin = 0; begin < count; begin += grain * kPartsPerRound) {
    const std::size_t end = std::min(count, begin + grain * kPartsPerRound);
    std::vector<Report> parts((end - begin + grain - 1) / grain);
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, parts.size(), 1),
                              [&](const auto& range) {
                                for (std::size_t part = range.begin(); part != range.end(); ++part) {
                                  const std::size_t first = begin + part * grain;
                                  for (std::size_t item = first; item < std::min(end, first + grain); ++item)
                                    rule(item, parts[part]);
                                }
                              });
    for (Report& part : parts) mergeReport(report, std::move(part));
  }
}

}  // namespace deltaz
