#include "formats/near_names.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace deltaz {
namespace {

constexpr std::size_t kMostNames = 5;

char lowered(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Levenshtein distance, two neighbouring letters exchanged counting as one change; a row at a time.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  const auto same = [&](std::size_t i, std::size_t j) { return lowered(a[i - 1]) == lowered(b[j - 1]); };
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j - 1] + (same(i, j) ? 0 : 1), row[j] + 1, next[j - 1] + 1});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j)) next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before.swap(row);
    row.swap(next);
  }
  return row[b.size()];
}

std::string listed(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

}  // namespace

std::vector<std::string> nearNames(std::string_view name, std::span<const std::string> names) {
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& other : names) {
    const std::size_t limit = std::max<std::size_t>(1, std::max(name.size(), other.size()) / 3);
    const std::size_t distance = editDistance(name, other);
    if (distance <= limit) near.emplace_back(distance, other);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::string> nearest;
  for (std::size_t k = 0; k < std::min(near.size(), kMostNames); ++k) nearest.push_back(near[k].second);
  return nearest;
}

std::string nearNamesText(std::string_view name, std::span<const std::string> names) {
  if (names.empty()) return "there are none";
  const std::vector<std::string> near = nearNames(name, names);
  if (!near.empty()) return "near it: " + listed(near);
  const bool all = names.size() <= kMostNames;
  return "there are " + listed(names.first(std::min(names.size(), kMostNames))) + (all ? "" : " and others");
}

}  // namespace deltaz
