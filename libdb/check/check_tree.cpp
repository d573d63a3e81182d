// The node records: that each stands where its links, its number and its position say, that all of them form
// one tree in breadth-first order, and that what a record says of everything below it is so.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "libdb/access/node_pages.h"
#include "libdb/check/check_context.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

constexpr std::uint8_t kAreaLevel = 255;
constexpr std::size_t kMostTerrainChildren = 4;

// 1 SW, 2 SE, 3 NE, 4 NW.
std::uint8_t childNumber(std::int64_t dx, std::int64_t dy) {
  if (dy == 0) return dx == 0 ? 1 : 2;
  return dx == 1 ? 3 : 4;
}

class TreeRule {
 public:
  explicit TreeRule(CheckContext& context) : context_(context) {}

  void run() {
    if (!readRecords()) {
      addSkipped(context_.report, "the tree of nodes, whose records could not all be read");
      return;
    }
    const std::uint64_t errors = context_.report.count(Severity::kError);
    for (std::uint32_t number = 1; number <= count(); ++number) checkRecord(number);
    walk();
    placeNodes();
    context_.tree_sound = context_.report.count(Severity::kError) == errors;
    if (!context_.tree_sound) {
      addSkipped(context_.report,
                 "the area's bounds and what nodes say of the nodes below them, since the tree is damaged");
      return;
    }
    checkHeader();
    for (std::uint32_t number = 1; number <= count(); ++number) checkSummary(number);
  }

 private:
  std::uint32_t count() const { return static_cast<std::uint32_t>(context_.records.size()); }

  void complain(IssueCode code, std::uint32_t number, std::string message) {
    context_.report.add(makeIssue(code, std::move(message), context_.locate(number)));
  }

  bool readRecords() {
    if (context_.nodes == nullptr) return false;
    CheckedFile& file = *context_.nodes;
    const ContainerReader& container = *file.container;
    std::vector<std::vector<NodeRecord>> pages(container.blockCount());
    parallelReport(context_.report, pages.size(), 4, [&](std::size_t item, Report& report) {
      const auto number = static_cast<std::uint32_t>(item);
      IssueLocation where;
      where.file = file.reference.name;
      where.block = number;
      auto records = readNodePage(container, context_.area, number);
      if (!records.ok()) {
        if (records.error().code == IssueCode::kSumBlock) file.damaged_blocks[item] = 1;
        return addError(report, records.error(), where);
      }
      pages[item] = std::move(records).value();
    });
    for (const auto& page : pages) {
      if (page.empty()) return false;
    }
    for (const auto& page : pages) context_.records.insert(context_.records.end(), page.begin(), page.end());
    context_.parents.assign(context_.records.size(), 0);
    context_.records_known = true;
    context_.report.nodes_checked = context_.records.size();
    return true;
  }

  // What a record can be wrong in without looking at another one.
  void checkRecord(std::uint32_t number) {
    const NodeRecord& record = context_.record(number);
    if (record.grid >= context_.grids.size()) {
      return complain(IssueCode::kRefRecord, number, fmt::format("grid {} is not in area.json", record.grid));
    }
    if (record.type != NodeType::kTerrain) return;
    const GridGeometry& geometry = context_.grids[record.grid];
    if (record.level >= geometry.header().level_count) {
      return complain(
          IssueCode::kRefRecord, number,
          fmt::format("level {} is not one of the grid's {}", record.level, geometry.header().level_count));
    }
    const PostRange columns = geometry.nodeColumnsAt(record.level), rows = geometry.nodeRowsAt(record.level);
    if (record.x < columns.begin || record.x >= columns.end || record.y < rows.begin ||
        record.y >= rows.end) {
      complain(
          IssueCode::kRefRecord, number,
          fmt::format("position ({}, {}) of level {} is outside the grid", record.x, record.y, record.level));
    }
    checkData(number, record);
  }

  void checkData(std::uint32_t number, const NodeRecord& record) {
    const auto segment = context_.segments.find(record.segment);
    if (segment == context_.segments.end()) {
      return complain(IssueCode::kRefData, number,
                      fmt::format("terrain segment {} is not in area.json", record.segment));
    }
    if (!blocks_.emplace(record.segment, record.block).second) {
      complain(IssueCode::kRefData, number,
               fmt::format("block {} of segment {} belongs to another node already", record.block,
                           record.segment));
    }
    if (!segment->second->container) return;  // reported when it was opened
    const ContainerReader& container = *segment->second->container;
    if (record.block >= container.blockCount()) {
      return complain(IssueCode::kRefData, number,
                      fmt::format("block {} is not among the {} of {}", record.block, container.blockCount(),
                                  segment->second->reference.name));
    }
    const auto location = container.locate(record.block);
    if (location.ok() && location.value().type != BlockType::kTerrainNode) {
      complain(IssueCode::kRefData, number,
               fmt::format("block {} does not hold a node's terrain", record.block));
    }
  }

  // Follows every link from the root on, breadth first.
  void walk() {
    const NodeRecord& root = context_.record(1);
    if (root.type != NodeType::kCluster || root.level != kAreaLevel || root.child_number != 0 ||
        root.sibling != 0) {
      complain(IssueCode::kRefRecord, 1, "record 1 is not the area's cluster node");
    }
    std::vector<bool> reached(count() + std::size_t{1}, false);
    reached[1] = true;
    std::vector<std::uint32_t> queue = {1};
    bool links_sound = true;
    std::uint32_t out_of_order = 0;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const std::uint32_t parent = queue[i];
      std::uint32_t previous = 0;
      std::size_t children = 0;
      for (std::uint32_t child = context_.record(parent).first_child; child != 0;
           child = context_.record(child).sibling) {
        const std::uint32_t from = previous == 0 ? parent : previous;
        if (child > count()) {
          complain(IssueCode::kRefRange, from,
                   fmt::format("it leads to record {}, the last is {}", child, count()));
          links_sound = false;
          break;
        }
        if (reached[child]) {
          complain(IssueCode::kRefCycle, from,
                   fmt::format("it leads to record {}, which has its place already", child));
          links_sound = false;
          break;
        }
        reached[child] = true;
        context_.parents[child - 1] = parent;
        queue.push_back(child);
        if (out_of_order == 0 && child != queue.size()) out_of_order = child;
        checkChild(parent, child, previous, ++children);
        previous = child;
      }
    }
    for (std::uint32_t number = 1; number <= count(); ++number) {
      if (reached[number]) continue;
      complain(IssueCode::kRefUnreachable, number, "no link leads to this record");
      links_sound = false;
    }
    // With a broken link every later record is out of order; that says nothing new.
    if (links_sound && out_of_order != 0) {
      complain(IssueCode::kRefChild, out_of_order,
               "records do not stand in breadth-first order from here on");
    }
  }

  void checkChild(std::uint32_t parent_number, std::uint32_t number, std::uint32_t previous,
                  std::size_t ordinal) {
    const NodeRecord& parent = context_.record(parent_number);
    const NodeRecord& child = context_.record(number);
    const auto wrong = [&](std::string message) {
      complain(IssueCode::kRefChild, number, std::move(message));
    };
    if (parent_number == 1) {
      if (child.type != NodeType::kCluster || child.grid != ordinal - 1 || child.child_number != 0) {
        return wrong(fmt::format("it is not the cluster node of grid {}", ordinal - 1));
      }
      if (child.grid < context_.grids.size() &&
          child.level != context_.grids[child.grid].header().level_count) {
        wrong(fmt::format("its level is {}, not the grid's number of levels", child.level));
      }
      return;
    }
    if (child.type != NodeType::kTerrain || child.grid != parent.grid || child.level + 1 != parent.level) {
      return wrong(fmt::format("it is not one level below record {} of the same grid", parent_number));
    }
    if (ordinal > kMostTerrainChildren)
      return wrong(fmt::format("record {} has more than four children", parent_number));
    if (parent.type == NodeType::kCluster) {
      if (child.child_number != 0) wrong("a node under a cluster has child number 0");
      return;
    }
    const std::int64_t dx = child.x - 2 * static_cast<std::int64_t>(parent.x);
    const std::int64_t dy = child.y - 2 * static_cast<std::int64_t>(parent.y);
    if (dx < 0 || dx > 1 || dy < 0 || dy > 1) {
      return wrong(
          fmt::format("position ({}, {}) is no quarter of record {}", child.x, child.y, parent_number));
    }
    if (child.child_number != childNumber(dx, dy)) {
      return wrong(fmt::format("its child number is {}, its position says {}", child.child_number,
                               childNumber(dx, dy)));
    }
    if (previous != 0 && context_.record(previous).child_number >= child.child_number) {
      wrong("children do not stand in the order of their numbers");
    }
  }

  // Every position of every level must have one node.
  void placeNodes() {
    for (std::uint32_t number = 1; number <= count(); ++number) {
      const NodeRecord& record = context_.record(number);
      if (record.type != NodeType::kTerrain) continue;
      if (!context_.positions.emplace(positionOf(record), number).second) {
        complain(IssueCode::kRefChild, number, "another node stands at the same position");
      }
    }
    std::vector<std::uint32_t> clusters(context_.grids.size(), 0);
    for (std::uint32_t number = 2; number <= count(); ++number) {
      const NodeRecord& record = context_.record(number);
      if (record.type == NodeType::kCluster && record.grid < clusters.size()) ++clusters[record.grid];
    }
    for (std::size_t grid = 0; grid < context_.grids.size(); ++grid) {
      if (clusters[grid] == 0) {
        IssueLocation where;
        where.file = context_.nodes->reference.name;
        context_.report.add(
            makeIssue(IssueCode::kRefMissing, fmt::format("grid {} has no cluster node", grid), where));
        continue;
      }
      for (int level = 0; level < context_.grids[grid].header().level_count; ++level) checkLevel(grid, level);
    }
  }

  void checkLevel(std::size_t grid, int level) {
    const PostRange columns = context_.grids[grid].nodeColumnsAt(level),
                    rows = context_.grids[grid].nodeRowsAt(level);
    // A hostile header may name a level of any size: the walk ends at the first gap, so after at most as many
    // steps as there are records.
    for (std::int64_t y = rows.begin; y < rows.end; ++y) {
      for (std::int64_t x = columns.begin; x < columns.end; ++x) {
        const NodePosition position{static_cast<std::uint16_t>(grid), static_cast<std::uint8_t>(level),
                                    static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
        if (context_.recordAt(position) != 0) continue;
        IssueLocation where;
        where.file = context_.nodes->reference.name;
        where.level = level;
        where.x = position.x;
        where.y = position.y;
        context_.report.add(makeIssue(
            IssueCode::kRefMissing,
            fmt::format("level {} of grid {} has no node here (first of the level)", level, grid), where));
        return;
      }
    }
  }

  // What area.json says of the whole area must follow from its grids: no outermost post lies outside the
  // bounds, and each bound is reached by one. A pole inside a projected grid is a bound by itself.
  void checkHeader() {
    if (!context_.positions_known) return;
    const AreaHeader& area = context_.area;
    constexpr double kDegreeTolerance = 1e-9;
    bool outside = false, north = area.north == 90, south = area.south == -90;
    bool west = area.east - area.west >= 360, east = west;
    const auto see = [&](const GeodeticPoint& post) {
      // How far east of the western bound: a hair west of it counts as on it.
      double from_west = std::fmod(post.longitude - area.west, 360.0);
      if (from_west < -kDegreeTolerance) from_west += 360;
      if (from_west > 360 - kDegreeTolerance) from_west -= 360;
      const double width = area.east - area.west;
      outside = outside || from_west > width + kDegreeTolerance ||
                post.latitude > area.north + kDegreeTolerance ||
                post.latitude < area.south - kDegreeTolerance;
      west = west || std::abs(from_west) <= kDegreeTolerance;
      east = east || std::abs(from_west - width) <= kDegreeTolerance;
      north = north || std::abs(post.latitude - area.north) <= kDegreeTolerance;
      south = south || std::abs(post.latitude - area.south) <= kDegreeTolerance;
    };
    for (const GridGeometry& geometry : context_.grids) {
      const PostRange columns = geometry.columnsAt(0), rows = geometry.rowsAt(0);
      const bool geodetic = geometry.isGeodetic();
      // The corners of a geodetic grid are its bounds; a projected one may bulge anywhere along its sides.
      const std::int64_t column_step = geodetic ? columns.size() - 1 : 1;
      const std::int64_t row_step = geodetic ? rows.size() - 1 : 1;
      for (std::int64_t column = columns.begin; column < columns.end; column += column_step) {
        see(geometry.geodeticAt(column, rows.begin));
        see(geometry.geodeticAt(column, rows.end - 1));
      }
      for (std::int64_t row = rows.begin; row < rows.end; row += row_step) {
        see(geometry.geodeticAt(columns.begin, row));
        see(geometry.geodeticAt(columns.end - 1, row));
      }
    }
    if (outside || !west || !east || !north || !south) {
      IssueLocation where;
      where.file = std::string(kAreaFileName);
      context_.report.add(makeIssue(IssueCode::kManField, "the bounds are not those of the grids", where));
    }
  }

  // What a record says of the nodes below it, and of its own number of posts.
  void checkSummary(std::uint32_t number) {
    const NodeRecord& record = context_.record(number);
    if (record.type == NodeType::kTerrain) checkCounts(number, record);
    if (record.isEmpty() &&
        (record.radius != 0 || record.minimum_height != 0 || record.maximum_height != 0)) {
      complain(IssueCode::kRefRecord, number, "an empty node has a sphere or a height range");
    }
    if (record.first_child == 0) return;
    bool empty = true;
    std::int32_t lowest = 0, highest = 0;
    for (std::uint32_t child = record.first_child; child != 0; child = context_.record(child).sibling) {
      const NodeRecord& below = context_.record(child);
      if (below.isEmpty()) continue;
      const std::int32_t low =
          number == 1 ? metresBelow(below.grid, below.minimum_height) : below.minimum_height;
      const std::int32_t high =
          number == 1 ? metresAbove(below.grid, below.maximum_height) : below.maximum_height;
      lowest = empty ? low : std::min(lowest, low);
      highest = empty ? high : std::max(highest, high);
      empty = false;
    }
    if (empty != record.isEmpty()) {
      complain(IssueCode::kTileVoids, number,
               empty ? "it is not marked empty, but all nodes below are"
                     : "it is marked empty, but a node below is not");
      return;
    }
    if (!empty && (record.minimum_height != lowest || record.maximum_height != highest)) {
      complain(IssueCode::kTileHeightRange, number,
               fmt::format("its heights are {} to {}, those below it {} to {}", record.minimum_height,
                           record.maximum_height, lowest, highest));
    }
  }

  // The area's record counts in metres, since grids may differ in their quantum: the range rounded outwards.
  std::int32_t metresBelow(std::size_t grid, std::int32_t quanta) const {
    return fitting(std::floor(context_.grids[grid].metres(quanta)));
  }
  std::int32_t metresAbove(std::size_t grid, std::int32_t quanta) const {
    return fitting(std::ceil(context_.grids[grid].metres(quanta)));
  }
  static std::int32_t fitting(double metres) {
    return static_cast<std::int32_t>(std::clamp<double>(metres, INT32_MIN, INT32_MAX));
  }

  void checkCounts(std::uint32_t number, const NodeRecord& record) {
    const GridGeometry& geometry = context_.grids[record.grid];
    const std::int64_t posts = geometry.nodePosts(geometry.columnsAt(record.level), record.x).size() *
                               geometry.nodePosts(geometry.rowsAt(record.level), record.y).size();
    if (record.valid_posts > posts) {
      return complain(IssueCode::kTileVoids, number,
                      fmt::format("{} of its {} posts are said to be valid", record.valid_posts, posts));
    }
    const bool has_voids = (record.flags & kNodeHasVoids) != 0;
    if (has_voids != (record.valid_posts < posts)) {
      return complain(IssueCode::kTileVoids, number,
                      fmt::format("its flag says {} void, but {} of {} posts are valid",
                                  has_voids ? "some" : "none", record.valid_posts, posts));
    }
    if (record.isEmpty() ? record.valid_posts != 0 : record.level == 0 && record.valid_posts == 0) {
      complain(IssueCode::kTileVoids, number,
               fmt::format("it is {}marked empty and has {} valid posts", record.isEmpty() ? "" : "not ",
                           record.valid_posts));
    }
  }

  CheckContext& context_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> blocks_;  // in use
};

}  // namespace

IssueLocation CheckContext::locate(std::uint32_t number) const {
  IssueLocation where;
  if (nodes != nullptr) where.file = nodes->reference.name;
  where.node = number;
  where.block = (number - 1) / area.nodes_per_page;
  if (number == 0 || number > records.size()) return where;
  const NodeRecord& node = record(number);
  if (node.type != NodeType::kTerrain || node.grid >= grids.size()) return where;
  where.level = node.level;
  where.x = node.x;
  where.y = node.y;
  const GridGeometry& geometry = grids[node.grid];
  if (node.level >= geometry.header().level_count) return where;
  if (!positions_known) return where;
  const auto middle = [&](std::int32_t index, PostRange all) {
    // In floating point: a damaged position may be any number.
    const double span = std::ldexp(geometry.header().leaf_cells, node.level);
    return static_cast<std::int64_t>(
        std::clamp((index + 0.5) * span, static_cast<double>(all.begin), static_cast<double>(all.end - 1)));
  };
  const GeodeticPoint post =
      geometry.geodeticAt(middle(node.x, geometry.columnsAt(0)), middle(node.y, geometry.rowsAt(0)));
  where.longitude = post.longitude;
  where.latitude = post.latitude;
  return where;
}

void checkTree(CheckContext& context) {
  TreeRule(context).run();
}

}  // namespace deltaz
