// Stored coverage errors (node_file.md, "Coverage error"), recomputed: the regions triangle by triangle,
// their components by flooding, and distances by trying every post at the border of the other region for the
// points that an approximate field shows to be the farthest.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "libdb/check/check_geometry.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

constexpr double kMostRatio = 1.001;
constexpr double kUnits = 2;
constexpr std::size_t kCandidates = 48;
constexpr std::int32_t kNone = -1;

struct Post {
  std::int64_t column = 0, row = 0;  // level 0, global
};

struct Facet {
  Post corner;  // south-western
  bool top = false;
  std::array<Post, 3> posts(std::int64_t step) const {
    return {corner, Post{corner.column + step, corner.row + step},
            top ? Post{corner.column, corner.row + step} : Post{corner.column + step, corner.row}};
  }
};

// The six triangles around a post, by the offset of their cell.
struct Around {
  int column, row;
  bool top;
};
constexpr std::array<Around, 6> kAround = {
    {{0, 0, false}, {0, 0, true}, {-1, 0, false}, {-1, -1, false}, {-1, -1, true}, {0, -1, true}}};

class NodeCoverage {
 public:
  NodeCoverage(const GeometryCheck& check, const NodeRecord& record)
      : full_(check.full),
        step_(std::int64_t{1} << record.level),
        columns_(extentColumns(check.geometry(), record)),
        rows_(extentRows(check.geometry(), record)) {
    measureCells(check.geometry());
  }

  double diagonal() const { return std::hypot(width_, height_); }

  // Least and most the coverage error may be, metres; both infinite if it is unknown.
  std::array<double, 2> range() {
    bool any_void = false;
    for (std::int64_t row = rows_.begin; row < rows_.end && !any_void; ++row) {
      const auto begin = full_.valid.begin() + static_cast<std::ptrdiff_t>(full_.index(columns_.begin, row));
      any_void = std::find(begin, begin + columns_.size(), 0) != begin + columns_.size();
    }
    std::array<double, 2> range = any_void ? ofRegions() : ofRectangles();
    range[1] *= sampled_;
    return range;
  }

 private:
  void measureCells(const GridGeometry& geometry) {
    // One column of cells on a geodetic grid, where all are alike; a net on a projected one.
    constexpr std::int64_t kNet = 32;
    const auto stride = [](PostRange range) { return std::max<std::int64_t>(1, (range.size() - 1) / kNet); };
    const std::int64_t dx = geometry.isGeodetic() ? columns_.size() : stride(columns_);
    const std::int64_t dy = geometry.isGeodetic() ? 1 : stride(rows_);
    constexpr std::size_t kKinds = 3;  // width, height, skew
    std::array<double, kKinds> largest{}, change_east{}, change_north{};
    std::vector<std::array<double, kKinds>> before;
    for (std::int64_t row = rows_.begin; row < rows_.end; row += dy) {
      std::vector<std::array<double, kKinds>> samples;
      for (std::int64_t column = columns_.begin; column < columns_.end; column += dx) {
        const Vector3 here = geometry.placeAt(column, row).foot;
        const std::int64_t east = column + 1 < columns_.end ? column + 1 : column - 1;
        const std::int64_t north = row + 1 < rows_.end ? row + 1 : row - 1;
        const Vector3 x = geometry.placeAt(east, row).foot - here,
                      y = geometry.placeAt(column, north).foot - here;
        std::array<double, kKinds> sample = {length(x), length(y), 0};
        if (!geometry.isGeodetic()) sample[2] = std::abs(dot(x, y)) / (sample[0] * sample[1]);
        for (std::size_t k = 0; k < kKinds; ++k) {
          largest[k] = std::max(largest[k], sample[k]);
          if (!samples.empty())
            change_east[k] = std::max(change_east[k], std::abs(sample[k] - samples.back()[k]));
          if (samples.size() < before.size())
            change_north[k] = std::max(change_north[k], std::abs(sample[k] - before[samples.size()][k]));
        }
        samples.push_back(sample);
      }
      before = std::move(samples);
    }
    const double skew = std::sqrt(1 + largest[2]);
    width_ = largest[0] * skew;
    height_ = largest[1] * skew;
    if (geometry.isGeodetic()) return;
    // What the format lets a builder add: the change from one of 17 x 17 posts to the next, which is no more
    // than that over so many of the strides here.
    const auto strides = [](PostRange range, std::int64_t taken) {
      constexpr std::int64_t kSamples = 16;
      const std::int64_t apart = ceilDivide(range.size() - 1, std::min(kSamples, range.size() - 1));
      return static_cast<double>(ceilDivide(apart, taken) + (taken > 1 ? 1 : 0));
    };
    std::array<double, kKinds> most{};
    for (std::size_t k = 0; k < kKinds; ++k) {
      most[k] =
          largest[k] + std::max(strides(columns_, dx) * change_east[k], strides(rows_, dy) * change_north[k]);
    }
    sampled_ =
        std::max(most[0] / largest[0], most[1] / largest[1]) * std::sqrt(1 + std::min(1.0, most[2])) / skew;
  }

  double distance(const Post& a, const Post& b) const {
    return std::hypot(static_cast<double>(a.column - b.column) * width_,
                      static_cast<double>(a.row - b.row) * height_);
  }

  std::array<double, 2> ofRectangles() const {
    const PostRange xs{ceilDivide(columns_.begin, step_) * step_,
                       floorDivide(columns_.end - 1, step_) * step_};
    const PostRange ys{ceilDivide(rows_.begin, step_) * step_, floorDivide(rows_.end - 1, step_) * step_};
    if (xs.end <= xs.begin || ys.end <= ys.begin) return unknown();
    double farthest = 0;
    for (const std::int64_t column : {columns_.begin, columns_.end - 1}) {
      for (const std::int64_t row : {rows_.begin, rows_.end - 1}) {
        farthest = std::max(farthest, distance({column, row}, {std::clamp(column, xs.begin, xs.end),
                                                               std::clamp(row, ys.begin, ys.end)}));
      }
    }
    return {farthest, farthest};
  }

  static std::array<double, 2> unknown() {
    return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }

  bool inExtent(const Facet& f, std::int64_t step) const {
    return f.corner.column >= columns_.begin && f.corner.row >= rows_.begin &&
           f.corner.column + step < columns_.end && f.corner.row + step < rows_.end;
  }
  bool fineDrawn(const Facet& f) const {
    return inExtent(f, 1) && full_.isDrawn(f.corner.column, f.corner.row, f.top, 1);
  }
  Facet above(const Facet& f) const {
    const Post corner{floorDivide(f.corner.column, step_) * step_, floorDivide(f.corner.row, step_) * step_};
    const std::int64_t a = f.corner.column - corner.column, b = f.corner.row - corner.row;
    return {corner, a == b ? f.top : b > a};
  }
  bool coarseDrawn(const Facet& fine) const {
    const Facet f = above(fine);
    return inExtent(f, step_) && full_.isDrawn(f.corner.column, f.corner.row, f.top, step_);
  }

  std::size_t at(const Post& post) const {
    return static_cast<std::size_t>((post.row - rows_.begin) * columns_.size() +
                                    (post.column - columns_.begin));
  }
  Post postAt(std::int32_t index) const {
    return {columns_.begin + index % columns_.size(), rows_.begin + index / columns_.size()};
  }
  std::size_t posts() const { return static_cast<std::size_t>(columns_.size() * rows_.size()); }

  template <typename Visit>
  void forEachFine(const Visit& visit) const {
    for (std::int64_t row = rows_.begin; row + 1 < rows_.end; ++row) {
      for (std::int64_t column = columns_.begin; column + 1 < columns_.end; ++column) {
        visit(Facet{{column, row}, false});
        visit(Facet{{column, row}, true});
      }
    }
  }

  // Floods each component of the facets `drawn` of `step` posts a side. Gives the largest diameter of those
  // that share no fine triangle with the other region, and marks the posts of the others in `matched`.
  template <typename Drawn, typename Shares>
  double flood(std::int64_t step, const Drawn& drawn, const Shares& shares,
               std::vector<std::uint8_t>& matched) const {
    std::vector<std::uint8_t> seen(posts(), 0);
    double largest = 0;
    for (std::int64_t row = ceilDivide(rows_.begin, step) * step; row < rows_.end; row += step) {
      for (std::int64_t column = ceilDivide(columns_.begin, step) * step; column < columns_.end;
           column += step) {
        if (seen[at({column, row})] != 0) continue;
        std::vector<std::int32_t> part = {static_cast<std::int32_t>(at({column, row}))};
        seen[at({column, row})] = 1;
        bool shared = false;
        for (std::size_t i = 0; i < part.size(); ++i) {
          const Post post = postAt(part[i]);
          for (const Around& around : kAround) {
            const Facet facet{{post.column + around.column * step, post.row + around.row * step}, around.top};
            if (!drawn(facet)) continue;
            shared = shared || shares(facet);
            for (const Post& next : facet.posts(step)) {
              if (seen[at(next)] != 0) continue;
              seen[at(next)] = 1;
              part.push_back(static_cast<std::int32_t>(at(next)));
            }
          }
        }
        if (part.size() < 3) continue;  // a post that belongs to no facet
        if (shared) {
          for (const std::int32_t post : part) matched[static_cast<std::size_t>(post)] = 1;
        } else {
          largest = std::max(largest, diameter(part));
        }
      }
    }
    return largest;
  }

  double diameter(const std::vector<std::int32_t>& part) const {
    std::map<std::int64_t, std::array<std::int64_t, 2>> ends;
    for (const std::int32_t index : part) {
      const Post post = postAt(index);
      auto& span = ends.try_emplace(post.row, std::array{post.column, post.column}).first->second;
      span = {std::min(span[0], post.column), std::max(span[1], post.column)};
    }
    double largest = 0;
    for (const auto& [row, span] : ends) {
      for (const auto& [other_row, other] : ends) {
        largest = std::max({largest, distance({span[0], row}, {other[1], other_row}),
                            distance({span[1], row}, {other[0], other_row})});
      }
    }
    return largest;
  }

  // Nearest seed of every post, roughly: two sweeps that hand nearest seeds on to neighbours (Danielsson
  // 1980).
  std::vector<std::int32_t> nearestSeeds(const std::vector<std::uint8_t>& seeds) const {
    std::vector<std::int32_t> nearest(seeds.size(), kNone);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (seeds[i] != 0) nearest[i] = static_cast<std::int32_t>(i);
    }
    const std::int64_t columns = columns_.size(), rows = rows_.size();
    const auto distanceTo = [&](std::int64_t column, std::int64_t row, std::int32_t seed) {
      const double x = static_cast<double>(column - seed % columns) * width_;
      const double y = static_cast<double>(row - seed / columns) * height_;
      return x * x + y * y;
    };
    const auto offer = [&](std::int64_t column, std::int64_t row, std::int64_t from_column,
                           std::int64_t from_row) {
      if (from_column < 0 || from_column >= columns || from_row < 0 || from_row >= rows) return;
      const std::int32_t offered = nearest[static_cast<std::size_t>(from_row * columns + from_column)];
      std::int32_t& own = nearest[static_cast<std::size_t>(row * columns + column)];
      if (offered == kNone || offered == own) return;
      if (own == kNone || distanceTo(column, row, offered) < distanceTo(column, row, own)) own = offered;
    };
    for (const std::int64_t direction : {1, -1}) {
      for (std::int64_t r = 0; r < rows; ++r) {
        const std::int64_t row = direction > 0 ? r : rows - 1 - r;
        for (std::int64_t c = 0; c < columns; ++c) {
          for (const std::int64_t dc : {-1, 0, 1}) offer(c, row, c + dc, row - direction);
          offer(c, row, c - 1, row);
        }
        for (std::int64_t c = columns; c-- > 0;) offer(c, row, c + 1, row);
      }
    }
    return nearest;
  }

  // Largest distance from the corners of the fine triangles `counts` selects to the posts `seeds`.
  template <typename Counts>
  double farthest(const std::vector<std::uint8_t>& seeds, const Counts& counts) const {
    std::vector<std::uint8_t> wanted(posts(), 0);
    bool any = false;
    forEachFine([&](const Facet& facet) {
      if (!counts(facet)) return;
      any = true;
      for (const Post& post : facet.posts(1)) wanted[at(post)] = 1;
    });
    if (!any) return -1;
    const std::vector<std::int32_t> nearest = nearestSeeds(seeds);
    const std::int64_t columns = columns_.size();
    std::vector<std::pair<double, std::size_t>> candidates;
    const auto farther = [](const auto& a, const auto& b) { return a.first > b.first; };
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i] == 0 || nearest[i] == kNone) continue;
      const auto post = static_cast<std::int64_t>(i);
      const double rough =
          distance({post % columns, post / columns}, {nearest[i] % columns, nearest[i] / columns});
      if (candidates.size() == kCandidates && rough <= candidates.front().first) continue;
      candidates.emplace_back(rough, i);
      std::push_heap(candidates.begin(), candidates.end(), farther);
      if (candidates.size() <= kCandidates) continue;
      std::pop_heap(candidates.begin(), candidates.end(), farther);
      candidates.pop_back();
    }
    // The nearest of many posts to one outside is one at their border.
    std::vector<Post> border;
    for (std::int64_t row = 0; row < rows_.size(); ++row) {
      for (std::int64_t column = 0; column < columns; ++column) {
        const auto i = static_cast<std::size_t>(row * columns + column);
        if (seeds[i] == 0) continue;
        const bool inside = column > 0 && column + 1 < columns && row > 0 && row + 1 < rows_.size() &&
                            seeds[i - 1] != 0 && seeds[i + 1] != 0 &&
                            seeds[i - static_cast<std::size_t>(columns)] != 0 &&
                            seeds[i + static_cast<std::size_t>(columns)] != 0;
        if (!inside) border.push_back({column, row});
      }
    }
    double largest = 0;
    for (const auto& [rough, i] : candidates) {
      if (seeds[i] != 0) continue;
      const auto post = static_cast<std::int64_t>(i);
      double least = std::numeric_limits<double>::infinity();
      for (const Post& seed : border)
        least = std::min(least, distance({post % columns, post / columns}, seed));
      largest = std::max(largest, least);
    }
    return largest;
  }

  std::array<double, 2> ofRegions() const {
    std::vector<std::uint8_t> fine_posts(posts(), 0), coarse_posts(posts(), 0);
    bool any_fine = false, any_coarse = false;
    forEachFine([&](const Facet& facet) {
      const bool fine = fineDrawn(facet), coarse = coarseDrawn(facet);
      any_fine = any_fine || fine;
      any_coarse = any_coarse || coarse;
      for (const Post& post : facet.posts(1)) {
        if (fine) fine_posts[at(post)] = 1;
        if (coarse) coarse_posts[at(post)] = 1;
      }
    });
    if (!any_coarse) return any_fine ? unknown() : std::array<double, 2>{0, 0};
    std::vector<std::uint8_t> fine_matched(posts(), 0), coarse_matched(posts(), 0);
    const double fine_vanishing = flood(
        1, [&](const Facet& f) { return fineDrawn(f); }, [&](const Facet& f) { return coarseDrawn(f); },
        fine_matched);
    const double coarse_vanishing = flood(
        step_,
        [&](const Facet& f) {
          return inExtent(f, step_) && full_.isDrawn(f.corner.column, f.corner.row, f.top, step_);
        },
        [&](const Facet& f) { return anyFineUnder(f); }, coarse_matched);
    const double vanishing = std::max(fine_vanishing, coarse_vanishing);
    const double beyond = farthest(coarse_posts, [&](const Facet& f) {
      return fineDrawn(f) && !coarseDrawn(f) && fine_matched[at(f.corner)] != 0;
    });
    const double over = farthest(fine_posts, [&](const Facet& f) {
      return !fineDrawn(f) && coarseDrawn(f) && coarse_matched[at(above(f).corner)] != 0;
    });
    const double corner = std::max(beyond, over);
    // A region's edge may run between posts, and a triangle reaches beyond its corners, by half a diagonal
    // each.
    if (corner < 0) return {vanishing, vanishing};
    return {std::max(vanishing, corner - diagonal() / 2), std::max(vanishing, corner + diagonal())};
  }

  bool anyFineUnder(const Facet& coarse) const {
    for (std::int64_t b = 0; b < step_; ++b) {
      for (std::int64_t a = 0; a < step_; ++a) {
        for (const bool top : {false, true}) {
          const Facet fine{{coarse.corner.column + a, coarse.corner.row + b}, top};
          if (above(fine).top == coarse.top && fineDrawn(fine)) return true;
        }
      }
    }
    return false;
  }

  const FullGrid& full_;
  std::int64_t step_;
  PostRange columns_, rows_;
  double width_ = 0, height_ = 0;  // metres a post
  double sampled_ = 1;             // how much larger they may be taken, being sampled
};

}  // namespace

void checkCoverage(GeometryCheck& check) {
  const std::vector<std::uint32_t> nodes = check.nodesOf(-1);
  parallelReport(check.context.report, nodes.size(), 1, [&](std::size_t item, Report& report) {
    const std::uint32_t number = nodes[item];
    const NodeRecord& record = check.context.record(number);
    std::array<double, 2> range = {0, 0};
    if (record.level > 0 && !record.isEmpty()) range = NodeCoverage(check, record).range();
    const double limit = static_cast<double>(kUnknownError) * kErrorUnit;
    const bool is_unknown = record.coverage_error == kUnknownError;
    const double stored = static_cast<double>(record.coverage_error) * kErrorUnit;
    const double most = kMostRatio * range[1] + kUnits * kErrorUnit;
    const bool right = is_unknown ? most >= limit : stored >= range[0] / kMostRatio && stored <= most;
    if (right) return;
    report.add(
        makeIssue(IssueCode::kErrCoverage,
                  fmt::format("the coverage error is said to be {}; recomputed it is {:.3f} to {:.3f} m",
                              is_unknown ? std::string("unknown") : fmt::format("{:.4f} m", stored), range[0],
                              range[1]),
                  check.whereRecord(number), is_unknown ? range[1] : std::abs(stored - range[0])));
  });
}

}  // namespace deltaz
