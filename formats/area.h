// The gaming-area header, area.json: the only mutable file of a database and the one that names all others.
// Specified in area.md. Reading verifies the hash in the last member before anything else is believed.
//
// Errors: kInvalid with a MAN_ code; kNewerFormat. Thread-safety: plain values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/error.h"
#include "formats/hash.h"

namespace deltaz {

inline constexpr std::string_view kAreaFileName = "area.json";
inline constexpr std::string_view kLockFileName = "lock";
inline constexpr int kAreaVersion = 1;
inline constexpr std::uint64_t kMaximumAreaBytes = 64u << 20;
// Posts stand no closer than this, 0.1 mm on the ground; heights and their range stay within this, metres.
inline constexpr double kLeastSpacingDegrees = 1e-9;
inline constexpr double kLeastSpacingProjected = 1e-4;  // units of the projection
inline constexpr double kMaximumHeightMetres = 1e10;
// Centroids and radii are stored in units of 1/64 m, so that sums of offsets are exact.
inline constexpr double kCentroidUnit = 1.0 / 64.0;
// Geometric and coverage errors are stored in units of 1/1024 m.
inline constexpr double kErrorUnit = 1.0 / 1024.0;

// An exact fraction numerator/denominator, denominator > 0.
struct Rational {
  std::int64_t numerator = 1;
  std::int64_t denominator = 1;
  double value() const { return static_cast<double>(numerator) / static_cast<double>(denominator); }
  bool operator==(const Rational&) const = default;
};

struct EllipsoidShape {
  double semi_major_axis = 6378137.0;         // metres
  double inverse_flattening = 298.257223563;  // 0 means a sphere
  bool operator==(const EllipsoidShape&) const = default;
};

// Where an axis counts its posts from, and what its exact spacings are fractions of.
struct AxisOrigin {
  double coordinate = 0;      // of global index 0, degrees or units of the projection
  double exact_per_unit = 1;  // units of exact_spacing in a unit of the coordinate
};
inline constexpr AxisOrigin kLongitudeOrigin{-180, 3600};  // degrees, arc-seconds
inline constexpr AxisOrigin kLatitudeOrigin{-90, 3600};
inline constexpr AxisOrigin kProjectedOrigin{0, 1};  // units of the projection

// One axis of a grid. Post g (any integer) lies at  origin + (g + phase) * spacing,  in degrees on a geodetic
// grid, in units of the reference system on a projected one. Where `exact_spacing` is given the sum is
// evaluated exactly.
struct GridAxis {
  double spacing = 0;                     // > 0
  std::optional<Rational> exact_spacing;  // arc-seconds; on a projected grid units of the projection
  double phase = 0;                       // posts, 0 <= phase < 1
  std::int64_t first = 0;                 // global index of the area's first post (west or south)
  std::int64_t count = 0;                 // posts, >= 2
  bool operator==(const GridAxis&) const = default;
};

// What the source said, kept so that export gives it back unchanged.
struct SourceDescription {
  std::string name;                      // base name of the file
  Hash128 content;                       // of the file's bytes
  std::string driver;                    // GDAL's short name, e.g. "GTiff"
  std::array<double, 6> geotransform{};  // GDAL convention: corner of the corner pixel, row 0 first
  bool point_registered = false;         // AREA_OR_POINT=Point
  std::string data_type;                 // "Int16", ...
  std::optional<double> nodata;          // declared sentinel; NaN is one
  std::string unit;                      // unit of the elevations as the source spells it; may be empty
  std::int64_t columns = 0, rows = 0;
  int band = 1;                  // the one the elevations were read from
  double scale = 1, offset = 0;  // elevation in `unit` = stored value * scale + offset
  bool operator==(const SourceDescription&) const = default;
};

inline constexpr int kPatchDegree = 4;
inline constexpr std::int64_t kMaximumPatches = 1 << 20;

// Where the lattice of control points of a projected grid lies: patches of cells x cells level-0 cells at
// global multiples, each with degree + 1 control points a side, those on its border shared with its
// neighbours.
struct PatchPlacement {
  int degree = kPatchDegree;              // of the polynomial along each axis
  std::int64_t cells = 0;                 // a power of two, a multiple of `degree`
  std::int64_t first_x = 0, first_y = 0;  // patch that covers cells [first_x, first_x + 1] * cells
  std::int64_t columns = 1, rows = 1;     // patches
  double error = 0;                       // metres: largest measured distance from the exact transformation
  bool operator==(const PatchPlacement&) const = default;
};

// How a grid that does not stand on its source's own posts came about.
struct Resampling {
  std::string method;        // "bilinear"
  double largest_error = 0;  // metres: largest measured height difference from the source's own surface
  double rms_error = 0;      // metres
  bool operator==(const Resampling&) const = default;
};

struct GridHeader {
  // "geodetic": axes are longitude and latitude, positions follow from the ellipsoid. "projected": axes are
  // those of the projected reference system, positions follow from the control points of `patches`.
  std::string kind = "geodetic";
  std::string crs_wkt;                     // horizontal CRS as WKT2
  std::string horizontal_datum;            // "WGS 84"; name only, the ellipsoid below is what counts
  std::string vertical_datum;              // name, or "unknown"
  std::optional<double> coordinate_epoch;  // decimal year, of coordinates in a dynamic datum
  EllipsoidShape ellipsoid;
  std::string unit;                       // of the quantum: "metre"
  Rational quantum;                       // metres per height step
  GridAxis x_axis, y_axis;                // eastwards and northwards
  std::optional<PatchPlacement> patches;  // projected grids only
  // What the source's void posts held, in its own units; a void post's kind is an index into it. NaN is a
  // value like others. Empty if there are no voids.
  std::vector<double> sentinels;
  double height_error = 0;  // metres: largest rounding of a source height to whole quanta; 0 if exact
  std::optional<Resampling> resampling;  // none: the posts are the source's own
  int leaf_cells = 64;                   // cells along a leaf's side, a power of two
  int level_count = 1;                   // levels with terrain: 0 (finest) .. level_count - 1
  int normal_exponent = 2;               // p of Table 11
  std::string diagonal = "SW-NE";
  std::vector<SourceDescription> sources;
  bool operator==(const GridHeader&) const = default;
};

// What a colour map or a model was made from.
struct SourceFile {
  std::string name;  // base name
  Hash128 content;   // of the file's bytes
  bool operator==(const SourceFile&) const = default;
};

// A colour map (color_file.h) or a model (model_file.h) of the area, and how it came about.
struct AssetHeader {
  std::string name;    // isAssetName
  std::string origin;  // colour maps: image, ramp, classes or synthetic; models: mesh
  std::vector<SourceFile> sources;
  std::vector<std::pair<std::string, std::string>> options;  // semantic ones, in the order of their names
  bool operator==(const AssetHeader&) const = default;
};

// Names people give colour maps and models: 1 to 64 of A-Z a-z 0-9 _ - and inner dots; not "none", which
// stands for no colour map at all.
bool isAssetName(std::string_view name);
// 1 or more bytes of valid UTF-8 without control characters.
bool isPrintableName(std::string_view name);

enum class FileRole : std::uint8_t { kNodes, kTerrain, kPatches, kSeams, kColors, kModel, kPlacements };

// "nodes", "terrain", "patches", "seams", "colors", "model", "placements".
std::string_view fileRoleName(FileRole role);

struct FileReference {
  FileRole role = FileRole::kNodes;
  // terrain: the number node records use; patches: the grid; colors and model: index into color_maps and
  // models
  std::uint32_t segment = 0;
  std::string name;          // in the database folder; no slash
  std::uint64_t length = 0;  // bytes
  Hash128 id;
  bool operator==(const FileReference&) const = default;
};

struct AreaHeader {
  std::uint64_t generation = 1;  // grows by one with every published edit
  double west = 0, south = 0, east = 0,
         north = 0;                        // of the outermost posts, degrees; east > west, may exceed 180
  std::array<std::int64_t, 3> centroid{};  // Earth-centred, units of kCentroidUnit; the area node's centroid
  double lowest_height = 0, highest_height = 0;  // metres
  double sea_drop = 0;  // chord sag of the coarsest cell, metres: the sea lies at lowest - drop
  std::uint32_t node_count = 0;
  std::uint32_t nodes_per_page = 0;
  std::vector<GridHeader> grids;
  std::vector<AssetHeader> color_maps;  // names are unique among the maps, and among the models
  std::vector<AssetHeader> models;
  std::vector<FileReference> files;
  std::string tool_version;  // provenance
  std::vector<std::pair<std::string, std::string>>
      options;  // provenance: semantic options in the order of their names
  bool operator==(const AreaHeader&) const = default;
};

// The canonical text, hash included. Equal headers give equal bytes.
std::string serializeArea(const AreaHeader& area);

// `where` is used in messages. Checks hash, canonical form, version, features and every value's range.
Result<AreaHeader> parseArea(std::string_view text, const std::string& where);

}  // namespace deltaz
