#include "libdb/build/area_seams.h"

#include <array>
#include <fmt/format.h>
#include <set>
#include <tuple>

#include "libdb/access/grid_locator.h"
#include "libdb/access/seam_geometry.h"
#include "libdb/build/seam_builder.h"

namespace deltaz {

namespace {

// Which part of a seam's edge a further grid's valid faces cover.
enum class Cover : std::uint8_t { kNone, kSome, kAll };

Cover coverOf(const Seam& seam, std::span<const RawGrid> grids, std::size_t by) {
  const RawGrid& lower = grids[seam.lower];
  const GridGeometry lower_geometry(lower.header, lower.patches);
  const RawGrid& cover = grids[by];
  const GridGeometry cover_geometry(cover.header, cover.patches);
  const GridLocator locator(cover_geometry);
  std::size_t covered = 0, points = 0;
  for (const SeamVertex& vertex : seam.vertices) {
    if (vertex.side != SeamSide::kLower) continue;
    ++points;
    const Vector3 p0 = lower_geometry.placeAt(vertex.column, vertex.row).foot;
    const Vector3 p1 =
        lower_geometry.placeAt(vertex.column + vertex.to_p1[0], vertex.row + vertex.to_p1[1]).foot;
    const Vector3 p2 =
        lower_geometry.placeAt(vertex.column + vertex.to_p2[0], vertex.row + vertex.to_p2[1]).foot;
    const auto place = locator.locate(p0 + (p1 - p0) * vertex.weight1 + (p2 - p0) * vertex.weight2);
    const GridHeader& header = cover.header;
    if (!place || place->column < header.x_axis.first || place->row < header.y_axis.first ||
        place->column + 1 >= header.x_axis.first + header.x_axis.count ||
        place->row + 1 >= header.y_axis.first + header.y_axis.count)
      continue;
    const auto valid = [&](std::int64_t di, std::int64_t dj) {
      return cover.isValid(place->column + di - header.x_axis.first, place->row + dj - header.y_axis.first);
    };
    const bool face = place->x >= place->y ? valid(1, 0) : valid(0, 1);
    if (valid(0, 0) && valid(1, 1) && face) ++covered;
  }
  return covered == 0 ? Cover::kNone : covered == points ? Cover::kAll : Cover::kSome;
}

// The face of which grid is replaced; no two seams may name the same.
using FaceName = std::tuple<std::uint16_t, std::int64_t, std::int64_t, bool>;

}  // namespace

Result<std::vector<Seam>> makeSeams(std::span<const RawGrid> grids) {
  std::vector<Seam> seams;
  std::set<FaceName> replaced;
  const auto meeting = [&](std::size_t a, std::size_t b, std::size_t c) {
    const auto name = [&](std::size_t grid) {
      const auto& sources = grids[grid].header.sources;
      return sources.empty() ? fmt::format("grid {}", grid) : sources.front().name;
    };
    return invalidError(
        IssueCode::kNone, "sources",
        fmt::format("the grids of {}, {} and {} meet at one place", name(a), name(b), name(c)),
        "only two grids can be joined along an edge",
        "Resample two of them onto one grid (--grid), or build them apart");
  };
  for (std::size_t upper = 0; upper < grids.size(); ++upper) {
    for (std::size_t lower = upper + 1; lower < grids.size(); ++lower) {
      DELTAZ_TRY_ASSIGN(std::optional<Seam> seam, makeSeam(grids[upper], static_cast<std::uint16_t>(upper),
                                                           grids[lower], static_cast<std::uint16_t>(lower)));
      if (!seam) continue;
      bool hidden = false;
      for (std::size_t other = 0; other < lower; ++other) {
        if (other == upper) continue;
        const Cover cover = coverOf(*seam, grids, other);
        if (cover == Cover::kSome) return meeting(upper, lower, other);
        hidden = hidden || cover == Cover::kAll;
      }
      if (hidden) continue;
      for (const SeamSide side : {SeamSide::kUpper, SeamSide::kLower}) {
        const std::uint16_t grid = gridOf(*seam, side);
        for (const ReplacedFace& face : seam->replacedOf(side)) {
          if (replaced.emplace(grid, face.row, face.column, face.top).second) continue;
          for (const Seam& before : seams) {
            if (before.upper == grid || before.lower == grid)
              return meeting(upper, lower, before.upper == grid ? before.lower : before.upper);
          }
        }
      }
      seams.push_back(std::move(*seam));
    }
  }
  return seams;
}

}  // namespace deltaz
