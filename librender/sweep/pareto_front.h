// Which of several settings are worth having: those that no other beats in both cost and error.
// Thread-safety: pure function.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace deltaz {

struct CostAndError {
  double cost = 0, error = 0;
};

// Indices of the points that no other point is both at most as dear and at most as wrong as; the cheapest
// first, so errors fall along the front. Of equal points the first one stands for all. Points that are not
// finite are on no front.
std::vector<std::size_t> paretoFront(std::span<const CostAndError> points);

}  // namespace deltaz
