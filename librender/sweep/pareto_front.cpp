#include "librender/sweep/pareto_front.h"

#include <algorithm>
#include <cmath>

namespace deltaz {

std::vector<std::size_t> paretoFront(std::span<const CostAndError> points) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (std::isfinite(points[k].cost) && std::isfinite(points[k].error)) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].cost != points[b].cost ? points[a].cost < points[b].cost
                                            : points[a].error < points[b].error;
  });
  std::vector<std::size_t> front;
  for (const std::size_t k : order) {
    if (front.empty() || points[k].error < points[front.back()].error) front.push_back(k);
  }
  return front;
}

}  // namespace deltaz
