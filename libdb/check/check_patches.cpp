// The control points of a projected grid: on the ellipsoid area.json names, and as smooth as a map is.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <string>

#include "libdb/check/check_geometry.h"
#include "libdb/check/report_detail.h"
#include "libdb/source/gdal_session.h"
#include "libdb/source/reference_system.h"

namespace deltaz {
namespace {

constexpr double kRounding = 1e-6;  // metres
// A map bends over distances like the Earth's radius R in its own plane: a fourth difference of exact
// positions s apart on the Earth, and m on the map, is about s (m / R)^3. Near the edge of a map's use, where
// s may be far smaller than m, by some tens more.
constexpr double kDistortion = 100;
// The weights of a fourth difference, 1 -4 6 -4 1, add up to this.
constexpr double kWeights = 16;

class PatchRule {
 public:
  PatchRule(CheckContext& context, std::uint16_t grid, const PatchLattice& lattice)
      : context_(context),
        grid_(grid),
        ellipsoid_(context.grids[grid].header().ellipsoid),
        lattice_(lattice) {
    const GridHeader& header = context.grids[grid].header();
    const Result<ReferenceSystem> system =
        parseReferenceSystem(header.crs_wkt, std::string(kAreaFileName), header.coordinate_epoch);
    if (!system.ok()) return;
    const double metres = system.value().projected ? system.value().metres_per_unit
                                                   : ellipsoid_.semi_major_axis * std::numbers::pi / 180;
    const auto step = static_cast<double>(lattice.step());
    map_step_ = {step * header.x_axis.spacing * metres, step * header.y_axis.spacing * metres};
  }

  void run() {
    bool all_on_ellipsoid = true;
    for (std::int64_t row = 0; row < lattice_.pointRows(); ++row) {
      for (std::int64_t column = 0; column < lattice_.pointColumns(); ++column)
        all_on_ellipsoid = checkHeight(column, row) && all_on_ellipsoid;
    }
    // A point beside the ellipsoid is not smooth either; once is enough.
    if (!all_on_ellipsoid) return;
    for (std::int64_t row = 0; row < lattice_.pointRows(); ++row)
      checkLine({0, row}, {1, 0}, lattice_.pointColumns());
    for (std::int64_t column = 0; column < lattice_.pointColumns(); ++column)
      checkLine({column, 0}, {0, 1}, lattice_.pointRows());
  }

 private:
  Vector3 point(std::int64_t column, std::int64_t row) const {
    const auto i = static_cast<std::size_t>((row * lattice_.pointColumns() + column) * 3);
    return {lattice_.controls[i], lattice_.controls[i + 1], lattice_.controls[i + 2]};
  }

  void complain(std::int64_t column, std::int64_t row, std::string message, double metres) {
    IssueLocation where;
    for (const CheckedFile& file : context_.listed) {
      if (file.reference.role == FileRole::kPatches && file.reference.segment == grid_)
        where.file = file.reference.name;
    }
    where.block = static_cast<std::uint32_t>(row);
    context_.report.add(makeIssue(IssueCode::kHgtPatches,
                                  fmt::format("control point ({}, {}) {}", column, row, message), where,
                                  metres));
  }

  bool checkHeight(std::int64_t column, std::int64_t row) {
    const double height = std::abs(toGeodetic(ellipsoid_, point(column, row)).height);
    if (height <= lattice_.placement.error + kRounding) return true;
    complain(column, row, fmt::format("lies {:.6f} m beside the ellipsoid", height), height);
    return false;
  }

  // Fourth differences along a row or a column of points.
  void checkLine(std::array<std::int64_t, 2> start, std::array<std::int64_t, 2> step, std::int64_t count) {
    constexpr std::array<double, 5> kBinomial = {1, -4, 6, -4, 1};
    for (std::int64_t first = 0; first + 4 < count; ++first) {
      const auto at = [&](std::int64_t k) {
        return point(start[0] + (first + k) * step[0], start[1] + (first + k) * step[1]);
      };
      Vector3 difference;
      double apart = 0;
      for (std::int64_t k = 0; k < 5; ++k) {
        difference = difference + at(k) * kBinomial[static_cast<std::size_t>(k)];
        if (k > 0) apart = std::max(apart, length(at(k) - at(k - 1)));
      }
      const double radius = ellipsoid_.semi_major_axis;
      const double on_map = std::max(apart, map_step_[step[0] != 0 ? 0 : 1]);
      const double most = kWeights * (lattice_.placement.error + kRounding) +
                          kDistortion * apart * std::pow(on_map / radius, 3);
      if (length(difference) <= most) continue;
      complain(start[0] + (first + 2) * step[0], start[1] + (first + 2) * step[1],
               fmt::format("is out of line with its neighbours by about {:.6f} m", length(difference) / 6),
               length(difference) / 6);
      return;
    }
  }

  CheckContext& context_;
  std::uint16_t grid_;
  EllipsoidShape ellipsoid_;
  const PatchLattice& lattice_;
  std::array<double, 2> map_step_{};  // metres on the map from point to point; 0 if its unit is unknown
};

}  // namespace

void checkPatches(CheckContext& context, std::uint16_t grid) {
  const GdalSession session;
  if (const auto& lattice = context.grids[grid].patches()) PatchRule(context, grid, *lattice).run();
}

}  // namespace deltaz
