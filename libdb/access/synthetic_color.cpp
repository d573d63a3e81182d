#include "libdb/access/synthetic_color.h"

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
constexpr LinearColor kLowland{0.190, 0.235, 0.075};
constexpr LinearColor kForest{0.048, 0.105, 0.026};
constexpr LinearColor kUpperForest{0.036, 0.075, 0.030};
constexpr LinearColor kMeadow{0.190, 0.205, 0.070};
constexpr LinearColor kScree{0.270, 0.230, 0.190};
constexpr LinearColor kRock{0.170, 0.145, 0.120};
constexpr LinearColor kSnow{0.690, 0.715, 0.755};
constexpr LinearColor kFrostedForest{0.255, 0.290, 0.310};
constexpr LinearColor kIce{0.430, 0.500, 0.545};

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

  // Cleared land in the valleys, where it is level enough; forest, darker with height; meadow, scree.
  const double lowland_end = 0.30 * snow_line;
  const double level_ground = smoothStep(0.965, 0.995, point.upness);
  LinearColor color = mix(kForest, kUpperForest, smoothStep(0.3 * snow_line, 0.7 * snow_line, height));
  color = mix(color, kLowland, level_ground * (1 - smoothStep(0.5 * lowland_end, lowland_end + 60, height)));
  color = mix(color, kMeadow, smoothStep(snow_line - 1000, snow_line - 500, height));
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

LinearColor winterColor(const SurfacePoint& point) {
  const double height = point.height + 500 * point.poleward;
  const double winter_line = point.snow_line - kWinterDrop;
  // Snow lies thin at the line and holds on slopes as in summer; under trees half of it shows.
  const double snow =
      smoothStep(winter_line - 200, winter_line + 400, height) * smoothStep(0.50, 0.72, point.upness);
  const double open_height = smoothStep(point.snow_line - 1000, point.snow_line - 600, height);
  const double level_ground = smoothStep(0.965, 0.995, point.upness) *
                              (1 - smoothStep(0.15 * point.snow_line, 0.30 * point.snow_line + 60, height));
  const double open = 1 - (1 - open_height) * (1 - level_ground);
  const LinearColor white = mix(kFrostedForest, kSnow, open);
  const LinearColor color = mix(naturalColor(point), white, snow);
  const double water = smoothStep(0.99990, 0.99998, point.upness) * (1 - smoothStep(0, 1, point.height));
  const double frozen = 1 - smoothStep(300, 1500, winter_line);
  return mix(color, mix(kWater, kIce, frozen), water);
}

SurfacePoint surfacePoint(double height, const Vector3& normal, const Vector3& up, double latitude_degrees) {
  const double across = std::hypot(up.x, up.y);
  // North, in the plane of the axis and the vertical.
  const Vector3 north =
      across > 0 ? Vector3{-up.z * up.x / across, -up.z * up.y / across, across} : Vector3{-up.z, 0, 0};
  return {height, dot(normal, up), (up.z < 0 ? -1 : 1) * dot(normal, north), snowLine(latitude_degrees)};
}

}  // namespace deltaz
