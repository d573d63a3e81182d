#include "libdb/access/synthetic_color.h"

#include <array>
#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libdb/access/synthetic_color.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef DELTAZ_SYNTHETIC_COLOR_PALETTE
#define DELTAZ_SYNTHETIC_COLOR_PALETTE
namespace deltaz {
namespace {

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
}  // namespace deltaz
#endif

HWY_BEFORE_NAMESPACE();
namespace deltaz {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

V set(double value) {
  const D d;
  return hn::Set(d, value);
}

// smoothStep of libdb/access/color.h, operation by operation. Most points lie beyond one of the ends, where
// nothing needs dividing.
V smoothSteps(V low, V high, V x) {
  const auto below = hn::Le(x, low), above = hn::Ge(x, high);
  const D d;
  const V end = hn::IfThenElse(below, hn::Zero(d), set(1.0));
  V t = end;
  if (!hn::AllTrue(d, hn::Or(below, above)))
    t = hn::IfThenElse(hn::Or(below, above), end, hn::Div(hn::Sub(x, low), hn::Sub(high, low)));
  return hn::Mul(hn::Mul(t, t), hn::Sub(set(3.0), hn::Mul(set(2.0), t)));
}

struct Colors {
  V red, green, blue;
};

Colors mixed(const Colors& a, const Colors& b, V t) {
  const V s = hn::Sub(set(1.0), t);
  return {hn::Add(hn::Mul(a.red, s), hn::Mul(b.red, t)), hn::Add(hn::Mul(a.green, s), hn::Mul(b.green, t)),
          hn::Add(hn::Mul(a.blue, s), hn::Mul(b.blue, t))};
}

Colors everywhere(const LinearColor& color) {
  return {set(color.red), set(color.green), set(color.blue)};
}

// naturalColor below, operation by operation.
void naturalColorList(const SurfacePointLists& points, std::size_t count, const ColorLists& colors) {
  const D d;
  const V one = set(1.0);
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const V own_height = hn::LoadU(d, points.height + k), upness = hn::LoadU(d, points.upness + k);
    const V snow_line = hn::LoadU(d, points.snow_line + k);
    const V height = hn::Add(own_height, hn::Mul(set(500), hn::LoadU(d, points.poleward + k)));
    const auto line = [&](double metres) { return hn::Add(snow_line, set(metres)); };

    const V lowland_end = hn::Mul(set(0.30), snow_line);
    const V level_ground = smoothSteps(set(0.965), set(0.995), upness);
    Colors color = mixed(everywhere(kForest), everywhere(kUpperForest),
                         smoothSteps(hn::Mul(set(0.3), snow_line), hn::Mul(set(0.7), snow_line), height));
    const V high_ground = smoothSteps(hn::Mul(set(0.5), lowland_end), hn::Add(lowland_end, set(60)), height);
    color = mixed(color, everywhere(kLowland), hn::Mul(level_ground, hn::Sub(one, high_ground)));
    color = mixed(color, everywhere(kMeadow), smoothSteps(line(-1000), line(-500), height));
    color = mixed(color, everywhere(kScree), smoothSteps(line(-500), line(-100), height));

    const V exposure = smoothSteps(line(-1500), snow_line, height);
    const V bare = hn::Add(set(0.64), hn::Mul(set(0.19), exposure));
    color = mixed(everywhere(kRock), color,
                  smoothSteps(hn::Sub(bare, set(0.10)), hn::Add(bare, set(0.06)), upness));

    const V above = smoothSteps(line(-150), line(450), height);
    const V hold = hn::Sub(set(0.72), hn::Mul(set(0.17), smoothSteps(snow_line, line(1500), height)));
    color = mixed(color, everywhere(kSnow),
                  hn::Mul(above, smoothSteps(hn::Sub(hold, set(0.12)), hn::Add(hold, set(0.10)), upness)));

    const V level = smoothSteps(set(0.99990), set(0.99998), upness);
    const V dry = smoothSteps(set(0), set(1), own_height);
    color = mixed(color, everywhere(kWater), hn::Mul(level, hn::Sub(one, dry)));
    hn::StoreU(color.red, d, colors.red + k);
    hn::StoreU(color.green, d, colors.green + k);
    hn::StoreU(color.blue, d, colors.blue + k);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace deltaz
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
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

namespace {

HWY_EXPORT(naturalColorList);

}  // namespace

void naturalColors(const SurfacePointLists& points, std::size_t count, const ColorLists& colors) {
  HWY_DYNAMIC_DISPATCH(naturalColorList)(points, count, colors);
}

}  // namespace deltaz
#endif
