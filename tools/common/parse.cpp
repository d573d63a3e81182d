#include "tools/common/parse.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <optional>
#include <system_error>
#include <vector>

namespace deltaz {

namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(separator); end != std::string_view::npos;
       end = text.find(separator, begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

// from_chars knows no leading plus, people do.
std::string_view withoutPlus(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

Error wrongForm(std::string_view text, const std::string& option, const char* form) {
  return usageError(option, fmt::format("'{}' is not {}", text, form));
}

}  // namespace

Result<double> parseNumber(std::string_view text, const std::string& option) {
  const std::string_view digits = withoutPlus(text);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) {
    return wrongForm(text, option, "a number");
  }
  return value;
}

Result<double> parseNumberBetween(std::string_view text, const std::string& option, double minimum,
                                  double maximum) {
  DELTAZ_TRY_ASSIGN(const double value, parseNumber(text, option));
  if (value < minimum || value > maximum) {
    return usageError(option, fmt::format("{} is outside {} .. {}", text, minimum, maximum));
  }
  return value;
}

Result<std::int64_t> parseInteger(std::string_view text, const std::string& option, std::int64_t minimum,
                                  std::int64_t maximum) {
  const std::string_view digits = withoutPlus(text);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
    return wrongForm(text, option, "a whole number");
  }
  if (error != std::errc{} || value < minimum || value > maximum) {
    return usageError(option, fmt::format("{} is outside {} .. {}", text, minimum, maximum));
  }
  return value;
}

Result<EyePosition> parseEye(std::string_view text, const std::string& option) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) return wrongForm(text, option, "LAT,LON,ALT (ALT may end in agl)");
  EyePosition eye;
  std::string_view altitude = parts[2];
  if (altitude.ends_with("agl")) {
    eye.above_ground = true;
    altitude.remove_suffix(3);
  }
  DELTAZ_TRY_ASSIGN(eye.latitude, parseNumberBetween(parts[0], option + " latitude", -90, 90));
  DELTAZ_TRY_ASSIGN(eye.longitude, parseNumberBetween(parts[1], option + " longitude", -180, 360));
  DELTAZ_TRY_ASSIGN(eye.altitude, parseNumberBetween(altitude, option + " altitude", -20000, 1e9));
  return eye;
}

Result<LookDirection> parseLook(std::string_view text, const std::string& option) {
  const auto parts = split(text, ',');
  if (parts.size() != 2 && parts.size() != 3) return wrongForm(text, option, "HEADING,PITCH[,ROLL]");
  LookDirection look;
  DELTAZ_TRY_ASSIGN(look.heading, parseNumberBetween(parts[0], option + " heading", -360, 360));
  DELTAZ_TRY_ASSIGN(look.pitch, parseNumberBetween(parts[1], option + " pitch", -90, 90));
  if (parts.size() == 3) {
    DELTAZ_TRY_ASSIGN(look.roll, parseNumberBetween(parts[2], option + " roll", -360, 360));
  }
  return look;
}

Result<SunDirection> parseSun(std::string_view text, const std::string& option) {
  const auto parts = split(text, ',');
  if (parts.size() != 2) return wrongForm(text, option, "AZIMUTH,ELEVATION");
  SunDirection sun;
  DELTAZ_TRY_ASSIGN(sun.azimuth, parseNumberBetween(parts[0], option + " azimuth", -360, 360));
  DELTAZ_TRY_ASSIGN(sun.elevation, parseNumberBetween(parts[1], option + " elevation", -90, 90));
  return sun;
}

Result<PictureSize> parseSize(std::string_view text, const std::string& option) {
  const auto parts = split(text, 'x');
  if (parts.size() != 2) return wrongForm(text, option, "WIDTHxHEIGHT");
  DELTAZ_TRY_ASSIGN(const std::int64_t width,
                    parseInteger(parts[0], option + " width", 1, kMaximumPictureSide));
  DELTAZ_TRY_ASSIGN(const std::int64_t height,
                    parseInteger(parts[1], option + " height", 1, kMaximumPictureSide));
  return PictureSize{static_cast<int>(width), static_cast<int>(height)};
}

Result<GeodeticBounds> parseBounds(std::string_view text, const std::string& option) {
  const auto parts = split(text, ',');
  if (parts.size() != 4) return wrongForm(text, option, "W,S,E,N");
  GeodeticBounds bounds;
  DELTAZ_TRY_ASSIGN(bounds.west, parseNumberBetween(parts[0], option + " west", -180, 360));
  DELTAZ_TRY_ASSIGN(bounds.south, parseNumberBetween(parts[1], option + " south", -90, 90));
  DELTAZ_TRY_ASSIGN(bounds.east, parseNumberBetween(parts[2], option + " east", -180, 360));
  DELTAZ_TRY_ASSIGN(bounds.north, parseNumberBetween(parts[3], option + " north", -90, 90));
  if (bounds.west > bounds.east) bounds.east += 360;
  if (bounds.west == bounds.east || bounds.south >= bounds.north) {
    return usageError(option, fmt::format("'{}' holds no area", text));
  }
  return bounds;
}

Result<double> parseStoredValue(std::string_view text, const std::string& option) {
  if (text == "nan" || text == "NaN" || text == "NAN") return std::numeric_limits<double>::quiet_NaN();
  return parseNumber(text, option);
}

namespace {

constexpr std::int64_t kMostParts = 1000000000000;

bool allDigits(std::string_view text) {
  return !text.empty() && text.size() <= 12 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::int64_t wholeNumber(std::string_view digits) {
  std::int64_t value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

// "12", "0.05", "381/1250" in lowest terms; nothing if it is none of them, or zero.
std::optional<Rational> exactFraction(std::string_view text) {
  Rational value;
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    if (!allDigits(text.substr(0, slash)) || !allDigits(text.substr(slash + 1))) return std::nullopt;
    value = {wholeNumber(text.substr(0, slash)), wholeNumber(text.substr(slash + 1))};
  } else {
    const std::size_t point = std::min(text.find('.'), text.size());
    const std::string_view whole = text.substr(0, point);
    const std::string_view decimals = point < text.size() ? text.substr(point + 1) : std::string_view{};
    const std::string digits = std::string(whole) + std::string(decimals);
    if (!allDigits(digits)) return std::nullopt;
    value = {wholeNumber(digits), 1};
    for (std::size_t k = 0; k < decimals.size(); ++k) value.denominator *= 10;
  }
  if (value.numerator == 0 || value.denominator == 0 || value.denominator > kMostParts) return std::nullopt;
  const std::int64_t common = std::gcd(value.numerator, value.denominator);
  return Rational{value.numerator / common, value.denominator / common};
}

}  // namespace

Result<Rational> parseQuantum(std::string_view text, const std::string& option) {
  const std::optional<Rational> value = exactFraction(text);
  if (!value) return wrongForm(text, option, "metres, as 0.01 or 381/1250, or auto");
  if (value->value() < 1e-6 || value->value() > 1000)
    return usageError(option, fmt::format("{} is not between 0.000001 and 1000", text));
  return *value;
}

Result<PostSpacing> parseSpacing(std::string_view text, const std::string& option) {
  PostSpacing spacing;
  spacing.arc_seconds = text.ends_with("as");
  if (!spacing.arc_seconds && !text.ends_with("m"))
    return wrongForm(text, option, "arc-seconds (1as) or metres (30m)");
  const std::string_view number = text.substr(0, text.size() - (spacing.arc_seconds ? 2 : 1));
  const std::optional<Rational> value = exactFraction(number);
  if (!value) return wrongForm(text, option, "arc-seconds (1as, 1/3as) or metres (30m, 0.5m)");
  spacing.value = value->value();
  // From the closest posts of the format to a quarter of the Earth.
  const bool possible = spacing.arc_seconds ? spacing.value >= 1e-5 && spacing.value <= 324000
                                            : spacing.value >= 1e-3 && spacing.value <= 1e7;
  if (!possible) return usageError(option, fmt::format("{} is no spacing of posts", text));
  return spacing;
}

}  // namespace deltaz
