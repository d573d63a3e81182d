// Suggestions for a name that was not found. Thread-safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deltaz {

// The names that are spelled most like `name`, at most five, nearest first: at most a third of the longer
// one's letters (but always one) changed, left out, put in or exchanged with the next. Letters that differ in
// case alone count as equal.
std::vector<std::string> nearNames(std::string_view name, std::span<const std::string> names);

// For an error's `why`: "near it: \"a\", \"b\"", or, if none is near, the first of those there are, or that
// there are none.
std::string nearNamesText(std::string_view name, std::span<const std::string> names);

}  // namespace deltaz
