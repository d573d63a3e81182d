#include "librender/ars/experiments/depth_resolution.h"

#include <cmath>
#include <fmt/format.h>

namespace deltaz::ars {

double depthResolution(const DepthFormat& format, double u) {
  const std::uint32_t word = format.encode(1 / u, Rounding::kNearest);
  return (1 / format.decode(word - 1) - 1 / format.decode(word + 1)) / 4;
}

std::vector<ReportRow> table2Rows() {
  const DepthFormat format;
  std::vector<ReportRow> rows;
  for (const int kilometres : {1, 10, 50}) {
    const double u = 1000.0 * kilometres;
    // The formula is the mean over an octave's ends: units are as large at its one end as twice at the other.
    double largest = 0;
    for (double at = u; at > u / 2; at *= 0.98) largest = std::max(largest, depthResolution(format, at) / at);
    rows.push_back(
        {fmt::format("table2.inverse_float.{}km", kilometres),
         fmt::format("1/U in floating point, 19 bits of mantissa: resolution at {} km, metres, at most",
                     kilometres),
         u * std::ldexp(1, -(format.mantissa_bits + 1)), largest * u,
         "the leading one is not counted; if it were, twice as much"});
  }
  return rows;
}

}  // namespace deltaz::ars
