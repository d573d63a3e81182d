#include "libdb/source/color_ramp.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

std::optional<double> numberOf(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

Result<ColorRamp> ColorRamp::read(const std::string& path, double lowest, double highest) {
  DELTAZ_TRY_ASSIGN(const std::vector<ColorLine> lines, readColorLines(path));
  ColorRamp ramp;
  for (const ColorLine& line : lines) {
    if (line.value == "nv" || line.value == "NV") {
      ramp.of_void_ = line.color;
      continue;
    }
    const bool share = line.value.ends_with('%');
    const std::string number = line.value.substr(0, line.value.size() - (share ? 1 : 0));
    const std::optional<double> value = numberOf(number);
    if (!value) {
      return badColorLine(path, line,
                          fmt::format("'{}' is neither a height, nor a percentage, nor nv", line.value));
    }
    ramp.entries_.push_back({share ? lowest + (highest - lowest) * *value / 100 : *value, line.color});
  }
  if (ramp.entries_.empty()) return refusedSource(path, "the ramp has no height");
  std::stable_sort(ramp.entries_.begin(), ramp.entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.height < b.height; });
  return ramp;
}

ColorCode ColorRamp::colorAt(double height) const {
  const auto above = std::lower_bound(entries_.begin(), entries_.end(), height,
                                      [](const Entry& entry, double value) { return entry.height < value; });
  if (above == entries_.end()) return entries_.back().color;
  if (above == entries_.begin() || above->height == height) return above->color;
  const Entry& below = *(above - 1);
  const double share = (height - below.height) / (above->height - below.height);
  ColorCode color;
  for (std::size_t band = 0; band < color.size(); ++band) {
    const double value =
        below.color[band] + share * (static_cast<double>(above->color[band]) - below.color[band]);
    color[band] = static_cast<std::uint8_t>(std::floor(value + 0.5));
  }
  return color;
}

}  // namespace deltaz
