// From stored values to heights: which posts are void, and of which kind; which quantum loses nothing.
// Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "libdb/source/elevation_source.h"
#include "libdb/source/stored_values.h"

namespace deltaz {

// A float rounding of the source is kept at 1 cm where no quantum of at least 1 mm is exact.
inline constexpr Rational kCoarseQuantum{1, 100};    // metres
inline constexpr double kFinestExactQuantum = 1e-3;  // metres
// A value that is a customary sentinel is taken for one if every neighbour of every such post is this far.
inline constexpr double kImplausibleJump = 500;  // metres
// A customary sentinel without neighbours is taken for one if it is no height on Earth.
inline constexpr double kImplausibleHeight = 12000;  // metres
// Heights beyond these are kept with a warning.
inline constexpr double kLowestOnEarth = -12000, kHighestOnEarth = 9000;  // metres

// The stored values of a raster, row by row from the south-west. Whole numbers of 32 bits are kept as such:
// large DEMs are of that kind.
struct PostValues {
  std::vector<std::int32_t> integers;
  std::vector<double> numbers;
  std::size_t size() const { return integers.empty() ? numbers.size() : integers.size(); }
  double operator[](std::size_t k) const {
    return integers.empty() ? numbers[k] : static_cast<double>(integers[k]);
  }
};

struct PostMeaning {
  SourceDescription source;  // its nodata is the one that counts
  StoredType type;
  Rational unit;  // metres in a unit of the source's elevations
  std::optional<Rational> quantum;
  std::string path;
};

// A customary value for void that the type can hold and `used` denies of every post. kInvalid if there is
// none.
Result<double> unusedStoredValue(const StoredType& type, const std::string& path,
                                 const std::function<bool(double)>& used);

// Fills heights, valid, void_kinds and the header's quantum, sentinels and height_error. `masked` is 1 where
// a mask of the source says void; empty if it has none. Where a mask and no nodata says void, meaning.source
// gets a nodata value that no post has, since a mask does not outlast the import.
Status interpretPosts(PostValues values, const std::vector<std::uint8_t>& masked, PostMeaning& meaning,
                      RawGrid& grid, std::vector<std::string>& warnings);

}  // namespace deltaz
