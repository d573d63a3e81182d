#include "librender/scene/synthetic_color.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace deltaz {
namespace {

struct SnowLineEntry {
  double latitude, height;
};
constexpr std::array<SnowLineEntry, 10> kSnowLine = {{{0, 4800},
                                                      {15, 5200},
                                                      {28, 5600},
                                                      {35, 4700},
                                                      {42, 3000},
                                                      {47, 2350},
                                                      {60, 1300},
                                                      {70, 600},
                                                      {80, 100},
                                                      {90, 0}}};

constexpr LinearColor kWater{0.020, 0.065, 0.130};
constexpr LinearColor kLowland{0.150, 0.205, 0.062};
constexpr LinearColor kForest{0.042, 0.094, 0.026};
constexpr LinearColor kMeadow{0.150, 0.175, 0.065};
constexpr LinearColor kScree{0.245, 0.215, 0.180};
constexpr LinearColor kRock{0.165, 0.145, 0.125};
constexpr LinearColor kSnow{0.860, 0.890, 0.930};

}  // namespace

double snowLine(double latitude_degrees) {
  const double latitude = std::abs(latitude_degrees);
  for (std::size_t entry = 1; entry < kSnowLine.size(); ++entry) {
    const SnowLineEntry &low = kSnowLine[entry - 1], &high = kSnowLine[entry];
    if (latitude > high.latitude) continue;
    const double t = (latitude - low.latitude) / (high.latitude - low.latitude);
    return low.height + (high.height - low.height) * t;
  }
  return 0;
}

LinearColor naturalColor(const SurfacePoint& point) {
  // Slopes turned away from the sun of most of the day keep snow, and lose trees, some 250 m lower.
  const double height = point.height + 500 * point.poleward;
  const double snow_line = point.snow_line;

  const double lowland_end = 0.16 * snow_line;
  LinearColor color = mix(kLowland, kForest, smoothStep(0.3 * lowland_end, lowland_end + 60, height));
  color = mix(color, kMeadow, smoothStep(snow_line - 1050, snow_line - 550, height));
  color = mix(color, kScree, smoothStep(snow_line - 500, snow_line - 100, height));

  // Trees hold on slopes that meadow and scree do not: the bare angle falls with height, from about 50 to 33
  // degrees.
  const double exposure = smoothStep(snow_line - 1500, snow_line, height);
  const double bare = 0.64 + 0.19 * exposure;
  color = mix(kRock, color, smoothStep(bare - 0.10, bare + 0.06, point.upness));

  // Snow slides off what is steeper than about 50 degrees; far above the line even steep faces carry some.
  const double above = smoothStep(snow_line - 150, snow_line + 450, height);
  const double hold = 0.72 - 0.17 * smoothStep(snow_line, snow_line + 1500, height);
  color = mix(color, kSnow, above * smoothStep(hold - 0.12, hold + 0.10, point.upness));

  const double level = smoothStep(0.99990, 0.99998, point.upness);
  return mix(color, kWater, level * (1 - smoothStep(0, 1, point.height)));
}

}  // namespace deltaz
