#include "tests/librender/antialias/analytic_coverage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace deltaz {
namespace {

// Gauss-Legendre, ten points of [-1, 1]: abscissas and weights, both signs.
constexpr std::array<std::array<double, 2>, 5> kGauss = {{{0.1488743389816312, 0.2955242247147529},
                                                          {0.4333953941292472, 0.2692667193099963},
                                                          {0.6794095682990244, 0.2190863625159820},
                                                          {0.8650633666889845, 0.1494513491505806},
                                                          {0.9739065285171717, 0.0666713443086881}}};

template <typename Function>
double integral(double from, double to, const Function& function) {
  const double middle = (from + to) / 2, half = (to - from) / 2;
  double sum = 0;
  for (const auto& [x, weight] : kGauss)
    sum += weight * (function(middle - half * x) + function(middle + half * x));
  return sum * half;
}

// Integral of the filter from 0 to x, written out by hand and not from filterValue.
double primitive(FilterKind filter, double x) {
  const double sign = x < 0 ? -1 : 1, a = std::min(std::abs(x), filterRadius(filter));
  switch (filter) {
    case FilterKind::kBox:
      return sign * a;
    case FilterKind::kPyramid:
      return sign * (a - a * a / 2);
    case FilterKind::kGaussian:
      return sign *
             (std::sqrt(std::numbers::pi / 8) * std::erf(std::numbers::sqrt2 * a) - a * std::exp(-4.5));
    case FilterKind::kMitchell: {
      const auto inner = [](double t) {
        return 7.0 / 24 * t * t * t * t - 2.0 / 3 * t * t * t + 8.0 / 9 * t;
      };
      const auto outer = [](double t) {
        return -7.0 / 72 * t * t * t * t + 2.0 / 3 * t * t * t - 5.0 / 3 * t * t + 16.0 / 9 * t;
      };
      return sign * (a < 1 ? inner(a) : inner(1) + outer(a) - outer(1));
    }
  }
  return 0;
}

std::vector<double> knots(FilterKind filter) {
  const double radius = filterRadius(filter);
  std::vector<double> all = {-radius, radius};
  if (filter == FilterKind::kPyramid) all.push_back(0);
  if (filter == FilterKind::kGaussian) all.insert(all.end(), {-0.75, 0, 0.75});
  if (filter == FilterKind::kMitchell) all.insert(all.end(), {-1, 0, 1});
  return all;
}

}  // namespace

double analyticCoverage(const ConvexPolygon& polygon, FilterKind filter, int j, int i) {
  const double radius = filterRadius(filter);
  const std::size_t count = polygon.size();
  const auto edge = [&](std::size_t k) {
    const ScreenPoint &a = polygon[k], &b = polygon[(k + 1) % count];
    return std::array{ScreenPoint{a.x - j, a.y - i}, ScreenPoint{b.x - j, b.y - i}};
  };
  std::vector<double> breaks = knots(filter);
  const std::vector<double> in_x = breaks;
  for (std::size_t k = 0; k < count; ++k) {
    const auto [a, b] = edge(k);
    breaks.push_back(a.y);
    if (a.x == b.x) continue;
    for (const double x : in_x) {
      const double t = (x - a.x) / (b.x - a.x);
      if (t > 0 && t < 1) breaks.push_back(a.y + t * (b.y - a.y));
    }
  }
  for (double& y : breaks) y = std::clamp(y, -radius, radius);
  std::sort(breaks.begin(), breaks.end());
  const auto along = [&](double y) {
    double left = std::numeric_limits<double>::infinity(), right = -left;
    for (std::size_t k = 0; k < count; ++k) {
      const auto [a, b] = edge(k);
      if ((a.y > y) == (b.y > y)) continue;
      const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    if (!(left < right)) return 0.0;
    return primitive(filter, std::min(right, radius)) - primitive(filter, std::max(left, -radius));
  };
  double sum = 0;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    if (breaks[k + 1] - breaks[k] < 1e-12) continue;
    sum += integral(breaks[k], breaks[k + 1], [&](double y) { return along(y) * filterValue(filter, y); });
  }
  const double all = 2 * primitive(filter, radius);
  return sum / (all * all);
}

}  // namespace deltaz
