#include "libdb/build/coverage_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "formats/node_file.h"
#include "libdb/access/plan_shape.h"

namespace deltaz {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
// Relative; stays above what the rounding of a distance may lose.
constexpr double kRoundingGuard = 1e-12;

// A triangle of one cell, by the cell's south-west post; columns and rows count from the extent's corner.
struct Triangle {
  std::int64_t column = 0, row = 0;
  bool top = false;  // (SW, NE, NW) instead of (SW, SE, NE)
};

// Sets of connected posts, each named by one of them.
class Components {
 public:
  explicit Components(std::size_t posts) : parents_(posts) {
    std::iota(parents_.begin(), parents_.end(), std::int32_t{0});
  }
  std::int32_t find(std::size_t post) {
    auto root = static_cast<std::int32_t>(post);
    while (parent(root) != root) root = parent(root) = parent(parent(root));
    return root;
  }
  // The smaller index stays the name, so that names do not depend on the order of joining.
  void join(std::size_t a, std::size_t b) {
    const std::int32_t first = find(a), second = find(b);
    if (first < second) parent(second) = first;
    if (second < first) parent(first) = second;
  }

 private:
  std::int32_t& parent(std::int32_t post) { return parents_[static_cast<std::size_t>(post)]; }
  std::vector<std::int32_t> parents_;
};

// The valid region of one level inside a node's extent, as triangles of a lattice of posts.
struct Lattice {
  std::int64_t columns = 0, rows = 0;
  std::vector<std::uint8_t> valid;  // posts, row by row

  std::size_t index(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * columns + column);
  }
  bool holds(const Triangle& t) const {
    return t.column >= 0 && t.row >= 0 && t.column + 1 < columns && t.row + 1 < rows &&
           valid[index(t.column, t.row)] != 0 && valid[index(t.column + 1, t.row + 1)] != 0 &&
           valid[t.top ? index(t.column, t.row + 1) : index(t.column + 1, t.row)] != 0;
  }
  std::array<std::size_t, 3> posts(const Triangle& t) const {
    return {index(t.column, t.row), index(t.column + 1, t.row + 1),
            t.top ? index(t.column, t.row + 1) : index(t.column + 1, t.row)};
  }
  template <typename Visit>
  void forEachTriangle(const Visit& visit) const {
    for (std::int64_t row = 0; row + 1 < rows; ++row) {
      for (std::int64_t column = 0; column + 1 < columns; ++column) {
        for (const bool top : {false, true}) {
          if (const Triangle t{column, row, top}; holds(t)) visit(t);
        }
      }
    }
  }
};

// Largest distance between two of a set of points, through its convex hull (Andrew's monotone chain).
double diameterOf(std::vector<std::array<double, 2>> points) {
  std::sort(points.begin(), points.end());
  std::vector<std::array<double, 2>> hull;
  const auto addHalf = [&](auto begin, auto end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2) {
        const auto& a = hull[hull.size() - 2];
        const auto& b = hull.back();
        if ((b[0] - a[0]) * ((*p)[1] - a[1]) - (b[1] - a[1]) * ((*p)[0] - a[0]) > 0) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
  };
  addHalf(points.begin(), points.end());
  addHalf(points.rbegin(), points.rend());
  double squared = 0;
  for (const auto& a : hull) {
    for (const auto& b : hull)
      squared = std::max(squared, (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
  }
  return std::sqrt(squared);
}

// Distances to the nearest of a set of posts, exactly (Felzenszwalb and Huttenlocher 2012): along columns by
// two sweeps, then along those rows that are asked for.
class DistanceField {
 public:
  DistanceField(const std::vector<std::uint8_t>& seeds, std::int64_t columns, std::int64_t rows,
                const CellSize& cell)
      : columns_(static_cast<std::size_t>(columns)), cell_(cell), steps_(seeds.size(), kFar) {
    const auto height = static_cast<std::size_t>(rows);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (seeds[i] != 0) {
        steps_[i] = 0;
      } else if (i >= columns_ && steps_[i - columns_] != kFar) {
        steps_[i] = steps_[i - columns_] + 1;
      }
    }
    for (std::size_t i = columns_ * (height - 1); i-- > 0;) {
      if (steps_[i + columns_] != kFar) steps_[i] = std::min(steps_[i], steps_[i + columns_] + 1);
    }
  }

  // Metres from each post of the row; infinity if there is no seed at all.
  std::vector<double> row(std::int64_t row) {
    const std::int32_t* steps = steps_.data() + static_cast<std::size_t>(row) * columns_;
    const double width2 = cell_.width * cell_.width;
    // The lower envelope of one parabola for each column: `from_` where each begins to be lowest.
    apexes_.clear();
    from_.clear();
    const auto squared = [&](std::size_t column) {
      const double d = static_cast<double>(steps[column]) * cell_.height;
      return d * d;
    };
    for (std::size_t q = 0; q < columns_; ++q) {
      if (steps[q] == kFar) continue;
      const auto x = static_cast<double>(q);
      double begin = -kInfinity;
      while (!apexes_.empty()) {
        const auto v = static_cast<double>(apexes_.back());
        begin = (x + v) / 2 + (squared(q) - squared(apexes_.back())) / (2 * width2 * (x - v));
        if (begin > from_.back()) break;
        apexes_.pop_back();
        from_.pop_back();
        begin = -kInfinity;
      }
      apexes_.push_back(q);
      from_.push_back(begin);
    }
    std::vector<double> distances(columns_, kInfinity);
    if (apexes_.empty()) return distances;
    std::size_t k = 0;
    for (std::size_t q = 0; q < columns_; ++q) {
      const auto x = static_cast<double>(q);
      while (k + 1 < apexes_.size() && from_[k + 1] <= x) ++k;
      const double d = x - static_cast<double>(apexes_[k]);
      distances[q] = std::sqrt(squared(apexes_[k]) + width2 * d * d);
    }
    return distances;
  }

 private:
  std::size_t columns_;
  CellSize cell_;
  std::vector<std::int32_t> steps_;  // rows to the nearest seed of the same column
  std::vector<std::size_t> apexes_;
  std::vector<double> from_;
};

// The two regions of a node whose extent has voids.
class RegionPair {
 public:
  RegionPair(const RawGrid& grid, const GridGeometry& geometry, int level, PostRange columns, PostRange rows,
             PostRange coarse_columns, PostRange coarse_rows)
      : step_(std::int64_t{1} << level),
        offset_column_(coarse_columns.begin * step_ - columns.begin),
        offset_row_(coarse_rows.begin * step_ - rows.begin),
        cell_(largestCell(geometry, columns, rows)) {
    const auto cut = [&](PostRange xs, PostRange ys, std::int64_t step) {
      Lattice lattice{std::max<std::int64_t>(0, xs.size()), std::max<std::int64_t>(0, ys.size()), {}};
      lattice.valid.reserve(static_cast<std::size_t>(lattice.columns * lattice.rows));
      for (std::int64_t row = ys.begin; row < ys.end; ++row) {
        for (std::int64_t column = xs.begin; column < xs.end; ++column) {
          lattice.valid.push_back(
              grid.isValid(column * step - grid.header.x_axis.first, row * step - grid.header.y_axis.first)
                  ? 1
                  : 0);
        }
      }
      return lattice;
    };
    fine_ = cut(columns, rows, 1);
    coarse_ = cut(coarse_columns, coarse_rows, step_);
  }

  double distance() {
    std::vector<std::uint8_t> fine_posts(fine_.valid.size(), 0), coarse_posts(fine_.valid.size(), 0);
    Components fine_parts(fine_.valid.size()), coarse_parts(coarse_.valid.size());
    coarse_.forEachTriangle([&](const Triangle& t) {
      const auto posts = coarse_.posts(t);
      coarse_parts.join(posts[0], posts[1]);
      coarse_parts.join(posts[0], posts[2]);
      any_coarse_ = true;
    });
    fine_.forEachTriangle([&](const Triangle& t) {
      const auto posts = fine_.posts(t);
      fine_parts.join(posts[0], posts[1]);
      fine_parts.join(posts[0], posts[2]);
      for (const std::size_t post : posts) fine_posts[post] = 1;
      any_fine_ = true;
    });
    if (!any_coarse_) return any_fine_ ? kInfinity : 0;
    // Which components share a triangle with the other region.
    std::vector<std::uint8_t> fine_matched(fine_.valid.size(), 0), coarse_matched(coarse_.valid.size(), 0);
    forEachCovered([&](const Triangle& t, const Triangle& over) {
      for (const std::size_t post : fine_.posts(t)) coarse_posts[post] = 1;
      if (!fine_.holds(t)) return;
      fine_matched[static_cast<std::size_t>(fine_parts.find(fine_.index(t.column, t.row)))] = 1;
      coarse_matched[static_cast<std::size_t>(coarse_parts.find(coarse_.index(over.column, over.row)))] = 1;
    });
    double largest = std::max(vanishingDiameter(fine_, fine_parts, fine_matched, 1),
                              vanishingDiameter(coarse_, coarse_parts, coarse_matched, step_));
    // Full resolution beyond what is drawn.
    largest = std::max(
        largest, farthest(coarse_posts, [&](const Triangle& t) {
          return fine_.holds(t) && !coarse_.holds(coarserOf(t)) &&
                 fine_matched[static_cast<std::size_t>(fine_parts.find(fine_.index(t.column, t.row)))] != 0;
        }));
    // Drawn where full resolution has nothing.
    largest = std::max(largest, farthest(fine_posts, [&](const Triangle& t) {
                         if (fine_.holds(t)) return false;
                         const Triangle over = coarserOf(t);
                         return coarse_.holds(over) &&
                                coarse_matched[static_cast<std::size_t>(
                                    coarse_parts.find(coarse_.index(over.column, over.row)))] != 0;
                       }));
    return largest;
  }

 private:
  // The coarse triangle over a fine one. With one diagonal everywhere the fine ones nest exactly.
  Triangle coarserOf(const Triangle& t) const {
    const std::int64_t column = floorDivide(t.column - offset_column_, step_);
    const std::int64_t row = floorDivide(t.row - offset_row_, step_);
    const std::int64_t a = t.column - offset_column_ - column * step_;
    const std::int64_t b = t.row - offset_row_ - row * step_;
    return {column, row, b > a || (b == a && t.top)};
  }

  // Every fine triangle, valid or not, under a valid coarse one, and that.
  template <typename Visit>
  void forEachCovered(const Visit& visit) const {
    coarse_.forEachTriangle([&](const Triangle& over) {
      for (std::int64_t b = 0; b < step_; ++b) {
        for (std::int64_t a = 0; a < step_; ++a) {
          for (const bool top : {false, true}) {
            if (over.top != (b > a || (b == a && top))) continue;
            visit({offset_column_ + over.column * step_ + a, offset_row_ + over.row * step_ + b, top}, over);
          }
        }
      }
    });
  }

  // Largest diameter of a component that is not matched. `step` is what a post of the lattice is in fine
  // ones.
  double vanishingDiameter(const Lattice& lattice, Components& parts,
                           const std::vector<std::uint8_t>& matched, std::int64_t step) const {
    struct RowSpan {
      std::int64_t row, first, last;
    };
    std::unordered_map<std::int32_t, std::vector<RowSpan>> vanishing;
    lattice.forEachTriangle([&](const Triangle& t) {
      const std::int32_t part = parts.find(lattice.index(t.column, t.row));
      if (matched[static_cast<std::size_t>(part)] != 0) return;
      std::vector<RowSpan>& spans = vanishing[part];
      const auto add = [&](std::int64_t column, std::int64_t row) {
        // A triangle reaches into this cell's row of posts and the next.
        for (std::size_t back = 1; back <= std::min<std::size_t>(2, spans.size()); ++back) {
          RowSpan& span = spans[spans.size() - back];
          if (span.row != row) continue;
          span.first = std::min(span.first, column);
          span.last = std::max(span.last, column);
          return;
        }
        spans.push_back({row, column, column});
      };
      add(t.column, t.row);
      add(t.column + (t.top ? 0 : 1), t.row + (t.top ? 1 : 0));
      add(t.column + 1, t.row + 1);
    });
    double largest = 0;
    for (const auto& [part, spans] : vanishing) {
      std::vector<std::array<double, 2>> points;
      for (const RowSpan& span : spans) {
        for (const std::int64_t column : {span.first, span.last}) {
          points.push_back({static_cast<double>(column * step) * cell_.width,
                            static_cast<double>(span.row * step) * cell_.height});
        }
      }
      largest = std::max(largest, diameterOf(std::move(points)));
    }
    return largest;
  }

  // The farthest any point of the triangles `counts` selects lies from the posts of the other region. No
  // point of a triangle is farther from one of its corners than half its diagonal.
  template <typename Counts>
  double farthest(const std::vector<std::uint8_t>& seeds, const Counts& counts) const {
    DistanceField field(seeds, fine_.columns, fine_.rows, cell_);
    std::vector<double> south, north;
    std::int64_t north_row = -1;
    double largest = 0;
    for (std::int64_t row = 0; row + 1 < fine_.rows; ++row) {
      bool ready = false;
      for (std::int64_t column = 0; column + 1 < fine_.columns; ++column) {
        for (const bool top : {false, true}) {
          if (!counts({column, row, top})) continue;
          if (!ready) {
            south = north_row == row ? std::move(north) : field.row(row);
            north = field.row(row + 1);
            north_row = row + 1;
            ready = true;
          }
          const auto i = static_cast<std::size_t>(column);
          const double corner = std::max({south[i], north[i + 1], top ? north[i] : south[i + 1]});
          largest = std::max(largest, corner + cell_.diagonal() / 2);
        }
      }
    }
    return largest;
  }

  std::int64_t step_, offset_column_, offset_row_;
  CellSize cell_;
  Lattice fine_, coarse_;
  bool any_fine_ = false, any_coarse_ = false;
};

std::uint32_t inErrorUnits(double metres) {
  const double units = std::ceil(metres / kErrorUnit * (1 + kRoundingGuard));
  return units < static_cast<double>(kUnknownError) ? static_cast<std::uint32_t>(units) : kUnknownError;
}

}  // namespace

std::uint32_t coverageError(const RawGrid& grid, const GridGeometry& geometry, int level, std::int32_t x,
                            std::int32_t y, bool voids) {
  const std::int64_t step = std::int64_t{1} << level;
  const std::int64_t span = geometry.header().leaf_cells * step;
  const auto extent = [span](PostRange all, std::int32_t node) {
    return PostRange{std::max(all.begin, node * span), std::min(all.end, (node + 1) * span + 1)};
  };
  const PostRange columns = extent(geometry.columnsAt(0), x), rows = extent(geometry.rowsAt(0), y);
  const PostRange coarse_columns = geometry.nodePosts(geometry.columnsAt(level), x);
  const PostRange coarse_rows = geometry.nodePosts(geometry.rowsAt(level), y);
  if (voids) {
    return inErrorUnits(
        RegionPair(grid, geometry, level, columns, rows, coarse_columns, coarse_rows).distance());
  }
  // One rectangle inside another: the farthest point is a corner.
  if (coarse_columns.size() < 2 || coarse_rows.size() < 2) return kUnknownError;
  const auto gap = [step](PostRange fine, PostRange coarse) {
    return static_cast<double>(
        std::max(coarse.begin * step - fine.begin, fine.end - 1 - (coarse.end - 1) * step));
  };
  const CellSize cell = largestCell(geometry, columns, rows);
  return inErrorUnits(
      std::hypot(gap(columns, coarse_columns) * cell.width, gap(rows, coarse_rows) * cell.height));
}

}  // namespace deltaz
