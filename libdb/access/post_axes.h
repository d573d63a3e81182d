// The row and column constants of a geodetic grid (libdb/access/earth.h), and their steps from post to post,
// computed once: sines and cosines cost more than all else that is done to a post.
//
// They are kept in blocks of kBlock posts of a level, each made when it is first asked for. Memory: at most
// 128 bytes a row and 64 a column, all levels together; nothing for posts no one asks for. Thread-safety:
// const members from any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include "formats/area.h"
#include "libdb/access/earth.h"

namespace deltaz {

struct PostRange;

// Of one row: its constants, and what they change by to the next row of the level.
struct RowTerms {
  RowConstants at;
  RowStep step;
};

// Of columns, one entry each, padded (libdb/access/vector_lists.h): their constants, and what they change by
// to the next column of the level.
struct ColumnTerms {
  std::vector<double> cosine, sine, step_cosine, step_sine;
};

class PostAxes {
 public:
  explicit PostAxes(const GridHeader& grid);

  // Of level-`level` posts [range.begin, range.end), which may lie outside the grid. `terms` is overwritten.
  void rows(int level, PostRange range, std::vector<RowTerms>& terms) const;
  void columns(int level, PostRange range, ColumnTerms& terms) const;

 private:
  static constexpr std::int64_t kBlock = 64;
  using RowBlock = std::array<RowTerms, kBlock>;
  struct ColumnBlock {
    std::array<ColumnConstants, kBlock> at;
    std::array<ColumnStep, kBlock> step;
  };
  template <typename Block>
  struct Blocks {
    mutable std::shared_mutex mutex;
    mutable std::unordered_map<std::uint64_t, std::unique_ptr<const Block>> made;
    // The block `number` of a level; `make` fills one that was not asked for before.
    template <typename Make>
    const Block& at(int level, std::int64_t number, const Make& make) const;
  };

  EllipsoidShape ellipsoid_;
  GridAxis x_axis_, y_axis_;
  Blocks<RowBlock> rows_;
  Blocks<ColumnBlock> columns_;
};

}  // namespace deltaz
