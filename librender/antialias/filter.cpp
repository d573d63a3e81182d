#include "librender/antialias/filter.h"

#include <algorithm>
#include <cmath>

#include "librender/scene/exponential.h"

namespace deltaz {
namespace {

double mitchell(double x) {
  constexpr double kB = 1.0 / 3, kC = 1.0 / 3;
  if (x < 1)
    return ((12 - 9 * kB - 6 * kC) * x * x * x + (-18 + 12 * kB + 6 * kC) * x * x + (6 - 2 * kB)) / 6;
  return ((-kB - 6 * kC) * x * x * x + (6 * kB + 30 * kC) * x * x + (-12 * kB - 48 * kC) * x +
          (8 * kB + 24 * kC)) /
         6;
}

}  // namespace

std::string_view filterName(FilterKind filter) {
  constexpr std::string_view kNames[] = {"box", "pyramid", "gaussian", "mitchell"};
  return kNames[static_cast<std::size_t>(filter)];
}

double filterRadius(FilterKind filter) {
  constexpr double kRadii[] = {0.5, 1, 1.5, 2};
  return kRadii[static_cast<std::size_t>(filter)];
}

double filterValue(FilterKind filter, double x) {
  x = std::abs(x);
  const double radius = filterRadius(filter);
  if (!(x < radius)) return 0;
  switch (filter) {
    case FilterKind::kBox:
      return 1;
    case FilterKind::kPyramid:
      return 1 - x;
    case FilterKind::kGaussian:
      return exponential(-2 * x * x) - exponential(-2 * radius * radius);
    case FilterKind::kMitchell:
      return mitchell(x);
  }
  return 0;
}

FilterKernel::FilterKernel(const Sampling& sampling)
    : reach_(static_cast<int>(std::ceil(filterRadius(sampling.filter) - 0.5))),
      samples_(static_cast<std::size_t>(sampling.count)) {
  const std::vector<SamplePlace> places = samplePlaces(sampling.count, sampling.pattern);
  for (int di = -reach_; di <= reach_; ++di) {
    for (int dj = -reach_; dj <= reach_; ++dj) {
      double all = 0;
      for (const SamplePlace& place : places) {
        weight_.push_back(filterValue(sampling.filter, dj + place.x / 256.0) *
                          filterValue(sampling.filter, di + place.y / 256.0));
        all += weight_.back();
      }
      all_.push_back(all);
    }
  }
}

double FilterKernel::sum(int j, int i, int width, int height) const {
  double sum = 0;
  for (int di = std::max(-reach_, -i); di <= std::min(reach_, height - 1 - i); ++di) {
    for (int dj = std::max(-reach_, -j); dj <= std::min(reach_, width - 1 - j); ++dj)
      sum += weightOfAll(dj, di);
  }
  return sum;
}

}  // namespace deltaz
