// Every stress test says how close it came: prints what was observed beside the bound it must not exceed.
#pragma once

#include <cstdio>
#include <gtest/gtest.h>
#include <string>

namespace deltaz {

inline void expectWithin(const std::string& what, double observed, double bound) {
  std::printf("%-64s observed %-12.4g bound %-12.4g %s\n", what.c_str(), observed, bound,
              observed <= bound ? "" : "EXCEEDED");
  EXPECT_TRUE(observed <= bound) << what << ": observed " << observed << ", bound " << bound;
}

}  // namespace deltaz
