#include "tests/support/block_changes.h"

#include <stdexcept>

#include "libdb/build/build_terrain.h"
#include "tests/support/container_surgery.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {

MemoryFileSystem areaWithInset() {
  SyntheticGridOptions inset;
  inset.south += 0.05;
  inset.west += 0.05;
  inset.spacing_latitude = inset.spacing_longitude = {15, 1};
  inset.columns = inset.rows = 25;
  SyntheticGridOptions country;
  country.columns = country.rows = 31;
  const std::vector<RawGrid> grids = {syntheticGrid(inset), syntheticGrid(country)};
  BuildOptions options;
  options.leaf_cells = 8;
  MemoryFileSystem files;
  (void)files.makeDirectory("/folder");
  const Result<BuildSummary> built = buildTerrain(files, grids, kMemoryDatabasePath, options);
  if (!built.ok()) throw std::runtime_error(built.error().message());
  return files;
}

void changeBlocks(MemoryFileSystem& files, FileRole role, ContentKind kind, BlockType type,
                  const std::function<void(std::vector<std::vector<std::byte>>&)>& change) {
  const std::string area_path = kMemoryDatabasePath + "/" + std::string(kAreaFileName);
  AreaHeader area = parseArea(files.text(area_path), area_path).value();
  for (FileReference& file : area.files) {
    if (file.role != role) continue;
    const std::string path = kMemoryDatabasePath + "/" + file.name;
    std::vector<std::vector<std::byte>> payloads;
    for (std::uint32_t block = 0; block < blockCount(files.bytes(path)); ++block)
      payloads.push_back(payloadOf(files.bytes(path), block));
    change(payloads);
    files.setBytes(path, makeContainer(kind, type, payloads));
    const FileIdentity identity = identityOf(files.bytes(path));
    file.length = identity.length;
    file.id = identity.id;
  }
  files.setText(area_path, serializeArea(area));
}

void changeSeam(MemoryFileSystem& files, const std::function<void(std::vector<std::byte>&)>& change) {
  changeBlocks(files, FileRole::kSeams, ContentKind::kSeams, BlockType::kSeam,
               [&](std::vector<std::vector<std::byte>>& seams) { change(seams.at(0)); });
}

}  // namespace deltaz
