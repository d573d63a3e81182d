#include "libdb/access/referenced_file.h"

#include <fmt/format.h>

namespace deltaz {

ContentKind contentKindOf(FileRole role) {
  switch (role) {
    case FileRole::kNodes:
      return ContentKind::kNodes;
    case FileRole::kTerrain:
      return ContentKind::kTerrain;
    case FileRole::kPatches:
      return ContentKind::kPatches;
    case FileRole::kSeams:
      return ContentKind::kSeams;
    case FileRole::kColors:
      return ContentKind::kColors;
    case FileRole::kModel:
      return ContentKind::kModel;
    case FileRole::kPlacements:
      return ContentKind::kPlacements;
  }
  return ContentKind::kTerrain;
}

Result<std::shared_ptr<const PatchLattice>> readPatchLattice(const ContainerReader& reader,
                                                             const PatchPlacement& placement) {
  PatchLattice lattice;
  lattice.placement = placement;
  if (reader.blockCount() != lattice.pointRows()) {
    return invalidError(IssueCode::kHgtPatches, reader.path(),
                        fmt::format("{} rows of control points were announced, the file has {}",
                                    lattice.pointRows(), reader.blockCount()));
  }
  for (std::uint32_t block = 0; block < reader.blockCount(); ++block) {
    DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, reader.read(block, BlockType::kPatchRow));
    DELTAZ_TRY_ASSIGN(
        const std::vector<double> row,
        decodePatchRow(bytes, lattice.pointColumns(), fmt::format("{}, block {}", reader.path(), block)));
    lattice.controls.insert(lattice.controls.end(), row.begin(), row.end());
  }
  return std::shared_ptr<const PatchLattice>(std::make_shared<PatchLattice>(std::move(lattice)));
}

}  // namespace deltaz
