// Stored geometric errors, RMS errors and the errors leaves keep against the levels above them, recomputed
// post by post (and between posts, at points chosen by a hash) with SurfaceProbe.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "libdb/build/facet_error.h"
#include "libdb/check/check_geometry.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"
#include "libdb/check/surface_probe.h"

namespace deltaz {
namespace {

// A stored error may exceed the recomputed one by this factor, the slack between posts and two units.
constexpr double kMostRatio = 1.001;
constexpr double kUnits = 2;
// What two roundings to whole units and the square root may differ by, units.
constexpr double kRmsUnits = 1.5;
// Rounding of positions and heights, metres.
constexpr double kRounding = 1e-6;
constexpr int kPointsPerLeaf = 128;

// Error of one level over one leaf.
struct Measure {
  double at_posts = 0, between_posts = 0;  // metres, largest
  double sum_of_squares = 0;               // of whole units
  std::uint64_t posts = 0;
};

// Numbers in [0, 1), the same on every machine.
class HashNumbers {
 public:
  explicit HashNumbers(std::uint64_t seed) : state_(seed) {}
  double next() {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

class ErrorRule {
 public:
  explicit ErrorRule(GeometryCheck& check)
      : check_(check), geometry_(check.geometry()), levels_(geometry_.header().level_count) {}

  void run() {
    const std::vector<std::uint32_t> leaves = check_.nodesOf(0);
    std::vector<std::vector<Measure>> measures(leaves.size());
    std::vector<std::uint8_t> measured(leaves.size(), 0);
    parallelReport(check_.context.report, leaves.size(), 4, [&](std::size_t item, Report& report) {
      const NodeRecord& leaf = check_.context.record(leaves[item]);
      const TilePointer tile = check_.loader.find(leaves[item]);
      if (!tile) return;
      if (isSampled(leaf, check_.context.options.sample_percent)) {
        measured[item] = 1;
        measures[item] = measure(leaf);
        compareAncestors(leaves[item], *tile, measures[item], report);
      } else {
        measures[item] = stored(*tile);
      }
    });
    for (std::size_t i = 0; i < leaves.size(); ++i) check_.context.report.leaves_measured += measured[i];
    gather(leaves, measures);
    compareNodes();
  }

 private:
  std::vector<Measure> stored(const LoadedTile& tile) const {
    std::vector<Measure> result;
    for (const AncestorError& error : tile.block.ancestors) {
      Measure measure;
      // Rounded up when it was stored.
      measure.at_posts = std::max(0.0, static_cast<double>(error.maximum) - 1) * kErrorUnit;
      measure.sum_of_squares = static_cast<double>(error.sum_of_squares);
      measure.posts = error.posts;
      result.push_back(measure);
    }
    return result;
  }

  std::vector<Measure> measure(const NodeRecord& leaf) const {
    const PostRange columns = extentColumns(geometry_, leaf), rows = extentRows(geometry_, leaf);
    const std::vector<PostPlace> places = geometry_.postPlaces(0, columns, rows);
    // Borders are summed by the leaf they open, the area's end by the last.
    const auto owned_end = [](PostRange own, PostRange all) {
      return own.end == all.end ? own.end : own.end - 1;
    };
    const std::int64_t column_end = owned_end(columns, check_.full.columns);
    const std::int64_t row_end = owned_end(rows, check_.full.rows);
    std::vector<Measure> result;
    for (int level = 1; level < levels_; ++level) {
      const SurfaceProbe probe(check_.full, geometry_, level, columns, rows);
      Measure measure;
      auto place = places.begin();
      for (std::int64_t row = rows.begin; row < rows.end; ++row) {
        for (std::int64_t column = columns.begin; column < columns.end; ++column, ++place) {
          if (!check_.full.isValid(column, row)) continue;
          const std::int64_t mask = (std::int64_t{1} << level) - 1;
          double difference = 0;
          if (((column | row) & mask) != 0) {
            const auto coarse = probe.heightOver(static_cast<double>(column), static_cast<double>(row),
                                                 place->foot, place->up);
            if (!coarse) continue;
            difference =
                std::abs(*coarse - geometry_.metres(check_.full.heights[check_.full.index(column, row)]));
          }
          measure.at_posts = std::max(measure.at_posts, difference);
          if (column >= column_end || row >= row_end) continue;
          const double units = std::round(difference / kErrorUnit);
          measure.sum_of_squares += units * units;
          ++measure.posts;
        }
      }
      result.push_back(measure);
    }
    measureBetween(leaf, columns, rows, result);
    return result;
  }

  // Points of full-resolution facets, chosen by a hash of the leaf's place.
  void measureBetween(const NodeRecord& leaf, PostRange columns, PostRange rows,
                      std::vector<Measure>& measures) const {
    if (levels_ == 1) return;
    const SurfaceProbe fine(check_.full, geometry_, 0, columns, rows);
    std::vector<SurfaceProbe> coarse;
    for (int level = 1; level < levels_; ++level)
      coarse.emplace_back(check_.full, geometry_, level, columns, rows);
    HashNumbers numbers(static_cast<std::uint64_t>(static_cast<std::uint32_t>(leaf.x)) << 32 |
                        static_cast<std::uint32_t>(leaf.y));
    for (int point = 0; point < kPointsPerLeaf; ++point) {
      const double x = numbers.next() * static_cast<double>(columns.size() - 1);
      const double y = numbers.next() * static_cast<double>(rows.size() - 1);
      const std::int64_t column = columns.begin + static_cast<std::int64_t>(x);
      const std::int64_t row = rows.begin + static_cast<std::int64_t>(y);
      const double a = x - std::floor(x), b = y - std::floor(y);
      const bool top = b > a;
      if (!fine.isDrawn(column, row, top)) continue;
      const Vector3& sw = fine.position(column, row);
      const Vector3& ne = fine.position(column + 1, row + 1);
      const Vector3& third = top ? fine.position(column, row + 1) : fine.position(column + 1, row);
      const Vector3 on_facet =
          top ? sw * (1 - b) + third * (b - a) + ne * a : sw * (1 - a) + third * (a - b) + ne * b;
      const EllipsoidShape& ellipsoid = geometry_.header().ellipsoid;
      const GeodeticPoint place = toGeodetic(ellipsoid, on_facet);
      const RowConstants of_row = rowConstants(ellipsoid, place.latitude);
      const ColumnConstants of_column = columnConstants(place.longitude);
      const Vector3 foot = earthCentred(of_row, of_column, 0), up = upVector(of_row, of_column);
      for (std::size_t k = 0; k < coarse.size(); ++k) {
        const auto height = coarse[k].heightOver(static_cast<double>(columns.begin) + x,
                                                 static_cast<double>(rows.begin) + y, foot, up);
        if (height)
          measures[k].between_posts = std::max(measures[k].between_posts, std::abs(*height - place.height));
      }
    }
  }

  void compareAncestors(std::uint32_t number, const LoadedTile& tile, const std::vector<Measure>& measures,
                        Report& report) const {
    for (std::size_t k = 0; k < measures.size(); ++k) {
      const AncestorError& error = tile.block.ancestors[k];
      const double maximum = static_cast<double>(error.maximum) * kErrorUnit;
      const double difference = std::abs(maximum - measures[k].at_posts);
      const double squares = static_cast<double>(error.sum_of_squares);
      // A difference on the verge of the next unit may be rounded either way, once in a great while.
      const double rounding = 1e-3 * measures[k].sum_of_squares + 4 * measures[k].at_posts / kErrorUnit + 4;
      std::string wrong;
      if (difference > (kMostRatio - 1) * measures[k].at_posts + kUnits * kErrorUnit) {
        wrong = fmt::format("at most {:.4f} m, recomputed {:.4f} m", maximum, measures[k].at_posts);
      } else if (error.posts != measures[k].posts) {
        wrong = fmt::format("over {} posts, recomputed {}", error.posts, measures[k].posts);
      } else if (std::abs(squares - measures[k].sum_of_squares) > rounding) {
        wrong = fmt::format("squares that add up to {}, recomputed {}", error.sum_of_squares,
                            measures[k].sum_of_squares);
      }
      if (wrong.empty()) continue;
      IssueLocation where = check_.context.locate(number);
      const NodeRecord& record = check_.context.record(number);
      where.file = check_.context.segments.at(record.segment)->reference.name;
      where.block = record.block;
      report.add(makeIssue(IssueCode::kErrAncestor,
                           fmt::format("its error against level {} is said to be {}", k + 1, wrong), where,
                           difference));
    }
  }

  // What is measured over a leaf belongs to every node above it.
  void gather(const std::vector<std::uint32_t>& leaves, const std::vector<std::vector<Measure>>& measures) {
    of_nodes_.resize(check_.context.records.size() + 1);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      std::uint32_t above = leaves[i];
      for (const Measure& measure : measures[i]) {
        above = check_.context.parents[above - 1];
        Measure& sum = of_nodes_[above];
        sum.at_posts = std::max(sum.at_posts, measure.at_posts);
        sum.between_posts = std::max(sum.between_posts, measure.between_posts);
        sum.sum_of_squares += measure.sum_of_squares;
        sum.posts += measure.posts;
      }
    }
  }

  void complain(IssueCode code, std::uint32_t number, std::string message, double magnitude) {
    check_.context.report.add(makeIssue(code, std::move(message), check_.whereRecord(number), magnitude));
  }

  void compareNodes() {
    for (const std::uint32_t number : check_.nodesOf(-1)) {
      const NodeRecord& record = check_.context.record(number);
      if (record.level == 0 || record.isEmpty()) {
        if (record.geometric_error != 0)
          complain(IssueCode::kErrGeometric, number, "full resolution, or nothing, is said to have an error",
                   0);
        if (record.rms_error != 0)
          complain(IssueCode::kErrRms, number, "full resolution, or nothing, is said to have an RMS error",
                   0);
        continue;
      }
      if (check_.has_facets[number] == 0) {
        if (record.geometric_error != kUnknownError)
          complain(IssueCode::kErrGeometric, number, "it draws nothing, so its error is unknown", 0);
        if (record.rms_error != kUnknownError)
          complain(IssueCode::kErrRms, number, "it draws nothing, so its RMS error is unknown", 0);
        continue;
      }
      compareMaximum(number, record, of_nodes_[number],
                     check_.between_posts.slack(record.level, record.x, record.y));
      compareRms(number, record, of_nodes_[number]);
    }
  }

  void compareMaximum(std::uint32_t number, const NodeRecord& record, const Measure& measure, double slack) {
    const double recomputed = std::max(measure.at_posts, measure.between_posts);
    const double most = kMostRatio * measure.at_posts + kMostRatio * slack + kUnits * kErrorUnit;
    // More than a record can hold is unknown.
    if (record.geometric_error == kUnknownError && most >= kUnknownError * kErrorUnit) return;
    const double stored = record.geometric_error * kErrorUnit;
    if (record.geometric_error != kUnknownError && recomputed <= stored + kRounding && stored <= most) return;
    complain(
        IssueCode::kErrGeometric, number,
        fmt::format(
            "the geometric error is said to be {:.4f} m; recomputed it is {:.4f} m, and {:.4f} m between "
            "posts; {:.4f} m would be the most",
            stored, measure.at_posts, measure.between_posts, most),
        std::abs(stored - recomputed));
  }

  void compareRms(std::uint32_t number, const NodeRecord& record, const Measure& measure) {
    if (measure.posts == 0) {
      if (record.rms_error != kUnknownError)
        complain(IssueCode::kErrRms, number, "no post was compared, so its RMS error is unknown", 0);
      return;
    }
    const double recomputed = std::sqrt(measure.sum_of_squares / static_cast<double>(measure.posts));
    const double difference = std::abs(record.rms_error - recomputed);
    if (record.rms_error != kUnknownError && difference <= (kMostRatio - 1) * recomputed + kRmsUnits) return;
    complain(IssueCode::kErrRms, number,
             fmt::format("the RMS error is said to be {:.4f} m, recomputed it is {:.4f} m",
                         record.rms_error * kErrorUnit, recomputed * kErrorUnit),
             difference * kErrorUnit);
  }

  GeometryCheck& check_;
  const GridGeometry& geometry_;
  int levels_;
  std::vector<Measure> of_nodes_;  // by record number
};

}  // namespace

void checkErrors(GeometryCheck& check) {
  ErrorRule(check).run();
}

}  // namespace deltaz
