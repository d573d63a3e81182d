#include "tools/dbbuild/placement_list.h"

#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "tools/common/json_output.h"
#include "tools/common/parse.h"

namespace deltaz {

namespace {

constexpr double kLowestAltitude = -20000, kHighestAltitude = 1e9;

std::string_view trimmed(std::string_view text) {
  const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> fieldsOf(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::size_t comma = text.find(','); comma != std::string_view::npos; comma = text.find(',')) {
    fields.push_back(trimmed(text.substr(0, comma)));
    text.remove_prefix(comma + 1);
  }
  fields.push_back(trimmed(text));
  return fields;
}

Status parseAltitude(std::string_view text, const std::string& option, PlacementRequest& request) {
  if (text.ends_with("agl")) {
    request.above_ground = true;
    text.remove_suffix(3);
  }
  DELTAZ_TRY_ASSIGN(request.altitude,
                    parseNumberBetween(text, option + " altitude", kLowestAltitude, kHighestAltitude));
  return Success{};
}

Result<PlacementRequest> parseFields(const std::vector<std::string_view>& fields, const std::string& where) {
  PlacementRequest request;
  request.where = where;
  DELTAZ_TRY_ASSIGN(request.latitude, parseNumberBetween(fields[0], where + " latitude", -90, 90));
  DELTAZ_TRY_ASSIGN(request.longitude, parseNumberBetween(fields[1], where + " longitude", -180, 360));
  if (fields.size() > 2 && !fields[2].empty()) DELTAZ_TRY(parseAltitude(fields[2], where, request));
  return request;
}

// What a file says is content, not usage.
Error ofContent(Error error) {
  error.kind = ErrorKind::kInvalid;
  return error;
}

Result<std::vector<PlacementRequest>> parseCsv(std::string_view text, const std::string& name,
                                               double heading) {
  std::vector<PlacementRequest> requests;
  bool may_be_titles = true;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view content = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (content.empty() || content.front() == '#') continue;
    const bool titles = may_be_titles && std::isalpha(static_cast<unsigned char>(content.front())) != 0;
    may_be_titles = false;
    if (titles) continue;
    const std::string where = fmt::format("{}, line {}", name, line);
    const std::vector<std::string_view> fields = fieldsOf(content);
    if (fields.size() < 2 || fields.size() > 4) {
      return invalidError(IssueCode::kNone, where, "this is no place",
                          fmt::format("it has {} fields", fields.size()), "Write LAT,LON[,ALT[,HEADING]]");
    }
    Result<PlacementRequest> request = parseFields(fields, where);
    if (!request.ok()) return ofContent(request.error());
    request.value().heading = heading;
    if (fields.size() == 4 && !fields[3].empty()) {
      const Result<double> own = parseNumberBetween(fields[3], where + " heading", -360, 360);
      if (!own.ok()) return ofContent(own.error());
      request.value().heading = own.value();
    }
    requests.push_back(std::move(request).value());
  }
  return requests;
}

class GeoJsonReader {
 public:
  GeoJsonReader(const std::string& name, double heading) : name_(name), heading_(heading) {}

  Status read(const Json& json) {
    const std::string type = typeOf(json);
    if (type == "FeatureCollection") {
      if (!json.contains("features") || !json["features"].is_array())
        return fault("it has no list of features");
      for (const Json& feature : json["features"]) DELTAZ_TRY(readFeature(feature));
      return Success{};
    }
    return type == "Feature" ? readFeature(json) : readGeometry(json, Json::object());
  }
  std::vector<PlacementRequest> take() { return std::move(requests_); }

 private:
  static std::string typeOf(const Json& json) {
    const bool has = json.is_object() && json.contains("type") && json["type"].is_string();
    return has ? json["type"].get<std::string>() : "";
  }

  std::string where() const { return number_ == 0 ? name_ : fmt::format("{}, feature {}", name_, number_); }
  Error fault(const std::string& why) const {
    return invalidError(IssueCode::kNone, where(), "this is no GeoJSON of places", why,
                        "Points with longitude and latitude are wanted");
  }

  Status readFeature(const Json& feature) {
    ++number_;
    if (typeOf(feature) != "Feature" || !feature.contains("geometry")) return fault("it is no feature");
    const bool has = feature.contains("properties") && feature["properties"].is_object();
    return readGeometry(feature["geometry"], has ? feature["properties"] : Json::object());
  }

  Status readGeometry(const Json& geometry, const Json& properties) {
    const std::string type = typeOf(geometry);
    const bool many = type == "MultiPoint";
    if (type != "Point" && !many) return fault("its geometry is not a point");
    if (!geometry.contains("coordinates")) return fault("it has no coordinates");
    const Json& coordinates = geometry["coordinates"];
    if (!many) return readPoint(coordinates, properties);
    if (!coordinates.is_array()) return fault("it has no coordinates");
    for (const Json& point : coordinates) DELTAZ_TRY(readPoint(point, properties));
    return Success{};
  }

  Status readPoint(const Json& point, const Json& properties) {
    if (!point.is_array() || point.size() < 2 || point.size() > 3)
      return fault("a point has not two or three numbers");
    for (const Json& value : point) {
      if (!value.is_number()) return fault("a coordinate is no number");
    }
    PlacementRequest request;
    request.where = where();
    request.longitude = point[0].get<double>();
    request.latitude = point[1].get<double>();
    if (!(std::abs(request.latitude) <= 90) || !(request.longitude >= -180 && request.longitude <= 360))
      return fault("a position is out of range; longitude comes first");
    if (point.size() == 3) request.altitude = point[2].get<double>();
    request.heading = heading_;
    if (properties.contains("heading") && !properties["heading"].is_null()) {
      if (!properties["heading"].is_number()) return fault("its heading is no number");
      request.heading = properties["heading"].get<double>();
    }
    if (properties.contains("altitude") && !properties["altitude"].is_null()) {
      const Json& altitude = properties["altitude"];
      if (altitude.is_number()) {
        request.altitude = altitude.get<double>();
      } else if (altitude.is_string()) {
        const Status parsed = parseAltitude(altitude.get<std::string>(), where(), request);
        if (!parsed.ok()) return ofContent(parsed.error());
      } else {
        return fault("its altitude is no number");
      }
    }
    requests_.push_back(std::move(request));
    return Success{};
  }

  const std::string& name_;
  double heading_;
  std::size_t number_ = 0;
  std::vector<PlacementRequest> requests_;
};

Result<std::vector<PlacementRequest>> parseGeoJson(std::string_view text, const std::string& name,
                                                   double heading) {
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& exception) {
    return invalidError(IssueCode::kNone, name, "this is not JSON", exception.what());
  }
  GeoJsonReader reader(name, heading);
  DELTAZ_TRY(reader.read(json));
  return reader.take();
}

}  // namespace

Result<PlacementRequest> parsePlace(std::string_view text, const std::string& option) {
  const std::vector<std::string_view> fields = fieldsOf(text);
  if (fields.size() < 2 || fields.size() > 3 || (fields.size() == 3 && fields[2].empty()))
    return usageError(option, fmt::format("'{}' is not LAT,LON[,ALT] (ALT may end in agl)", text));
  return parseFields(fields, option);
}

Result<std::vector<PlacementRequest>> parsePlacementList(std::string_view text, const std::string& name,
                                                         double heading) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string_view::npos && text[first] == '{';
  DELTAZ_TRY_ASSIGN(std::vector<PlacementRequest> requests,
                    json ? parseGeoJson(text, name, heading) : parseCsv(text, name, heading));
  if (requests.empty()) return invalidError(IssueCode::kNone, name, "there are no places in the file");
  return requests;
}

}  // namespace deltaz
