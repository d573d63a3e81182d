// Opens a database and reads what is asked for: node records by page, terrain node by node. Everything read
// is verified; what fails is an error, never a wrong height.
//
// Cost of open: area.json and the header and footer of each file. Thread-safety: const members from any
// thread.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/area.h"
#include "formats/container.h"
#include "formats/file_system.h"
#include "formats/node_file.h"
#include "formats/seam.h"
#include "formats/terrain_segment.h"
#include "libdb/access/color_map.h"
#include "libdb/access/grid_geometry.h"
#include "libdb/access/model.h"
#include "libdb/access/terrain_tile.h"

namespace deltaz {

inline constexpr std::uint32_t kRootRecord = 1;

// A node record and where it stands.
struct Node {
  std::uint32_t number = 0;  // record number
  NodeRecord record;
  Vector3 centroid;                              // Earth-centred, metres, exact
  std::array<std::int64_t, 3> centroid_units{};  // the same in kCentroidUnit
  double radius() const { return static_cast<double>(record.radius) * kCentroidUnit; }
  // Metres; infinity when unknown.
  double geometricError() const;
  double coverageError() const;
};

class Database {
 public:
  // kInvalid if `path` is not a database, kCannotAccess if it cannot be read, kNewerFormat.
  static Result<Database> open(const FileSystem& files, const std::string& path);

  const std::string& path() const { return path_; }
  const AreaHeader& area() const { return area_; }
  const GridGeometry& grid(int index) const { return grids_[static_cast<std::size_t>(index)]; }
  int gridCount() const { return static_cast<int>(grids_.size()); }

  // The area's cluster node: its children are the grids' cluster nodes, theirs the coarsest terrain nodes.
  Result<Node> root() const;
  // The children of `parent`, in child order; at most four.
  Result<std::vector<Node>> children(const Node& parent) const;
  // The decoded terrain of a node of type kTerrain.
  Result<TerrainTile> terrain(const Node& node) const;

  // One record by number, 1 <= number <= area().node_count.
  Result<NodeRecord> record(std::uint32_t number) const;
  // A node's block as stored, decoded but not yet checked against its record.
  Result<TerrainBlock> terrainBlock(const NodeRecord& record) const;

  // Bytes read from all files since open.
  std::uint64_t bytesRead() const;

  // How grids that overlap or touch meet; each an upper and a lower grid.
  const std::vector<Seam>& seams() const { return seams_; }

  // Colour maps and models in area.json's order; placements, none if the database has none.
  const std::vector<ColorMap>& colorMaps() const { return color_maps_; }
  // Index of the colour map of this name.
  std::optional<std::size_t> findColorMap(std::string_view name) const;
  const std::vector<Model>& models() const { return models_; }
  std::optional<std::uint32_t> findModel(std::string_view name) const;
  const PlacementSet* placements() const { return placements_ ? &*placements_ : nullptr; }

  // The files behind it, for dbcheck.
  const ContainerReader& nodeFile() const { return *nodes_; }
  const ContainerReader* terrainSegment(std::uint32_t segment) const;

 private:
  Database() = default;
  // One attempt; `text` becomes what stood in area.json.
  static Result<Database> openOnce(const FileSystem& files, const std::string& path,
                                   std::vector<std::byte>& text);
  Status addAsset(const FileReference& reference, std::unique_ptr<ContainerReader> reader);

  std::string path_;
  AreaHeader area_;
  std::uint64_t area_bytes_ = 0;
  std::vector<GridGeometry> grids_;
  std::unique_ptr<ContainerReader> nodes_;
  std::vector<std::unique_ptr<ContainerReader>> segments_;  // by segment number
  std::vector<std::unique_ptr<ContainerReader>> patch_files_;
  std::unique_ptr<ContainerReader> seam_file_;
  std::vector<Seam> seams_;
  std::vector<ColorMap> color_maps_;
  std::vector<Model> models_;
  std::optional<PlacementSet> placements_;
  struct PageCache {
    std::mutex mutex;
    std::vector<std::shared_ptr<const std::vector<NodeRecord>>> pages;
  };
  std::unique_ptr<PageCache> page_cache_;
};

// Visits every terrain node of level `level` of grid `grid`, in record order. Stops at the first error.
Result<std::vector<Node>> nodesOfLevel(const Database& database, int grid, int level);

}  // namespace deltaz
