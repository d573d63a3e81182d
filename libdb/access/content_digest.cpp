#include "libdb/access/content_digest.h"

#include <bit>
#include <concepts>

namespace deltaz {

namespace {

// Grows with every change of what is hashed, so that digests of different definitions never agree by chance.
constexpr std::uint32_t kDigestVersion = 3;

// Values as little-endian bytes, one after the other.
class DigestBytes {
 public:
  template <std::integral T>
  void add(T value) {
    const auto bits = static_cast<std::uint64_t>(value);
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_.push_back(static_cast<std::byte>(bits >> (8 * i)));
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  // Length first, so that neighbours cannot trade characters.
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
  }
  void add(const Hash128& hash) { bytes_.insert(bytes_.end(), hash.bytes.begin(), hash.bytes.end()); }
  void add(const Rational& fraction) {
    add(fraction.numerator);
    add(fraction.denominator);
  }
  Hash128 digest() const { return hash128(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

void addAxis(DigestBytes& bytes, const GridAxis& axis) {
  bytes.add(axis.spacing);
  bytes.add(axis.exact_spacing.has_value());
  bytes.add(axis.exact_spacing.value_or(Rational{0, 1}));
  bytes.add(axis.phase);
  bytes.add(axis.first);
  bytes.add(axis.count);
}

void addGrid(DigestBytes& bytes, const GridHeader& grid) {
  // Not the text of the reference system, which has many spellings of one meaning: datum, ellipsoid and axes
  // say where the posts are.
  for (const std::string& text :
       {grid.kind, grid.horizontal_datum, grid.vertical_datum, grid.unit, grid.diagonal}) {
    bytes.add(text);
  }
  bytes.add(grid.ellipsoid.semi_major_axis);
  bytes.add(grid.ellipsoid.inverse_flattening);
  bytes.add(grid.quantum);
  addAxis(bytes, grid.x_axis);
  addAxis(bytes, grid.y_axis);
  bytes.add(grid.leaf_cells);
  bytes.add(grid.level_count);
  bytes.add(grid.normal_exponent);
  bytes.add(static_cast<std::uint32_t>(grid.sentinels.size()));
  for (const double sentinel : grid.sentinels) bytes.add(sentinel);
}

// The positions of a projected grid's posts: where the control points stand and what they are.
void addPatches(DigestBytes& bytes, const PatchLattice& lattice) {
  const PatchPlacement& placement = lattice.placement;
  bytes.add(placement.degree);
  for (const std::int64_t value :
       {placement.cells, placement.first_x, placement.first_y, placement.columns, placement.rows}) {
    bytes.add(value);
  }
  for (const double coordinate : lattice.controls) bytes.add(coordinate);
}

void addArea(DigestBytes& bytes, const AreaHeader& area) {
  for (const double value : {area.west, area.south, area.east, area.north, area.lowest_height,
                             area.highest_height, area.sea_drop}) {
    bytes.add(value);
  }
  bytes.add(area.node_count);
  bytes.add(static_cast<std::uint32_t>(area.grids.size()));
  for (const GridHeader& grid : area.grids) addGrid(bytes, grid);
}

// Everything of the record but the numbers that say where things stand in the files.
void addRecord(DigestBytes& bytes, const Node& node) {
  const NodeRecord& record = node.record;
  bytes.add(static_cast<std::uint8_t>(record.type));
  bytes.add(record.level);
  bytes.add(record.child_number);
  bytes.add(record.flags);
  bytes.add(record.grid);
  bytes.add(record.x);
  bytes.add(record.y);
  for (const std::int64_t coordinate : node.centroid_units) bytes.add(coordinate);
  bytes.add(record.radius);
  bytes.add(record.minimum_height);
  bytes.add(record.maximum_height);
  for (const std::int16_t component : record.mean_normal) bytes.add(component);
  bytes.add(record.cone_half_angle);
  bytes.add(record.geometric_error);
  bytes.add(record.coverage_error);
  bytes.add(record.rms_error);
  bytes.add(record.lod_near);
  bytes.add(record.lod_far);
  bytes.add(record.valid_posts);
}

void addTerrain(DigestBytes& bytes, const TerrainBlock& block) {
  bytes.add(block.columns);
  bytes.add(block.rows);
  bytes.add(block.first_column);
  bytes.add(block.first_row);
  bytes.add(block.spacing_x);
  bytes.add(block.spacing_y);
  bytes.add(block.quantum);
  bytes.add(block.normal_exponent);
  // What stands at a void post means nothing.
  for (std::size_t i = 0; i < block.heights.size(); ++i)
    bytes.add(block.valid[i] != 0 ? block.heights[i] : 0);
  for (const std::uint8_t valid : block.valid) bytes.add(valid);
  // An empty list of kinds is one of zeros.
  for (std::size_t i = 0; i < block.valid.size(); ++i)
    bytes.add(block.void_kinds.empty() ? std::uint8_t{0} : block.void_kinds[i]);
  for (const AncestorError& error : block.ancestors) {
    bytes.add(error.maximum);
    bytes.add(error.sum_of_squares);
    bytes.add(error.posts);
  }
}

// Depth is bounded: Database::children lets record numbers only grow, and levels of a terrain node only fall.
Result<Hash128> digestOf(const Database& database, const Node& node) {
  DigestBytes bytes;
  addRecord(bytes, node);
  if (node.record.block != kNoBlock) {
    DELTAZ_TRY_ASSIGN(const TerrainBlock block, database.terrainBlock(node.record));
    addTerrain(bytes, block);
  }
  DELTAZ_TRY_ASSIGN(const std::vector<Node> children, database.children(node));
  bytes.add(static_cast<std::uint32_t>(children.size()));
  for (const Node& child : children) {
    if (child.record.level >= node.record.level) {
      return invalidError(IssueCode::kRefChild, database.nodeFile().path(),
                          "a child is not of a finer level than its parent");
    }
    DELTAZ_TRY_ASSIGN(const Hash128 digest, digestOf(database, child));
    bytes.add(digest);
  }
  return bytes.digest();
}

}  // namespace

Result<Hash128> contentDigest(const Database& database) {
  DigestBytes bytes;
  bytes.add(kDigestVersion);
  addArea(bytes, database.area());
  for (int grid = 0; grid < database.gridCount(); ++grid) {
    if (const auto& patches = database.grid(grid).patches()) addPatches(bytes, *patches);
  }
  bytes.add(static_cast<std::uint32_t>(database.seams().size()));
  for (const Seam& seam : database.seams()) bytes.add(hash128(encodeSeam(seam)));
  DELTAZ_TRY_ASSIGN(const Node root, database.root());
  DELTAZ_TRY_ASSIGN(const Hash128 tree, digestOf(database, root));
  bytes.add(tree);
  return bytes.digest();
}

}  // namespace deltaz
