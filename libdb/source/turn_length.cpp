#include "libdb/source/turn_length.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libdb/source/gdal_session.h"

namespace deltaz {

double turnLength(const ReferenceSystem& system) {
  if (!system.projected) return 360;
  const GdalSession session;
  const auto geographic = geographicOf(system, {});
  if (!geographic.ok()) return 0;
  const auto change = CoordinateChange::between(geographic.value(), system, true, {});
  if (!change.ok()) return 0;
  // Along two parallels, east in equal steps: in a cylindrical projection the coordinate grows by as much
  // each time, but for one jump back by a turn.
  constexpr int kSteps = 15;
  constexpr double kStart = -172.7, kTolerance = 1e-6;
  double turn = 0;
  for (const double latitude : {0.0, 40.0}) {
    std::vector<double> x, y(kSteps, latitude);
    for (int k = 0; k < kSteps; ++k) x.push_back(kStart + 360.0 / kSteps * k);
    if (!change.value().apply(x, y)) return 0;
    std::vector<double> steps;
    for (int k = 1; k < kSteps; ++k)
      steps.push_back(x[static_cast<std::size_t>(k)] - x[static_cast<std::size_t>(k - 1)]);
    std::sort(steps.begin(), steps.end());
    const double step = steps[steps.size() / 2], length = step * kSteps;
    if (!(length > 0) || (turn > 0 && std::abs(length - turn) > kTolerance * turn)) return 0;
    for (int k = 0; k < kSteps; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double off = std::remainder(x[at] - x[0] - k * step, length);
      if (std::abs(off) > kTolerance * length || std::abs(y[at] - y[0]) > kTolerance * length) return 0;
    }
    turn = length;
  }
  return turn;
}

}  // namespace deltaz
