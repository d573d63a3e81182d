// Colour maps: every tile against its neighbours and against the finer tiles it is the mean of.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

#include "libdb/access/color.h"
#include "libdb/check/block_reading.h"
#include "libdb/check/check_colors.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

constexpr int kTexels = kColorTileTexels;
using Texels = std::shared_ptr<const std::vector<std::uint8_t>>;

// Texel (i, j) of a tile, -1 .. kTexels: four values.
const std::uint8_t* texelOf(const Texels& tile, int i, int j) {
  return &(*tile)[4 * static_cast<std::size_t>((j + 1) * kColorTileSide + i + 1)];
}

// Decoded tiles, of which a bounded number is kept, those used last.
class ColorTiles {
 public:
  explicit ColorTiles(CheckedColorMap& map) : map_(map) {}

  // Record `number`'s tile; nothing if it cannot be read. What is wrong with it goes to `report` if one is
  // given: the node itself reports it, those beside it do not.
  Texels load(std::uint32_t number, Report* report) {
    if (number == 0) return nullptr;
    if (const Texels kept = keptTile(number)) return kept;
    CheckedFile& file = *map_.file;
    const std::uint32_t block = map_.nodes[number - 1].block;
    Report own;
    const auto bytes = readBlock(file, block, BlockType::kColorTile, IssueCode::kColorTree, own);
    if (!bytes) {
      if (own.fatal) rememberRefusal(*own.fatal);
      if (report != nullptr) mergeReport(*report, std::move(own));
      return nullptr;
    }
    auto texels = decodeColorTile(*bytes, fmt::format("{}, block {}", file.container->path(), block));
    if (!texels.ok()) {
      if (report != nullptr) addError(*report, texels.error(), whereBlock(file, block));
      return nullptr;
    }
    return keep(number, std::make_shared<const std::vector<std::uint8_t>>(std::move(texels).value()));
  }

  // Reports that the system refused a read, if nobody has yet: what could not be compared must not pass for
  // compared.
  void reportRefusal(Report& report) const {
    if (refused_ && !report.fatal) addError(report, *refused_);
  }

 private:
  static constexpr std::size_t kKeptTiles = (64u << 20) / kColorTileBytes;

  Texels keptTile(std::uint32_t number) {
    const std::lock_guard guard(mutex_);
    const auto found = places_.find(number);
    if (found == places_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->second;
  }

  Texels keep(std::uint32_t number, Texels tile) {
    const std::lock_guard guard(mutex_);
    if (places_.contains(number)) return tile;
    entries_.emplace_front(number, tile);
    places_[number] = entries_.begin();
    if (entries_.size() > kKeptTiles) {
      places_.erase(entries_.back().first);
      entries_.pop_back();
    }
    return tile;
  }

  void rememberRefusal(const Error& error) {
    const std::lock_guard guard(mutex_);
    if (!refused_) refused_ = error;
  }

  CheckedColorMap& map_;
  std::mutex mutex_;
  std::list<std::pair<std::uint32_t, Texels>> entries_;  // last used first
  std::unordered_map<std::uint32_t, std::list<std::pair<std::uint32_t, Texels>>::iterator> places_;
  std::optional<Error> refused_;
};

// How many texels differ, and by how much in the worst of their values.
struct Difference {
  std::size_t texels = 0;
  int worst = 0;
  void add(const std::uint8_t* a, const std::uint8_t* b) {
    int largest = 0;
    for (int k = 0; k < 4; ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
    texels += largest > 0 ? 1 : 0;
    worst = std::max(worst, largest);
  }
};

struct Place {
  std::uint16_t grid = 0;
  int level = 0;
  std::int32_t x = 0, y = 0;
  bool operator==(const Place&) const = default;
};
struct PlaceHash {
  std::size_t operator()(const Place& place) const {
    std::uint64_t value = static_cast<std::uint32_t>(place.x);
    value = (value << 32) | static_cast<std::uint32_t>(place.y);
    value = (value ^ (value >> 29)) * 0xBF58476D1CE4E5B9u;
    value += (static_cast<std::uint64_t>(place.grid) << 8 | static_cast<std::uint8_t>(place.level)) *
             0x94D049BB133111EBu;
    return static_cast<std::size_t>(value ^ (value >> 32));
  }
};

class ColorTileRule {
 public:
  ColorTileRule(CheckContext& context, CheckedColorMap& map) : context_(context), map_(map), tiles_(map) {
    for (std::uint32_t number = 1; number <= map_.nodes.size(); ++number) {
      const ColorNode& node = map_.nodes[number - 1];
      numbers_[{node.grid, node.level, node.x, node.y}] = number;
    }
    for (int code = 0; code < 256; ++code)
      linear_[static_cast<std::size_t>(code)] = decodeSrgb(static_cast<std::uint8_t>(code));
  }

  void run() {
    constexpr std::size_t kGrain = 16;
    parallelReport(context_.report, map_.nodes.size(), kGrain, [&](std::size_t item, Report& report) {
      const auto number = static_cast<std::uint32_t>(item + 1);
      const Texels tile = tiles_.load(number, &report);
      if (!tile) return;
      checkBorder(number, tile, report);
      checkFilter(number, tile, report);
    });
    tiles_.reportRefusal(context_.report);
  }

 private:
  IssueLocation whereNode(std::uint32_t number) const {
    const ColorNode& node = map_.nodes[number - 1];
    IssueLocation where = whereBlock(*map_.file, node.block);
    where.node = number;
    where.level = node.level;
    where.x = node.x;
    where.y = node.y;
    return where;
  }

  void checkBorder(std::uint32_t number, const Texels& tile, Report& report) {
    const ColorNode& node = map_.nodes[number - 1];
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const auto found = numbers_.find({node.grid, node.level, node.x + dx, node.y + dy});
        if (found == numbers_.end()) continue;
        const Texels other = tiles_.load(found->second, nullptr);
        if (!other) continue;
        compareBorder(number, tile, found->second, other, dx, dy, report);
      }
    }
  }

  void compareBorder(std::uint32_t number, const Texels& tile, std::uint32_t neighbour, const Texels& other,
                     int dx, int dy, Report& report) {
    // The texels of the border on that side: a row, a column or a corner.
    const auto range = [](int step) {
      return step < 0 ? std::pair(-1, 0) : step > 0 ? std::pair(kTexels, kTexels + 1) : std::pair(0, kTexels);
    };
    const auto [first_i, end_i] = range(dx);
    const auto [first_j, end_j] = range(dy);
    Difference difference;
    for (int j = first_j; j < end_j; ++j) {
      for (int i = first_i; i < end_i; ++i)
        difference.add(texelOf(tile, i, j), texelOf(other, i - dx * kTexels, j - dy * kTexels));
    }
    if (difference.texels == 0) return;
    addLazily(report, IssueCode::kColorBorder, difference.worst, [&] {
      return makeIssue(IssueCode::kColorBorder,
                       fmt::format("{} texels of its border differ from those of record {}, by up to {}",
                                   difference.texels, neighbour, difference.worst),
                       whereNode(number), difference.worst);
    });
  }

  void checkFilter(std::uint32_t number, const Texels& tile, Report& report) {
    const ColorNode& node = map_.nodes[number - 1];
    // The quadrant of each child, in the order of their numbers.
    static constexpr std::array<std::array<int, 2>, 4> kQuadrants = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    std::uint32_t next = node.first_child;
    for (std::size_t k = 0; k < kQuadrants.size(); ++k) {
      if ((node.children & (1u << k)) == 0) continue;
      const std::uint32_t child = next++;
      const Texels finer = tiles_.load(child, nullptr);
      if (!finer) continue;
      Difference difference;
      for (int j = 0; j < kTexels / 2; ++j) {
        for (int i = 0; i < kTexels / 2; ++i) {
          const std::array<std::uint8_t, 4> mean = meanOf(finer, 2 * i, 2 * j);
          difference.add(
              texelOf(tile, i + kQuadrants[k][0] * kTexels / 2, j + kQuadrants[k][1] * kTexels / 2),
              mean.data());
        }
      }
      if (difference.texels == 0) continue;
      addLazily(report, IssueCode::kColorFilter, difference.worst, [&] {
        return makeIssue(IssueCode::kColorFilter,
                         fmt::format("{} texels are not the means of those of record {} below, by up to {}",
                                     difference.texels, child, difference.worst),
                         whereNode(number), difference.worst);
      });
    }
  }

  // What the texel over the four from (i, j) on must be.
  std::array<std::uint8_t, 4> meanOf(const Texels& finer, int i, int j) const {
    double red = 0, green = 0, blue = 0;
    int cover = 0;
    for (int dj = 0; dj < 2; ++dj) {
      for (int di = 0; di < 2; ++di) {
        const std::uint8_t* texel = texelOf(finer, i + di, j + dj);
        red += texel[3] * linear_[texel[0]];
        green += texel[3] * linear_[texel[1]];
        blue += texel[3] * linear_[texel[2]];
        cover += texel[3];
      }
    }
    const auto mean = static_cast<std::uint8_t>((cover + 2) / 4);
    if (mean == 0) return {};
    return {encodeSrgb(red / cover), encodeSrgb(green / cover), encodeSrgb(blue / cover), mean};
  }

  CheckContext& context_;
  CheckedColorMap& map_;
  ColorTiles tiles_;
  std::unordered_map<Place, std::uint32_t, PlaceHash> numbers_;
  std::array<double, 256> linear_{};
};

}  // namespace

void checkColorTiles(CheckContext& context) {
  for (CheckedColorMap& map : context.color_maps) {
    if (map.tree_sound) ColorTileRule(context, map).run();
  }
}

}  // namespace deltaz
