#include "libdb/build/color_pyramid.h"

#include <algorithm>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "libdb/build/color_filter.h"
#include "libdb/build/color_plan.h"
#include "libdb/build/color_texel.h"

namespace deltaz {

namespace {

constexpr std::size_t kTilesPerBatch = 64;
constexpr int kSide = kColorTileTexels, kHalf = kColorTileTexels / 2;

using Texels = std::vector<Texel>;  // kSide * kSide, row by row from the south-west

struct PlaceHash {
  std::size_t operator()(const ColorPlace& place) const {
    std::uint64_t value =
        (std::uint64_t{static_cast<std::uint32_t>(place.x)} << 32) | static_cast<std::uint32_t>(place.y);
    value = (value ^ (value >> 29) ^ static_cast<std::uint64_t>(place.level)) * 0xBF58476D1CE4E5B9u;
    return static_cast<std::size_t>(value ^ (value >> 32));
  }
};

struct TileState {
  bool computed = false;
  bool exists = false;  // it has cover, or a child has
  bool written = false;
  std::unique_ptr<Texels> texels;  // from when it is computed until nobody needs them
};

std::size_t at(int column, int row) {
  return static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column);
}

class PyramidBuild {
 public:
  PyramidBuild(std::uint16_t number, const GridHeader& grid, const ColorField& field,
               const ColorPyramidOptions& options, WorkerPool& workers, ColorMapWriter& writer)
      : grid_(grid),
        filter_(field, grid),
        options_(options),
        workers_(workers),
        writer_(writer),
        plan_(planColorTiles(number, grid, field, options.last_level)),
        states_(plan_.size()) {
    for (std::size_t k = 0; k < plan_.size(); ++k)
      index_.emplace(plan_[k].place, static_cast<std::int32_t>(k));
  }

  Status run() {
    for (std::size_t first = 0; first < plan_.size(); first += kTilesPerBatch) {
      const std::size_t end = std::min(first + kTilesPerBatch, plan_.size());
      DELTAZ_TRY(compute(first, end));
      DELTAZ_TRY(writeReady());
      release();
      if (options_.progress) options_.progress(static_cast<double>(end) / static_cast<double>(plan_.size()));
    }
    return Success{};
  }

 private:
  // Does `work` for every item on the workers, and returns the first error in the order of the items.
  Status forEach(const std::vector<std::size_t>& items,
                 const std::function<Status(std::size_t position, std::size_t item)>& work) {
    std::vector<Status> results(items.size(), Success{});
    workers_.forEach(items.size(), [&](std::size_t k) { results[k] = work(k, items[k]); });
    for (const Status& result : results) DELTAZ_TRY(result);
    return Success{};
  }

  Status compute(std::size_t first, std::size_t end) {
    // Children first: they may be of the same batch.
    std::map<int, std::vector<std::size_t>> of_level;
    for (std::size_t k = first; k < end; ++k) of_level[plan_[k].place.level].push_back(k);
    for (const auto& [level, tiles] : of_level) {
      DELTAZ_TRY(forEach(tiles, [&](std::size_t, std::size_t tile) { return computeTile(tile); }));
      held_.insert(held_.end(), tiles.begin(), tiles.end());
    }
    std::sort(held_.begin(), held_.end());
    return Success{};
  }

  Status computeTile(std::size_t tile) {
    const PlannedTile& planned = plan_[tile];
    auto texels = std::make_unique<Texels>(std::size_t{kSide} * kSide);
    bool has_child = false;
    const Halves halves = halvesOverGrid(planned.place);
    for (int number = 1; number <= 4; ++number) {
      const std::int32_t child = planned.children[static_cast<std::size_t>(number - 1)];
      const int column = number == 2 || number == 3 ? kHalf : 0, row = number >= 3 ? kHalf : 0;
      if (child == kNoTile) {
        if (!halves.columns[column > 0 ? 1 : 0] || !halves.rows[row > 0 ? 1 : 0]) continue;
        DELTAZ_TRY(sampleInto(planned.place, column, row, kHalf, kHalf, *texels));
        continue;
      }
      const TileState& below = states_[static_cast<std::size_t>(child)];
      if (!below.exists) continue;
      has_child = true;
      const Texels& finer = *below.texels;
      for (int j = 0; j < kHalf; ++j) {
        for (int i = 0; i < kHalf; ++i) {
          (*texels)[at(column + i, row + j)] =
              meanTexel(finer[at(2 * i, 2 * j)], finer[at(2 * i + 1, 2 * j)], finer[at(2 * i, 2 * j + 1)],
                        finer[at(2 * i + 1, 2 * j + 1)]);
        }
      }
    }
    extend(halves, *texels);
    TileState& state = states_[tile];
    state.exists = has_child || std::any_of(texels->begin(), texels->end(),
                                            [](const Texel& texel) { return texel[3] != 0; });
    if (state.exists) state.texels = std::move(texels);
    state.computed = true;
    return Success{};
  }

  // Which halves of a node, west and east, south and north, hold a part of the grid.
  struct Halves {
    std::array<bool, 2> columns{}, rows{};
  };
  Halves halvesOverGrid(const ColorPlace& place) const {
    const PlaneSpan span = nodesOverGrid(grid_, place.level - 1);
    const std::int64_t x = std::int64_t{2} * place.x, y = std::int64_t{2} * place.y;
    return {{span.holdsColumn(x), span.holdsColumn(x + 1)}, {span.holdsRow(y), span.holdsRow(y + 1)}};
  }

  // Quarters with nothing of the grid repeat the texels nearest to them.
  static void extend(const Halves& halves, Texels& texels) {
    const auto nearest = [](const std::array<bool, 2>& over, int index) {
      return over[index < kHalf ? 0 : 1] ? index : index < kHalf ? kHalf : kHalf - 1;
    };
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column)
        texels[at(column, row)] = texels[at(nearest(halves.columns, column), nearest(halves.rows, row))];
    }
  }

  TexelBlock part(const ColorPlace& place, int column, int row, int columns, int rows) const {
    TexelBlock block = blockOf(place, place.level);
    block.first_column += column;
    block.first_row += row;
    block.columns = columns;
    block.rows = rows;
    return block;
  }

  // The field's texels of a part of a node.
  Status sampleInto(const ColorPlace& place, int column, int row, int columns, int rows,
                    Texels& texels) const {
    std::vector<CoveredColor> colors(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    DELTAZ_TRY(filter_.texels(part(place, column, row, columns, rows), colors));
    std::size_t k = 0;
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) texels[at(column + i, row + j)] = storedTexel(colors[k++]);
    }
    return Success{};
  }

  std::int32_t find(const ColorPlace& place) const {
    const auto found = index_.find(place);
    return found == index_.end() ? kNoTile : found->second;
  }

  static ColorPlace neighbour(const ColorPlace& place, int dx, int dy) {
    return {place.grid, place.level, place.x + dx, place.y + dy};
  }

  // Whether `test` holds for all eight neighbours that are planned.
  template <typename Test>
  bool ofNeighbours(const ColorPlace& place, const Test& test) const {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const std::int32_t other = find(neighbour(place, dx, dy));
        if (other != kNoTile && !test(states_[static_cast<std::size_t>(other)])) return false;
      }
    }
    return true;
  }

  // Writes the tiles whose neighbours are all known by now, in the order of the plan.
  Status writeReady() {
    std::vector<std::size_t> ready;
    for (const std::size_t tile : held_) {
      const TileState& state = states_[tile];
      if (!state.exists || state.written) continue;
      if (ofNeighbours(plan_[tile].place, [](const TileState& other) { return other.computed; }))
        ready.push_back(tile);
    }
    std::vector<std::vector<std::byte>> blocks(ready.size());
    DELTAZ_TRY(forEach(ready, [&](std::size_t position, std::size_t tile) -> Status {
      DELTAZ_TRY_ASSIGN(blocks[position], encode(tile));
      return Success{};
    }));
    for (std::size_t k = 0; k < ready.size(); ++k) {
      DELTAZ_TRY(writer_.add(plan_[ready[k]].place, blocks[k]));
      states_[ready[k]].written = true;
    }
    return Success{};
  }

  // The tile with its border.
  Result<std::vector<std::byte>> encode(std::size_t tile) const {
    const ColorPlace& place = plan_[tile].place;
    std::vector<std::uint8_t> bytes(kColorTileBytes);
    const auto put = [&](int column, int row, const Texel& texel) {
      const auto k =
          static_cast<std::size_t>(row + 1) * kColorTileSide + static_cast<std::size_t>(column + 1);
      std::copy(texel.begin(), texel.end(), bytes.begin() + static_cast<std::ptrdiff_t>(4 * k));
    };
    const PlaneSpan span = nodesOverGrid(grid_, place.level);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        // What lies on this side, in the tile's own texels.
        const int column = dx < 0 ? -1 : dx * kSide, row = dy < 0 ? -1 : dy * kSide;
        const int columns = dx == 0 ? kSide : 1, rows = dy == 0 ? kSide : 1;
        // Beyond the grid the nearest texels are repeated.
        const int over_x = span.holdsColumn(std::int64_t{place.x} + dx) ? dx : 0,
                  over_y = span.holdsRow(std::int64_t{place.y} + dy) ? dy : 0;
        const std::int32_t other = find(neighbour(place, over_x, over_y));
        if (other != kNoTile && states_[static_cast<std::size_t>(other)].exists) {
          const Texels& texels = *states_[static_cast<std::size_t>(other)].texels;
          const auto within = [](int index) { return std::clamp(index, 0, kSide - 1); };
          for (int j = 0; j < rows; ++j) {
            for (int i = 0; i < columns; ++i)
              put(column + i, row + j,
                  texels[at(within(column + i - over_x * kSide), within(row + j - over_y * kSide))]);
          }
          continue;
        }
        std::vector<CoveredColor> colors(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
        DELTAZ_TRY(filter_.texels(part(place, column, row, columns, rows), colors));
        std::size_t k = 0;
        for (int j = 0; j < rows; ++j) {
          for (int i = 0; i < columns; ++i) put(column + i, row + j, storedTexel(colors[k++]));
        }
      }
    }
    return encodeColorTile(bytes);
  }

  // Lets go of texels that neither a parent nor a border waits for.
  void release() {
    const auto done = [](const TileState& state) {
      return state.computed && (state.written || !state.exists);
    };
    std::erase_if(held_, [&](std::size_t tile) {
      if (!states_[tile].exists) return true;
      const std::int32_t parent = plan_[tile].parent;
      if (!done(states_[tile]) ||
          (parent != kNoTile && !states_[static_cast<std::size_t>(parent)].computed) ||
          !ofNeighbours(plan_[tile].place, done))
        return false;
      states_[tile].texels.reset();
      return true;
    });
  }

  const GridHeader& grid_;
  ColorFilter filter_;
  const ColorPyramidOptions& options_;
  WorkerPool& workers_;
  ColorMapWriter& writer_;
  std::vector<PlannedTile> plan_;
  std::vector<TileState> states_;
  std::unordered_map<ColorPlace, std::int32_t, PlaceHash> index_;
  std::vector<std::size_t> held_;  // tiles whose texels are kept, in the order of the plan
};

}  // namespace

Status buildColorPyramid(std::uint16_t number, const GridHeader& grid, const ColorField& field,
                         const ColorPyramidOptions& options, WorkerPool& workers, ColorMapWriter& writer) {
  return PyramidBuild(number, grid, field, options, workers, writer).run();
}

}  // namespace deltaz
