// Least, median and most of repeated measurements. Thread-safety: pure function.
#pragma once

#include <vector>

namespace deltaz {

struct Spread {
  double minimum = 0, median = 0, maximum = 0;  // median of an even number: the mean of the middle two
};

// Pre: at least one value.
Spread spreadOf(std::vector<double> values);

}  // namespace deltaz
