#include "librender/antialias/sample_pattern.h"

#include <algorithm>
#include <cstddef>

namespace deltaz {
namespace {

constexpr int kBlock = 4;    // cells a side that have offsets of their own
constexpr int kUnits = 256;  // of a cell, and of a pixel

// Within groups of `side` x `side` cells the sample of column a and row b is in the b-th of `side` parts of
// its column, from the left, and in the a-th of its row, from below: a grid turned by the angle whose tangent
// is 1 / side.
constexpr SampleOffsets turnedGrid(int side) {
  SampleOffsets offsets{};
  const int part = kUnits / side;
  for (int i = 0; i < kBlock; ++i) {
    for (int j = 0; j < kBlock; ++j) {
      const int a = j % side, b = i % side;
      const auto k = static_cast<std::size_t>(i * kBlock + j);
      offsets.x[k] = b * part + part / 2 - kUnits / 2;
      offsets.y[k] = (side - 1 - a) * part + part / 2 - kUnits / 2;
    }
  }
  offsets.reach = kUnits / 2 - part / 2;
  return offsets;
}

constexpr SampleOffsets kTurnedPairs = turnedGrid(2);
constexpr SampleOffsets kTurnedFours = turnedGrid(4);

}  // namespace

std::string_view samplePatternName(SamplePattern pattern) {
  return pattern == SamplePattern::kOrdered ? "ordered" : "rotated";
}

int samplesAcross(int count) {
  return count == 64 ? 8 : count == 16 ? 4 : count == 4 ? 2 : 1;
}

const SampleOffsets* sampleOffsets(int count, SamplePattern pattern) {
  if (pattern == SamplePattern::kOrdered || count == 1) return nullptr;
  return count == 4 ? &kTurnedPairs : &kTurnedFours;
}

std::vector<SamplePlace> samplePlaces(int count, SamplePattern pattern) {
  const int across = samplesAcross(count);
  const SampleOffsets* const offsets = sampleOffsets(count, pattern);
  std::vector<SamplePlace> places;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      const auto k = static_cast<std::size_t>((i % kBlock) * kBlock + j % kBlock);
      // From the middle of the grid's first cell to the pixel's centre are (across - 1) / 2 cells. All
      // offsets are multiples of 32, so that nothing is lost.
      const auto place = [&](int cell, std::int32_t moved) {
        return ((2 * cell + 1 - across) * (kUnits / 2) + moved) / across;
      };
      places.push_back({place(j, offsets == nullptr ? 0 : offsets->x[k]),
                        place(i, offsets == nullptr ? 0 : offsets->y[k])});
    }
  }
  return places;
}

int centralSample(const std::vector<SamplePlace>& places) {
  const auto nearest =
      std::min_element(places.begin(), places.end(), [](const SamplePlace& a, const SamplePlace& b) {
        return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
      });
  return static_cast<int>(nearest - places.begin());
}

}  // namespace deltaz
