// The counters of a timed run as the control/status board gives them to the host: in the layout of the
// report's Tables 20 (memories) and 22 (tilers), and behind these what the model knows besides: the time of
// every unit by what it did, and every queue.
//
// JSON, one object: `configuration`; `duration_ps`, `reading_ps`, `barriers`, `pixels`, `pixels_per_cycle`;
// `memories[]` and `tilers[]`, a row of the tables each, with their times; `memory_totals`, `tiler_totals`;
// `tree` with `levels[]` of `inputs[]`, `buffers[]` and `queues[]` (`cycles_at_length[n]`: cycles with n
// pixels queued) and `outlets[]`. Times are picoseconds, those of the tree cycles of 100 ns; `busy`,
// `starved`, `blocked` and `lost` add up to the whole. Thread-safety: pure functions.
#pragma once

#include <string>

#include "librender/ars/machine/machine_configuration.h"
#include "librender/ars/machine/pass_statistics.h"

namespace deltaz::ars {

// Accesses a word, cut off behind the third digit as the report does.
double depthComplexity(std::int64_t cycles, std::int64_t words);

std::string statisticsText(const PassStatistics& statistics, const MachineConfiguration& configuration);
std::string statisticsJson(const PassStatistics& statistics, const MachineConfiguration& configuration);

}  // namespace deltaz::ars
