#include "libdb/source/usgs_dem_check.h"

#include <array>
#include <cctype>
#include <cpl_vsi.h>
#include <cstdlib>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <vector>

#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

// Where the profiles (record B) may begin: the old format, an undocumented one, and the usual block of 1024.
constexpr std::array<std::size_t, 3> kProfileStarts = {864, 893, 1024};
// A profile's header: row, column, posts, 1 as whole numbers; first post, datum and extremes as five others.
constexpr int kWholeNumbers = 4, kOtherNumbers = 5;
constexpr long kMostPosts = 1 << 20;

// Numbers one after the other. Fields are of fixed width and may touch: a sign begins a number unless it
// belongs to an exponent.
class Numbers {
 public:
  Numbers(std::string_view text, std::size_t start) : text_(text), at_(start) {}

  // Nothing at the end of the text.
  std::optional<std::string_view> next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) == 0) {
      const char c = text_[at_];
      const bool sign = c == '-' || c == '+';
      if (sign && at_ > begin && std::string_view("DEde").find(text_[at_ - 1]) == std::string_view::npos)
        break;
      ++at_;
    }
    if (at_ == begin) return std::nullopt;
    return text_.substr(begin, at_ - begin);
  }
  std::optional<long> nextWhole() {
    const auto word = next();
    return word ? std::optional<long>(std::strtol(std::string(*word).c_str(), nullptr, 10)) : std::nullopt;
  }

 private:
  std::string_view text_;
  std::size_t at_;
};

Result<std::string> wholeText(const std::string& path) {
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (file == nullptr) return accessError(path, "cannot read the source");
  std::string text;
  std::vector<char> buffer(1 << 20);
  for (;;) {
    const std::size_t count = VSIFReadL(buffer.data(), 1, buffer.size(), file);
    text.append(buffer.data(), count);
    if (count < buffer.size()) break;
  }
  VSIFCloseL(file);
  return text;
}

}  // namespace

Status checkUsgsDemComplete(const std::string& path, int profiles) {
  DELTAZ_TRY_ASSIGN(const std::string text, wholeText(path));
  std::optional<std::size_t> start;
  for (const std::size_t candidate : kProfileStarts) {
    Numbers numbers(text, candidate);
    const auto row = numbers.nextWhole(), column = numbers.nextWhole();
    if (!start && row == 1 && (column == 1 || column == 0)) start = candidate;
  }
  if (!start) return Success{};  // a layout only GDAL knows
  Numbers numbers(text, *start);
  for (int profile = 0; profile < profiles; ++profile) {
    long posts = 0;
    bool complete = true;
    for (int k = 0; k < kWholeNumbers && complete; ++k) {
      const auto value = numbers.nextWhole();
      complete = value.has_value();
      if (k == 2) posts = value.value_or(0);
    }
    for (long k = 0; k < kOtherNumbers + posts && complete && posts <= kMostPosts; ++k)
      complete = numbers.next().has_value();
    if (complete && posts <= kMostPosts) continue;
    return refusedSource(path, "the source is cut short",
                         fmt::format("it ends within profile {} of {}", profile + 1, profiles),
                         "Get the whole file");
  }
  return Success{};
}

}  // namespace deltaz
