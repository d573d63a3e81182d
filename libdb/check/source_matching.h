// Which grid of a database holds which of the sources it is compared with. area.json says where each grid's
// heights came from, so that two grids of like posts are told apart; a source it does not name (converted, or
// written anew) goes to the grid that has its posts. Internal to libdb/check.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libdb/check/check_context.h"

namespace deltaz {

// A range of a grid's posts, global indices.
struct PostRectangle {
  PostRange columns, rows;
  bool holds(std::int64_t column, std::int64_t row) const {
    return column >= columns.begin && column < columns.end && row >= rows.begin && row < rows.end;
  }
};
PostRectangle intersection(const PostRectangle& a, const PostRectangle& b);
PostRectangle hull(const PostRectangle& a, const PostRectangle& b);
std::int64_t postsOf(const PostRectangle& rectangle);
PostRectangle rectangleOf(const GridHeader& grid);

// What the coordinates of a grid's posts count from.
struct AxisOrigins {
  AxisOrigin x, y;
};
AxisOrigins originsOf(const GridHeader& grid);

// Where the posts of sources stand among those of a grid.
class SourcePlaces {
 public:
  explicit SourcePlaces(const GridHeader& grid);
  // Nothing if they are no posts of the grid's lattice, as closely as a builder asks.
  std::optional<std::int64_t> columnOf(const GridAxis& source) const;
  std::optional<std::int64_t> rowOf(const GridAxis& source) const;
  std::optional<PostRectangle> of(const GridHeader& source) const;
  // Where the posts of a source stand that area.json describes.
  PostRectangle of(const SourceDescription& source) const;
  // Posts round the Earth, whole turns of which are the same meridian; 0 if columns do not go round it.
  std::int64_t turn() const { return turn_; }

 private:
  // The same meridian has many longitudes: the turn with the most posts in the grid counts.
  PostRectangle turned(PostRectangle rectangle) const;
  const GridHeader& grid_;
  AxisOrigins origins_;
  double tolerance_x_ = 0, tolerance_y_ = 0;
  std::int64_t turn_ = 0;
};

// A source that bounds cut in two is matched twice.
struct MatchedSource {
  const RawGrid* source = nullptr;
  std::uint16_t grid = 0;
  // Those of the grid's sources it is or stands for; empty if all are spoken for.
  std::vector<std::size_t> listed;
};

struct SourceMatching {
  std::vector<MatchedSource> matched;
  std::vector<std::string> outside;  // in no grid, and without heights in the bounds the area was cut to
};

SourceMatching matchSources(const CheckContext& context);

// Of the sources a resampled grid was made from, those that none of the given can be.
std::vector<std::string> sourcesNotGiven(const CheckContext& context, std::uint16_t grid);

std::string optionOf(const AreaHeader& area, std::string_view name);

}  // namespace deltaz
