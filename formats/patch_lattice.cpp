#include "formats/patch_lattice.h"

#include <cmath>
#include <fmt/format.h>

#include "formats/bytes.h"

namespace deltaz {

namespace {

// No point of an ellipsoid area.json may name lies farther from its centre.
constexpr double kFarthest = 2e8;

}  // namespace

std::vector<std::byte> encodePatchRow(std::span<const double> row) {
  ByteWriter writer;
  for (const double coordinate : row) writer.put(coordinate);
  return writer.take();
}

Result<std::vector<double>> decodePatchRow(std::span<const std::byte> bytes, std::int64_t points,
                                           const std::string& where) {
  const std::size_t numbers = static_cast<std::size_t>(points) * 3;
  if (bytes.size() != numbers * sizeof(double)) {
    return invalidError(IssueCode::kHgtPatches, where,
                        fmt::format("{} bytes are not {} control points", bytes.size(), points));
  }
  std::vector<double> row;
  row.reserve(numbers);
  ByteReader reader(bytes);
  for (std::size_t k = 0; k < numbers; ++k) {
    row.push_back(reader.get<double>());
    if (!(std::abs(row.back()) <= kFarthest))
      return invalidError(IssueCode::kHgtPatches, where, "a control point is nowhere near the Earth");
  }
  return row;
}

}  // namespace deltaz
