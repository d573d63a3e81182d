// Writes a colour file (formats/color_file.h): tiles as they come, then the pages of records breadth first,
// then the directory. The bytes depend on the tiles and the order in which they came, on nothing else.
//
// Cost: 40 bytes a node in memory; tiles are not kept. Errors: whatever writing reports; kInternal where the
// nodes make no trees. Thread-safety: one thread.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/color_file.h"
#include "formats/container.h"

namespace deltaz {

// Where a node stands: node (x, y) of a level of the pyramid over a grid.
struct ColorPlace {
  std::uint16_t grid = 0;
  std::int8_t level = 0;
  std::int32_t x = 0, y = 0;
  auto operator<=>(const ColorPlace&) const = default;
};

// The place of child `child_number` (1 to 4). Pre: the place is not of the lowest level.
ColorPlace childPlace(const ColorPlace& place, int child_number);

class ColorMapWriter {
 public:
  static Result<ColorMapWriter> create(const FileSystem& files, const std::string& path);

  // Appends a node with its tile, as encodeColorTile gives it. In any order, each node once, and every node
  // but those of its grid's coarsest level with its parent.
  Status add(const ColorPlace& place, std::span<const std::byte> tile);
  std::size_t count() const { return places_.size(); }
  // The lowest and the highest level so far. Pre: a node was added.
  std::pair<int, int> levels() const;
  // Bytes written so far.
  std::uint64_t size() const { return file_.size(); }
  // Links the nodes and closes the file. Nothing may follow.
  Result<FileIdentity> finish();

 private:
  explicit ColorMapWriter(ContainerWriter file, std::string path)
      : file_(std::move(file)), path_(std::move(path)) {}

  ContainerWriter file_;
  std::string path_;
  std::vector<ColorPlace> places_;  // of block n: places_[n]
};

}  // namespace deltaz
