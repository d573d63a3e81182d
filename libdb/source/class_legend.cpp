#include "libdb/source/class_legend.h"

#include <charconv>
#include <fmt/format.h>

namespace deltaz {

Result<ClassLegend> ClassLegend::read(const std::string& path) {
  DELTAZ_TRY_ASSIGN(const std::vector<ColorLine> lines, readColorLines(path));
  ClassLegend legend;
  for (const ColorLine& line : lines) {
    std::int64_t value = 0;
    const char* const text_end = line.value.data() + line.value.size();
    const auto [end, failed] = std::from_chars(line.value.data(), text_end, value);
    if (failed != std::errc{} || end != text_end)
      return badColorLine(path, line, fmt::format("'{}' is no class: those are whole numbers", line.value));
    if (!legend.colors.emplace(value, line.color).second)
      return badColorLine(path, line, fmt::format("class {} stands here a second time", value));
  }
  return legend;
}

}  // namespace deltaz
