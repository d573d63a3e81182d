// Colour maps: that the records of a map form the trees its directory announces, each tile with a block of
// its own.
#include "libdb/check/check_colors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "libdb/check/block_reading.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

class ColorTreeRule {
 public:
  ColorTreeRule(CheckContext& context, CheckedColorMap& map)
      : context_(context), map_(map), file_(*map.file) {}

  void run() {
    const std::uint64_t errors = context_.report.count(Severity::kError);
    if (!readDirectory() || !readRecords()) {
      addSkipped(context_.report,
                 fmt::format("the tiles of {}, whose records could not all be read", file_.reference.name));
      return;
    }
    checkTiles();
    reached_.assign(map_.nodes.size(), 0);
    for (const ColorTree& tree : map_.directory.trees) walk(tree);
    for (std::uint32_t number = 1; number <= map_.nodes.size(); ++number) {
      if (reached_[number - 1] == 0) complain(number, "no link leads to it");
    }
    if (context_.report.count(Severity::kError) == errors) checkOrder();
    map_.tree_sound = context_.report.count(Severity::kError) == errors;
    if (!map_.tree_sound) {
      addSkipped(context_.report,
                 fmt::format("the tiles of {}, whose tree is damaged", file_.reference.name));
    }
  }

 private:
  bool readDirectory() {
    const std::uint32_t blocks = file_.container->blockCount();
    if (blocks == 0) {
      IssueLocation where;
      where.file = file_.reference.name;
      context_.report.add(makeIssue(IssueCode::kColorTree, "the file has no directory", where));
      return false;
    }
    const auto bytes =
        readBlock(file_, blocks - 1, BlockType::kColorDirectory, IssueCode::kColorTree, context_.report);
    if (!bytes) return false;
    auto directory = decodeColorDirectory(*bytes, blocks, file_.container->path());
    if (!directory.ok()) {
      addError(context_.report, directory.error(), whereBlock(file_, blocks - 1));
      return false;
    }
    map_.directory = std::move(directory).value();
    for (const ColorTree& tree : map_.directory.trees) {
      if (tree.grid < context_.area.grids.size()) continue;
      context_.report.add(makeIssue(IssueCode::kColorTree,
                                    fmt::format("a tree is of grid {}, which is not there", tree.grid),
                                    whereBlock(file_, blocks - 1)));
      return false;
    }
    return true;
  }

  bool readRecords() {
    const std::uint32_t first = map_.directory.first_page;
    std::vector<std::vector<ColorNode>> pages(file_.container->blockCount() - 1 - first);
    parallelReport(context_.report, pages.size(), 4, [&](std::size_t item, Report& report) {
      const auto block = static_cast<std::uint32_t>(first + item);
      const auto bytes = readBlock(file_, block, BlockType::kColorPage, IssueCode::kColorTree, report);
      if (!bytes) return;
      auto nodes = decodeColorPage(*bytes, file_.container->path());
      if (!nodes.ok()) return addError(report, nodes.error(), whereBlock(file_, block));
      const std::size_t expected =
          std::min<std::size_t>(kColorNodesPerPage, map_.directory.node_count - item * kColorNodesPerPage);
      if (nodes.value().size() != expected) {
        return report.add(
            makeIssue(IssueCode::kColorTree,
                      fmt::format("the page has {} records, not {}", nodes.value().size(), expected),
                      whereBlock(file_, block)));
      }
      pages[item] = std::move(nodes).value();
    });
    if (std::any_of(pages.begin(), pages.end(), [](const auto& page) { return page.empty(); })) return false;
    for (const auto& page : pages) map_.nodes.insert(map_.nodes.end(), page.begin(), page.end());
    return true;
  }

  void complain(std::uint32_t number, std::string message) {
    addLazily(context_.report, IssueCode::kColorTree, 0, [&] {
      const ColorNode& node = map_.nodes[number - 1];
      IssueLocation where;
      where.file = file_.reference.name;
      where.node = number;
      where.level = node.level;
      where.x = node.x;
      where.y = node.y;
      return makeIssue(IssueCode::kColorTree, std::move(message), where);
    });
  }

  // There are as many blocks before the first page as records, so each of them belongs to one.
  void checkTiles() {
    std::vector<std::uint8_t> used(map_.directory.first_page, 0);
    for (std::uint32_t number = 1; number <= map_.nodes.size(); ++number) {
      const std::uint32_t block = map_.nodes[number - 1].block;
      if (block >= used.size()) {
        complain(number, fmt::format("block {} is not among the {} of tiles", block, used.size()));
        continue;
      }
      if (used[block] != 0) complain(number, fmt::format("block {} belongs to another node", block));
      used[block] = 1;
      const auto location = file_.container->locate(block);
      if (location.ok() && location.value().type != BlockType::kColorTile)
        complain(number, fmt::format("block {} is no tile", block));
    }
  }

  bool reach(std::uint32_t number) {
    if (reached_[number - 1] != 0) {
      complain(number, "two links lead to it");
      return false;
    }
    reached_[number - 1] = 1;
    return true;
  }

  void walk(const ColorTree& tree) {
    std::vector<std::uint32_t> open;
    std::set<std::pair<std::int32_t, std::int32_t>> roots;
    for (std::uint32_t root = 0; root < tree.root_count; ++root) {
      const std::uint32_t number = tree.first_root + root;
      const ColorNode& node = map_.nodes[number - 1];
      if (!reach(number)) continue;
      if (node.grid != tree.grid || node.level != tree.coarsest_level) {
        complain(number, fmt::format("it is not of grid {} and level {}, as its tree says", tree.grid,
                                     tree.coarsest_level));
        continue;
      }
      if (!roots.emplace(node.x, node.y).second) complain(number, "another one stands at its place");
      open.push_back(number);
    }
    int finest = tree.coarsest_level;
    while (!open.empty()) {
      const std::uint32_t number = open.back();
      open.pop_back();
      finest = std::min<int>(finest, map_.nodes[number - 1].level);
      checkChildren(number, open);
    }
    if (finest == tree.finest_level) return;
    context_.report.add(makeIssue(IssueCode::kColorTree,
                                  fmt::format("the finest nodes over grid {} are of level {}, not {}",
                                              tree.grid, finest, tree.finest_level),
                                  whereBlock(file_, file_.container->blockCount() - 1)));
  }

  // Breadth first over all trees: children follow each other in the order of their parents.
  void checkOrder() {
    std::uint64_t next = 1;
    for (const ColorTree& tree : map_.directory.trees) next += tree.root_count;
    for (std::uint32_t number = 1; number <= map_.nodes.size(); ++number) {
      const ColorNode& node = map_.nodes[number - 1];
      if (node.children == 0) continue;
      if (node.first_child != next) {
        complain(number, fmt::format("its children begin at record {}, not {}, and are not in breadth-first "
                                     "order",
                                     node.first_child, next));
        return;
      }
      next += static_cast<std::uint64_t>(std::popcount(node.children));
    }
  }

  // Those that stand where they should are added to `open`.
  void checkChildren(std::uint32_t number, std::vector<std::uint32_t>& open) {
    const ColorNode& node = map_.nodes[number - 1];
    // The south-western child and the steps to the others, in the order of their numbers.
    static constexpr std::array<std::array<int, 2>, 4> kSteps = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    std::uint64_t child = node.first_child;
    for (std::size_t k = 0; k < kSteps.size(); ++k) {
      if ((node.children & (1u << k)) == 0) continue;
      const std::uint64_t at = child++;
      if (at > map_.nodes.size()) {
        complain(number, fmt::format("its child {} does not exist", at));
        continue;
      }
      const auto below_number = static_cast<std::uint32_t>(at);
      if (!reach(below_number)) continue;
      const ColorNode& below = map_.nodes[at - 1];
      if (below.grid == node.grid && below.level + 1 == node.level &&
          std::int64_t{below.x} == 2 * std::int64_t{node.x} + kSteps[k][0] &&
          std::int64_t{below.y} == 2 * std::int64_t{node.y} + kSteps[k][1]) {
        open.push_back(below_number);
        continue;
      }
      complain(below_number, fmt::format("its parent, record {}, puts another one there", number));
    }
  }

  CheckContext& context_;
  CheckedColorMap& map_;
  CheckedFile& file_;
  std::vector<std::uint8_t> reached_;
};

}  // namespace

void checkColorTrees(CheckContext& context) {
  for (CheckedFile& file : context.listed) {
    if (file.reference.role != FileRole::kColors || !file.container) continue;
    CheckedColorMap& map = context.color_maps.emplace_back();
    map.file = &file;
    ColorTreeRule(context, map).run();
  }
}

}  // namespace deltaz
