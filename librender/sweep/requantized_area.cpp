#include "librender/sweep/requantized_area.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <vector>

#include "libdb/build/build_terrain.h"
#include "libdb/build/publication.h"
#include "libdb/export/export_terrain.h"

namespace deltaz {
namespace {

Status requantize(const Rational& quantum, RawGrid& grid) {
  const double ratio = grid.header.quantum.value() / quantum.value();
  for (std::int32_t& height : grid.heights) {
    const double rounded = std::round(height * ratio);
    if (std::abs(rounded) >= std::numeric_limits<std::int32_t>::max()) {
      return usageError(fmt::format("quantum {} m", quantum.value()), "the heights do not fit 32 bits", {},
                        "Take a coarser one");
    }
    height = static_cast<std::int32_t>(rounded);
  }
  grid.header.quantum = quantum;
  grid.header.height_error += quantum.value() / 2;
  return Success{};
}

constexpr std::size_t kCopiedBytes = std::size_t{1} << 20;

Status copyFile(const FileSystem& files, const std::string& from, const std::string& to) {
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<ReadableFile> source, files.open(from));
  DELTAZ_TRY_ASSIGN(const std::unique_ptr<WritableFile> target, files.create(to));
  std::vector<std::byte> bytes;
  for (std::uint64_t at = 0; at < source->size(); at += bytes.size()) {
    bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kCopiedBytes, source->size() - at)));
    DELTAZ_TRY(source->readAt(at, bytes));
    DELTAZ_TRY(target->append(bytes));
  }
  return target->close();
}

// The files that depend on no height, under the names and identities they have.
Status copyAssets(const FileSystem& files, const Database& database, const std::string& target) {
  const AreaHeader& from = database.area();
  if (from.color_maps.empty() && from.models.empty()) return Success{};
  DELTAZ_TRY_ASSIGN(Publication publication, Publication::beginEdit(files, target));
  AreaHeader area = publication.area();
  area.color_maps = from.color_maps;
  area.models = from.models;
  for (const FileReference& file : from.files) {
    if (file.role != FileRole::kColors && file.role != FileRole::kModel && file.role != FileRole::kPlacements)
      continue;
    DELTAZ_TRY(copyFile(files, joinPath(database.path(), file.name), publication.newFilePath(file.name)));
    area.files.push_back(file);
  }
  return publication.publish(area);
}

}  // namespace

Status buildRequantized(const FileSystem& files, const Database& database, const Rational& quantum,
                        const std::string& target, int threads) {
  std::vector<RawGrid> grids;
  for (int grid = 0; grid < database.gridCount(); ++grid) {
    DELTAZ_TRY_ASSIGN(RawGrid raw, readGrid(database, grid, 0));
    DELTAZ_TRY(requantize(quantum, raw));
    grids.push_back(std::move(raw));
  }
  BuildOptions options;
  options.leaf_cells = database.area().grids.front().leaf_cells;
  options.threads = threads;
  DELTAZ_TRY(buildTerrain(files, grids, target, options));
  return copyAssets(files, database, target);
}

}  // namespace deltaz
