#include "libdb/source/color_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "formats/file_system.h"
#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

constexpr std::uint64_t kMostBytes = 16u << 20;
constexpr std::string_view kSeparators = " \t,:;\r";

struct NamedColor {
  std::string_view name;
  ColorCode color;
};
// The names gdaldem knows.
constexpr std::array<NamedColor, 15> kNames = {{{"white", {255, 255, 255, 255}},
                                                {"black", {0, 0, 0, 255}},
                                                {"red", {255, 0, 0, 255}},
                                                {"green", {0, 255, 0, 255}},
                                                {"blue", {0, 0, 255, 255}},
                                                {"yellow", {255, 255, 0, 255}},
                                                {"magenta", {255, 0, 255, 255}},
                                                {"cyan", {0, 255, 255, 255}},
                                                {"aqua", {0, 191, 191, 255}},
                                                {"grey", {191, 191, 191, 255}},
                                                {"gray", {191, 191, 191, 255}},
                                                {"orange", {255, 127, 0, 255}},
                                                {"brown", {127, 63, 25, 255}},
                                                {"purple", {127, 0, 255, 255}},
                                                {"violet", {127, 0, 255, 255}}}};

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

// A token and where it begins.
struct Token {
  std::string_view text;
  std::size_t begin = 0;
};

std::vector<Token> tokensOf(std::string_view line) {
  std::vector<Token> tokens;
  for (std::size_t at = line.find_first_not_of(kSeparators); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, at), line.size());
    tokens.push_back({line.substr(at, end - at), at});
    at = line.find_first_not_of(kSeparators, end);
  }
  return tokens;
}

bool isWhole(std::string_view text, int& value) {
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  return failed == std::errc{} && end == text.data() + text.size();
}

std::optional<std::uint8_t> codeOf(std::string_view text) {
  int value = 0;
  if (!isWhole(text, value) || value < 0 || value > 255) return std::nullopt;
  return static_cast<std::uint8_t>(value);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSeparators);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSeparators) - first + 1);
}

// Reads what stands after the value. Empty: done; else what is wrong.
std::string readColor(std::string_view line, const std::vector<Token>& tokens, ColorLine& entry) {
  if (tokens.size() < 2) return "no colour follows the value";
  const std::string name = lowerCase(tokens[1].text);
  const auto known =
      std::find_if(kNames.begin(), kNames.end(), [&](const NamedColor& c) { return c.name == name; });
  if (known != kNames.end()) {
    entry.color = known->color;
    if (tokens.size() > 2) entry.label = trimmed(line.substr(tokens[2].begin));
    return {};
  }
  int number = 0;
  if (!isWhole(tokens[1].text, number)) return fmt::format("'{}' is no colour that is known", tokens[1].text);
  if (tokens.size() < 4) return "a colour is red, green and blue";
  entry.color[3] = 255;
  for (std::size_t band = 0; band < 3; ++band) {
    const auto code = codeOf(tokens[band + 1].text);
    if (!code) return fmt::format("'{}' is no whole number from 0 to 255", tokens[band + 1].text);
    entry.color[band] = *code;
  }
  std::size_t rest = 4;
  // A number that ends the line, or a comma, is the opacity; others begin the label ("30 m trees").
  if (tokens.size() > 4 && isWhole(tokens[4].text, number)) {
    const std::size_t after = tokens[4].begin + tokens[4].text.size();
    if (tokens.size() == 5 || line[after] == ',') {
      const auto code = codeOf(tokens[4].text);
      if (!code) return fmt::format("'{}' is no opacity from 0 to 255", tokens[4].text);
      entry.color[3] = *code;
      rest = 5;
    }
  }
  if (tokens.size() > rest) entry.label = trimmed(line.substr(tokens[rest].begin));
  return {};
}

}  // namespace

CoveredColor coveredColor(const ColorCode& code) {
  const double cover = code[3] / 255.0;
  return {cover * linearOfSrgb(code[0]), cover * linearOfSrgb(code[1]), cover * linearOfSrgb(code[2]), cover};
}

Error badColorLine(const std::string& path, const ColorLine& line, const std::string& what) {
  return refusedSource(fmt::format("{}, line {}", path, line.line), what, {},
                       "Write a value and red, green, blue from 0 to 255 on each line");
}

Result<std::vector<ColorLine>> readColorLines(const std::string& path) {
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes, readWholeFile(localFileSystem(), path, kMostBytes));
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
  if (text.find('\0') != std::string::npos) return refusedSource(path, "this is not a text of colours");
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::vector<ColorLine> lines;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::vector<Token> tokens = tokensOf(line.substr(0, line.find('#')));
    if (tokens.empty() || lowerCase(tokens[0].text) == "interpolation") continue;
    ColorLine entry;
    entry.line = number;
    entry.value = tokens[0].text;
    if (const std::string wrong = readColor(line.substr(0, line.find('#')), tokens, entry); !wrong.empty())
      return badColorLine(path, entry, wrong);
    lines.push_back(std::move(entry));
  }
  if (lines.empty()) return refusedSource(path, "there is no colour in the file");
  return lines;
}

}  // namespace deltaz
