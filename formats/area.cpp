#include "formats/area.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "formats/node_file.h"
#include "formats/terrain_segment.h"

namespace deltaz {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFormatName = "deltaz area";
constexpr std::string_view kHashLead = ",\n  \"hash\": \"";
constexpr std::string_view kHashTail = "\"\n}\n";
constexpr std::size_t kHashDigits = 32;
// A global post index times the finest sensible spacing stays exactly representable in a double.
constexpr std::int64_t kMaximumPostIndex = std::int64_t{1} << 40;
constexpr std::int64_t kMaximumPostCount = std::int64_t{1} << 31;
constexpr int kMaximumLevels = 32;

constexpr std::array<std::string_view, 7> kRoleNames = {"nodes",  "terrain", "patches",   "seams",
                                                        "colors", "model",   "placements"};
// What a reader must know to read more than terrain.
constexpr std::string_view kPackedFeature = "packed_nodes", kColorFeature = "colors",
                           kModelFeature = "models";
constexpr std::size_t kMostAssets = 1 << 16;
constexpr std::size_t kMaximumSentinels = 64;

std::span<const std::byte> asBytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// ---- values to JSON

Json toJson(const Rational& value) {
  return Json::array({value.numerator, value.denominator});
}

Json toJson(const GridAxis& axis) {
  Json json;
  json["spacing"] = axis.spacing;
  json["exact_spacing"] = axis.exact_spacing ? toJson(*axis.exact_spacing) : Json(nullptr);
  json["phase"] = axis.phase;
  json["first"] = axis.first;
  json["count"] = axis.count;
  return json;
}

// A value that may be NaN, which JSON has no number for.
Json sentinelToJson(double value) {
  return std::isnan(value) ? Json("nan") : Json(value);
}

Json toJson(const PatchPlacement& patches) {
  return {{"degree", patches.degree},   {"cells", patches.cells},     {"first_x", patches.first_x},
          {"first_y", patches.first_y}, {"columns", patches.columns}, {"rows", patches.rows},
          {"error", patches.error}};
}

Json toJson(const Resampling& resampling) {
  return {{"method", resampling.method},
          {"largest_error", resampling.largest_error},
          {"rms_error", resampling.rms_error}};
}

Json toJson(const SourceDescription& source) {
  Json json;
  json["name"] = source.name;
  json["content"] = toHex(source.content);
  json["driver"] = source.driver;
  json["geotransform"] = source.geotransform;
  json["registration"] = source.point_registered ? "point" : "area";
  json["data_type"] = source.data_type;
  json["nodata"] = source.nodata ? sentinelToJson(*source.nodata) : Json(nullptr);
  json["unit"] = source.unit;
  json["band"] = source.band;
  json["scale"] = source.scale;
  json["offset"] = source.offset;
  json["columns"] = source.columns;
  json["rows"] = source.rows;
  return json;
}

Json toJson(const GridHeader& grid) {
  Json json;
  json["kind"] = grid.kind;
  json["crs"] = grid.crs_wkt;
  json["horizontal_datum"] = grid.horizontal_datum;
  json["vertical_datum"] = grid.vertical_datum;
  json["coordinate_epoch"] = grid.coordinate_epoch ? Json(*grid.coordinate_epoch) : Json(nullptr);
  json["ellipsoid"] = {{"semi_major_axis", grid.ellipsoid.semi_major_axis},
                       {"inverse_flattening", grid.ellipsoid.inverse_flattening}};
  json["unit"] = grid.unit;
  json["quantum"] = toJson(grid.quantum);
  json["x_axis"] = toJson(grid.x_axis);
  json["y_axis"] = toJson(grid.y_axis);
  json["patches"] = grid.patches ? toJson(*grid.patches) : Json(nullptr);
  json["sentinels"] = Json::array();
  for (const double sentinel : grid.sentinels) json["sentinels"].push_back(sentinelToJson(sentinel));
  json["height_error"] = grid.height_error;
  json["resampling"] = grid.resampling ? toJson(*grid.resampling) : Json(nullptr);
  json["leaf_cells"] = grid.leaf_cells;
  json["levels"] = grid.level_count;
  json["normal_exponent"] = grid.normal_exponent;
  json["diagonal"] = grid.diagonal;
  json["sources"] = Json::array();
  for (const SourceDescription& source : grid.sources) json["sources"].push_back(toJson(source));
  return json;
}

// Provenance: names to text.
Json optionsToJson(const std::vector<std::pair<std::string, std::string>>& options) {
  Json json = Json::object();
  for (const auto& [name, value] : options) json[name] = value;
  return json;
}

Json toJson(const AssetHeader& asset) {
  Json json;
  json["name"] = asset.name;
  json["origin"] = asset.origin;
  json["sources"] = Json::array();
  for (const SourceFile& source : asset.sources)
    json["sources"].push_back({{"name", source.name}, {"content", toHex(source.content)}});
  json["options"] = optionsToJson(asset.options);
  return json;
}

Json toJson(const FileReference& file) {
  Json json;
  json["role"] = fileRoleName(file.role);
  json["segment"] = file.segment;
  json["name"] = file.name;
  json["length"] = file.length;
  json["id"] = toHex(file.id);
  return json;
}

// ---- JSON to values

// Reads the members of one object and remembers the first thing wrong.
class Members {
 public:
  Members(const Json& json, std::string path, std::string& fault)
      : json_(json), path_(std::move(path)), fault_(fault) {
    if (!json_.is_object()) fail("", "is not an object");
  }

  const Json* find(const char* name) {
    if (!json_.is_object()) return nullptr;
    const auto it = json_.find(name);
    if (it == json_.end()) {
      fail(name, "is missing");
      return nullptr;
    }
    return &*it;
  }
  std::string text(const char* name) {
    const Json* value = find(name);
    if (value == nullptr) return {};
    if (!value->is_string()) return fail(name, "is not text"), std::string();
    return value->get<std::string>();
  }
  double number(const char* name, double low, double high) {
    const Json* value = find(name);
    if (value == nullptr) return low;
    return numberOf(*value, name, low, high);
  }
  double numberOf(const Json& value, const char* name, double low, double high) {
    if (!value.is_number()) return fail(name, "is not a number"), low;
    const auto result = value.get<double>();
    if (!(result >= low && result <= high)) return fail(name, "is out of range"), low;
    return result;
  }
  std::int64_t integer(const char* name, std::int64_t low, std::int64_t high) {
    const Json* value = find(name);
    if (value == nullptr) return low;
    return integerOf(*value, name, low, high);
  }
  std::int64_t integerOf(const Json& value, const char* name, std::int64_t low, std::int64_t high) {
    if (!value.is_number_integer()) return fail(name, "is not an integer"), low;
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX)) {
      return fail(name, "is out of range"), low;
    }
    const auto result = value.get<std::int64_t>();
    if (result < low || result > high) return fail(name, "is out of range"), low;
    return result;
  }
  const Json& array(const char* name, std::size_t least, std::size_t most) {
    static const Json kEmpty = Json::array();
    const Json* value = find(name);
    if (value == nullptr) return kEmpty;
    if (!value->is_array() || value->size() < least || value->size() > most)
      return fail(name, "is not an array of the right size"), kEmpty;
    return *value;
  }
  Hash128 hash(const char* name) {
    const std::optional<Hash128> value = hashFromHex(text(name));
    if (!value) return fail(name, "is not 32 hexadecimal digits"), Hash128{};
    return *value;
  }
  Rational rationalOf(const Json& value, const char* name) {
    if (!value.is_array() || value.size() != 2) return fail(name, "is not a fraction"), Rational{};
    const std::int64_t most = std::int64_t{1} << 53;
    return {integerOf(value[0], name, 1, most), integerOf(value[1], name, 1, most)};
  }
  // NaN is spelled as text.
  double sentinelOf(const Json& value, const char* name) {
    if (value.is_string() && value.get<std::string>() == "nan") return std::nan("");
    return numberOf(value, name, -std::numeric_limits<double>::max(), std::numeric_limits<double>::max());
  }
  Members object(const char* name) {
    static const Json kNothing;
    const Json* value = find(name);
    return {value == nullptr ? kNothing : *value, path_ + name + ".", fault_};
  }
  void fail(const std::string& name, const char* what) {
    if (fault_.empty()) fault_ = fmt::format("member {}{} {}", path_, name, what);
  }

 private:
  const Json& json_;
  std::string path_;
  std::string& fault_;
};

GridAxis readAxis(Members members, double least_spacing, double largest_spacing, const AxisOrigin& origin) {
  GridAxis axis;
  axis.spacing = members.number("spacing", least_spacing, largest_spacing);
  if (const Json* exact = members.find("exact_spacing"); exact != nullptr && !exact->is_null()) {
    axis.exact_spacing = members.rationalOf(*exact, "exact_spacing");
    const double spacing = axis.exact_spacing->value() / origin.exact_per_unit;
    if (!(std::abs(spacing - axis.spacing) <= 1e-9 * spacing)) {
      members.fail("exact_spacing", "does not agree with spacing");
    }
  }
  axis.phase = members.number("phase", 0, std::nextafter(1.0, 0.0));
  axis.first = members.integer("first", -kMaximumPostIndex, kMaximumPostIndex);
  axis.count = members.integer("count", 2, kMaximumPostCount);
  return axis;
}

SourceDescription readSource(const Json& json, const std::string& path, std::string& fault) {
  Members members(json, path, fault);
  SourceDescription source;
  source.name = members.text("name");
  source.content = members.hash("content");
  source.driver = members.text("driver");
  const Json& geotransform = members.array("geotransform", 6, 6);
  for (std::size_t i = 0; i < geotransform.size(); ++i) {
    source.geotransform[i] = members.numberOf(geotransform[i], "geotransform", -1e12, 1e12);
  }
  const std::string registration = members.text("registration");
  if (registration != "area" && registration != "point")
    members.fail("registration", "is neither area nor point");
  source.point_registered = registration == "point";
  source.data_type = members.text("data_type");
  if (const Json* nodata = members.find("nodata"); nodata != nullptr && !nodata->is_null()) {
    source.nodata = members.sentinelOf(*nodata, "nodata");
  }
  source.unit = members.text("unit");
  source.columns = members.integer("columns", 1, kMaximumPostCount);
  source.rows = members.integer("rows", 1, kMaximumPostCount);
  source.band = static_cast<int>(members.integer("band", 1, 1 << 16));
  source.scale = members.number("scale", -1e12, 1e12);
  if (source.scale == 0) members.fail("scale", "is zero");
  source.offset = members.number("offset", -1e12, 1e12);
  return source;
}

PatchPlacement readPatches(Members members, const GridHeader& grid) {
  PatchPlacement patches;
  patches.degree = static_cast<int>(members.integer("degree", kPatchDegree, kPatchDegree));
  patches.cells = members.integer("cells", kPatchDegree, std::int64_t{1} << 40);
  if (!std::has_single_bit(static_cast<std::uint64_t>(patches.cells)))
    members.fail("cells", "is not a power of two");
  patches.first_x = members.integer("first_x", -kMaximumPostIndex, kMaximumPostIndex);
  patches.first_y = members.integer("first_y", -kMaximumPostIndex, kMaximumPostIndex);
  patches.columns = members.integer("columns", 1, kMaximumPatches);
  patches.rows = members.integer("rows", 1, kMaximumPatches / patches.columns);
  patches.error = members.number("error", 0, 1e6);
  // Every cell of the grid lies in a patch.
  const auto covers = [&](const GridAxis& axis, std::int64_t first, std::int64_t count) {
    const double begin = static_cast<double>(first) * static_cast<double>(patches.cells);
    const double end = static_cast<double>(first + count) * static_cast<double>(patches.cells);
    return begin <= static_cast<double>(axis.first) &&
           end >= static_cast<double>(axis.first + axis.count - 1);
  };
  if (!covers(grid.x_axis, patches.first_x, patches.columns) ||
      !covers(grid.y_axis, patches.first_y, patches.rows))
    members.fail("", "do not cover the grid");
  return patches;
}

GridHeader readGrid(const Json& json, const std::string& path, std::string& fault) {
  Members members(json, path, fault);
  GridHeader grid;
  grid.kind = members.text("kind");
  if (grid.kind != "geodetic" && grid.kind != "projected")
    members.fail("kind", "is neither geodetic nor projected");
  const bool geodetic = grid.kind == "geodetic";
  grid.crs_wkt = members.text("crs");
  grid.horizontal_datum = members.text("horizontal_datum");
  grid.vertical_datum = members.text("vertical_datum");
  if (const Json* epoch = members.find("coordinate_epoch"); epoch != nullptr && !epoch->is_null()) {
    grid.coordinate_epoch = members.numberOf(*epoch, "coordinate_epoch", 1, 1e5);
  }
  Members ellipsoid = members.object("ellipsoid");
  grid.ellipsoid.semi_major_axis = ellipsoid.number("semi_major_axis", 1, 1e8);
  grid.ellipsoid.inverse_flattening = ellipsoid.number("inverse_flattening", 0, 1e12);
  if (grid.ellipsoid.inverse_flattening != 0 && grid.ellipsoid.inverse_flattening <= 1) {
    ellipsoid.fail("inverse_flattening", "is out of range");
  }
  grid.unit = members.text("unit");
  if (grid.unit != "metre") members.fail("unit", "is not metre");
  if (const Json* quantum = members.find("quantum"); quantum != nullptr)
    grid.quantum = members.rationalOf(*quantum, "quantum");
  if (geodetic) {
    grid.x_axis = readAxis(members.object("x_axis"), kLeastSpacingDegrees, 360, kLongitudeOrigin);
    grid.y_axis = readAxis(members.object("y_axis"), kLeastSpacingDegrees, 180, kLatitudeOrigin);
  } else {
    grid.x_axis = readAxis(members.object("x_axis"), kLeastSpacingProjected, 1e9, kProjectedOrigin);
    grid.y_axis = readAxis(members.object("y_axis"), kLeastSpacingProjected, 1e9, kProjectedOrigin);
  }
  if (const Json* patches = members.find("patches"); patches != nullptr && patches->is_null() != geodetic) {
    members.fail("patches", geodetic ? "are not of a geodetic grid" : "are missing");
  } else if (!geodetic) {
    grid.patches = readPatches(members.object("patches"), grid);
  }
  const Json& sentinels = members.array("sentinels", 0, kMaximumSentinels);
  for (const Json& sentinel : sentinels) grid.sentinels.push_back(members.sentinelOf(sentinel, "sentinels"));
  grid.height_error = members.number("height_error", 0, kMaximumHeightMetres);
  if (const Json* resampling = members.find("resampling"); resampling != nullptr && !resampling->is_null()) {
    Members of_resampling = members.object("resampling");
    grid.resampling = {of_resampling.text("method"),
                       of_resampling.number("largest_error", 0, kMaximumHeightMetres),
                       of_resampling.number("rms_error", 0, kMaximumHeightMetres)};
  }
  grid.leaf_cells = static_cast<int>(members.integer("leaf_cells", 8, kMaximumLeafCells));
  if (!std::has_single_bit(static_cast<unsigned>(grid.leaf_cells)))
    members.fail("leaf_cells", "is not a power of two");
  grid.level_count = static_cast<int>(members.integer("levels", 1, kMaximumLevels));
  grid.normal_exponent = static_cast<int>(members.integer("normal_exponent", 2, 2));
  grid.diagonal = members.text("diagonal");
  if (grid.diagonal != "SW-NE") members.fail("diagonal", "is not SW-NE");
  const Json& sources = members.array("sources", 0, 1 << 20);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    grid.sources.push_back(readSource(sources[i], fmt::format("{}sources[{}].", path, i), fault));
  }
  return grid;
}

FileReference readFile(const Json& json, const std::string& path, std::string& fault) {
  Members members(json, path, fault);
  FileReference file;
  const std::string role = members.text("role");
  const auto known = std::find(kRoleNames.begin(), kRoleNames.end(), role);
  if (known == kRoleNames.end()) {
    members.fail("role", "is none of nodes, terrain, patches, seams, colors, model, placements");
  } else {
    file.role = static_cast<FileRole>(known - kRoleNames.begin());
  }
  file.segment = static_cast<std::uint32_t>(members.integer("segment", 0, 1 << 20));
  file.name = members.text("name");
  // A name leads nowhere but into the database's own folder.
  if (file.name.empty() || file.name[0] == '.' || file.name.find('/') != std::string::npos ||
      file.name.find('\0') != std::string::npos || file.name == kAreaFileName || file.name == kLockFileName) {
    members.fail("name", "is not a plain file name");
  }
  file.length = static_cast<std::uint64_t>(members.integer("length", 0, INT64_MAX));
  file.id = members.hash("id");
  return file;
}

std::vector<std::pair<std::string, std::string>> readOptions(Members& members) {
  std::vector<std::pair<std::string, std::string>> result;
  const Json* options = members.find("options");
  if (options == nullptr) return result;
  if (!options->is_object()) return members.fail("options", "is not an object"), result;
  for (const auto& [name, value] : options->items()) {
    if (!value.is_string()) members.fail("options." + name, "is not text");
    result.emplace_back(name, value.is_string() ? value.get<std::string>() : std::string());
  }
  return result;
}

AssetHeader readAsset(const Json& json, const std::string& path, std::string& fault) {
  Members members(json, path, fault);
  AssetHeader asset;
  asset.name = members.text("name");
  if (!isAssetName(asset.name)) members.fail("name", "is not a name");
  asset.origin = members.text("origin");
  for (const Json& source : members.array("sources", 0, 1 << 20)) {
    Members of_source(source, path + "sources.", fault);
    const std::string name = of_source.text("name");
    asset.sources.push_back({name, of_source.hash("content")});
  }
  asset.options = readOptions(members);
  return asset;
}

// The colour maps or the models. A database that has none does not mention them, as those of the first
// program did not.
std::vector<AssetHeader> readAssets(const Json& json, Members& members, const char* member,
                                    std::string& fault) {
  std::vector<AssetHeader> assets;
  if (!json.is_object() || !json.contains(member)) return assets;
  const Json& list = members.array(member, 1, kMostAssets);
  for (std::size_t i = 0; i < list.size(); ++i) {
    assets.push_back(readAsset(list[i], fmt::format("{}[{}].", member, i), fault));
    for (std::size_t k = 0; k < i; ++k) {
      if (assets[k].name == assets[i].name) members.fail(member, "has one name twice");
    }
  }
  return assets;
}

AreaHeader readArea(const Json& json, std::string& fault) {
  Members members(json, "", fault);
  AreaHeader area;
  area.generation = static_cast<std::uint64_t>(members.integer("generation", 1, INT64_MAX));
  Members bounds = members.object("bounds");
  area.west = bounds.number("west", -180, 180);
  area.south = bounds.number("south", -90.5, 90.5);
  area.east = bounds.number("east", -180, 541);
  area.north = bounds.number("north", -90.5, 90.5);
  if (!(area.east > area.west) || !(area.north > area.south)) bounds.fail("", "are empty");
  const Json& centroid = members.array("centroid", 3, 3);
  for (std::size_t i = 0; i < centroid.size(); ++i) {
    area.centroid[i] =
        members.integerOf(centroid[i], "centroid", -(std::int64_t{1} << 40), std::int64_t{1} << 40);
  }
  Members heights = members.object("heights");
  area.lowest_height = heights.number("lowest", -kMaximumHeightMetres, kMaximumHeightMetres);
  area.highest_height = heights.number("highest", -kMaximumHeightMetres, kMaximumHeightMetres);
  if (area.highest_height < area.lowest_height) heights.fail("", "are not in order");
  area.sea_drop = members.number("sea_drop", 0, 1e8);
  Members nodes = members.object("nodes");
  area.node_count = static_cast<std::uint32_t>(nodes.integer("count", 1, UINT32_MAX));
  area.nodes_per_page = static_cast<std::uint32_t>(nodes.integer("per_page", 1, UINT32_MAX));
  if (area.nodes_per_page > kNodesPerPage && area.nodes_per_page != kNodesPerPlainPage)
    nodes.fail("per_page", "is not a size that pages have");
  const Json& grids = members.array("grids", 1, 1 << 16);
  for (std::size_t i = 0; i < grids.size(); ++i)
    area.grids.push_back(readGrid(grids[i], fmt::format("grids[{}].", i), fault));
  area.color_maps = readAssets(json, members, "color_maps", fault);
  area.models = readAssets(json, members, "models", fault);
  const Json& files = members.array("files", 1, 1 << 20);
  for (std::size_t i = 0; i < files.size(); ++i)
    area.files.push_back(readFile(files[i], fmt::format("files[{}].", i), fault));
  Members provenance = members.object("provenance");
  area.tool_version = provenance.text("tool");
  area.options = readOptions(provenance);
  return area;
}

}  // namespace

bool isAssetName(std::string_view name) {
  constexpr std::size_t kLongest = 64;
  const auto plain = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= kLongest && name.front() != '.' && name.back() != '.' &&
         name.front() != '-' && name != "none" && std::all_of(name.begin(), name.end(), plain);
}

bool isPrintableName(std::string_view name) {
  const bool control = std::any_of(name.begin(), name.end(),
                                   [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (name.empty() || control) return false;
  // The JSON library refuses what is not UTF-8.
  const std::string text = Json(std::string(name)).dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.find("\xEF\xBF\xBD") == std::string::npos;
}

std::string_view fileRoleName(FileRole role) {
  return kRoleNames[static_cast<std::size_t>(role)];
}

std::string serializeArea(const AreaHeader& area) {
  Json json;
  json["format"] = kFormatName;
  json["version"] = kAreaVersion;
  json["required_features"] = Json::array();
  if (area.nodes_per_page != kNodesPerPlainPage) json["required_features"].push_back(kPackedFeature);
  if (!area.color_maps.empty()) json["required_features"].push_back(kColorFeature);
  // The list of placements outlives the last model, since it knows which numbers were given.
  const bool placed = std::any_of(area.files.begin(), area.files.end(), [](const FileReference& file) {
    return file.role == FileRole::kPlacements;
  });
  if (!area.models.empty() || placed) json["required_features"].push_back(kModelFeature);
  json["optional_features"] = Json::array();
  json["generation"] = area.generation;
  json["bounds"] = {{"west", area.west}, {"south", area.south}, {"east", area.east}, {"north", area.north}};
  json["centroid"] = area.centroid;
  json["heights"] = {{"lowest", area.lowest_height}, {"highest", area.highest_height}};
  json["sea_drop"] = area.sea_drop;
  json["nodes"] = {{"count", area.node_count}, {"per_page", area.nodes_per_page}};
  json["grids"] = Json::array();
  for (const GridHeader& grid : area.grids) json["grids"].push_back(toJson(grid));
  for (const auto& [member, assets] :
       {std::pair("color_maps", &area.color_maps), std::pair("models", &area.models)}) {
    if (assets->empty()) continue;
    json[member] = Json::array();
    for (const AssetHeader& asset : *assets) json[member].push_back(toJson(asset));
  }
  json["files"] = Json::array();
  for (const FileReference& file : area.files) json["files"].push_back(toJson(file));
  json["provenance"] = {{"tool", area.tool_version}, {"options", optionsToJson(area.options)}};
  // A file name that is not UTF-8 must not make a database unreadable: its odd bytes become replacement
  // characters.
  std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace);
  text.resize(text.size() - 2);  // without the closing "\n}"
  const std::string hash = toHex(hash128(asBytes(text)));
  return text.append(kHashLead).append(hash).append(kHashTail);
}

Result<AreaHeader> parseArea(std::string_view text, const std::string& where) {
  const std::size_t tail = kHashLead.size() + kHashDigits + kHashTail.size();
  const bool shaped = text.size() > tail && text.ends_with(kHashTail) &&
                      text.substr(text.size() - tail, kHashLead.size()) == kHashLead;
  if (!shaped) {
    if (text.find(kFormatName) == std::string_view::npos) {
      return invalidError(IssueCode::kManSyntax, where, "this is not the header of a deltaz database");
    }
    return invalidError(IssueCode::kManHash, where, "the file does not end in its hash",
                        "it was cut short or edited by hand", "Restore it, or rebuild the database");
  }
  const std::string_view body = text.substr(0, text.size() - tail);
  if (toHex(hash128(asBytes(body))) != text.substr(body.size() + kHashLead.size(), kHashDigits)) {
    return invalidError(IssueCode::kManHash, where, "the contents do not match the hash at their end",
                        "the file was damaged or edited by hand", "Restore it, or rebuild the database");
  }
  const Json json = Json::parse(std::string(body) + "\n}", nullptr, false);
  if (json.is_discarded() || !json.is_object())
    return invalidError(IssueCode::kManSyntax, where, "this is not JSON");

  std::string fault;
  Members members(json, "", fault);
  if (members.text("format") != kFormatName)
    return invalidError(IssueCode::kManSyntax, where, "this is not the header of a deltaz database");
  const std::int64_t version = members.integer("version", 1, INT64_MAX);
  if (version > kAreaVersion) {
    return newerFormatError(
        IssueCode::kHdrVersionNewer, where,
        fmt::format("the database has version {}, newer than this program knows ({})", version, kAreaVersion),
        "Use a newer deltaz");
  }
  for (const Json& feature : members.array("required_features", 0, 1000)) {
    if (feature == kPackedFeature || feature == kColorFeature || feature == kModelFeature) continue;
    return newerFormatError(IssueCode::kHdrFeatureUnknown, where,
                            fmt::format("the database needs a feature this program does not have: {}",
                                        feature.dump(-1, ' ', true, Json::error_handler_t::replace)),
                            "Use a newer deltaz");
  }
  const bool may_hold_more = !members.array("optional_features", 0, 1000).empty();
  AreaHeader area = readArea(json, fault);
  if (!fault.empty()) return invalidError(IssueCode::kManField, where, fault);
  if (!may_hold_more && serializeArea(area) != text) {
    return invalidError(IssueCode::kManField, where, "the file is not in canonical form",
                        "it has members this version does not know, or in another order");
  }
  return area;
}

}  // namespace deltaz
