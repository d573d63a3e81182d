#include "tools/dbbuild/build_plan.h"

#include <algorithm>
#include <fmt/format.h>
#include <toml++/toml.h>

#include "formats/file_system.h"
#include "formats/near_names.h"

namespace deltaz {

namespace {

constexpr std::string_view kAreaKey = "area";

// What to do about an unknown name.
std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  const std::vector<std::string> near = nearNames(name, known);
  if (!near.empty()) return fmt::format("Did you mean '{}'?", near.front());
  return fmt::format("There are: {}", fmt::join(known, ", "));
}

std::vector<std::string> namesOf(const PlanSection& section) {
  std::vector<std::string> names;
  for (const PlanKey& key : section.keys) names.push_back(key.name);
  return names;
}

class PlanReader {
 public:
  PlanReader(const std::string& where, const std::string& folder, const std::vector<PlanSection>& schema)
      : where_(where), folder_(folder), schema_(schema) {}

  Result<BuildPlan> read(const toml::table& file) {
    DELTAZ_TRY(checkNames(file));
    BuildPlan plan;
    const toml::node* area = file.get(kAreaKey);
    if (area == nullptr)
      return usageError(where_, "the key 'area' is missing", "it names the database to make",
                        "Write area = \"NAME.dz\" at the top");
    DELTAZ_TRY_ASSIGN(plan.area, textOf(*area, {std::string(kAreaKey), KeyKind::kValue, true}));
    if (plan.area.empty()) return errorAt(area->source(), "the key 'area' is empty");
    for (const PlanSection& section : schema_) {
      const toml::node* node = file.get(section.name);
      if (node == nullptr) {
        if (section.required)
          return usageError(where_, fmt::format("the section [{}] is missing", section.name));
        continue;
      }
      DELTAZ_TRY(readSection(*node, section, plan));
    }
    return plan;
  }

 private:
  Error errorAt(const toml::source_region& place, std::string what, std::string why = {},
                std::string remedy = {}) const {
    return usageError(fmt::format("{}, line {}, column {}", where_, place.begin.line, place.begin.column),
                      std::move(what), std::move(why), std::move(remedy));
  }

  Status checkNames(const toml::table& file) const {
    std::vector<std::string> known = {std::string(kAreaKey)};
    for (const PlanSection& section : schema_) known.push_back(section.name);
    for (const auto& [key, node] : file) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      return errorAt(key.source(), fmt::format("there is no '{}' in a build file", key.str()), {},
                     suggestion(key.str(), known));
    }
    return Success{};
  }

  Status readSection(const toml::node& node, const PlanSection& section, BuildPlan& plan) const {
    if (!section.repeated) {
      const toml::table* table = node.as_table();
      if (table == nullptr)
        return errorAt(node.source(), fmt::format("'{}' is no section", section.name), {},
                       fmt::format("Write [{}] and its keys below", section.name));
      return readStep(*table, section, plan);
    }
    const toml::array* list = node.as_array();
    if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
      return errorAt(node.source(),
                     fmt::format("'{}' may stand several times, so it is a list", section.name), {},
                     fmt::format("Write [[{}]] with two brackets", section.name));
    }
    for (const toml::node& element : *list) DELTAZ_TRY(readStep(*element.as_table(), section, plan));
    return Success{};
  }

  Status readStep(const toml::table& table, const PlanSection& section, BuildPlan& plan) const {
    const std::vector<std::string> known = namesOf(section);
    for (const auto& [key, node] : table) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      return errorAt(key.source(), fmt::format("there is no '{}' in [{}]", key.str(), section.name), {},
                     suggestion(key.str(), known));
    }
    PlanStep step;
    step.section = section.name;
    step.line = table.source().begin.line;
    for (const PlanKey& key : section.keys) {
      const toml::node* node = table.get(key.name);
      if (node == nullptr) {
        if (key.required)
          return errorAt(table.source(),
                         fmt::format("the key '{}' is missing in [{}]", key.name, section.name));
        continue;
      }
      DELTAZ_TRY_ASSIGN(const std::vector<std::string> texts, textsOf(*node, key));
      if (key.kind == KeyKind::kFlag) {
        if (*node->value<bool>()) step.options.push_back("--" + key.name);
        continue;
      }
      for (const std::string& text : texts) {
        const toml::source_position place = node->source().begin;
        step.values.push_back({key.name, text, key.is_path, place.line, place.column});
        if (key.positional) {
          step.positionals.push_back(text);
        } else {
          step.options.push_back(fmt::format("--{}={}", key.name, text));
        }
      }
    }
    plan.steps.push_back(std::move(step));
    return Success{};
  }

  Result<std::vector<std::string>> textsOf(const toml::node& node, const PlanKey& key) const {
    if (key.kind == KeyKind::kFlag) {
      if (!node.is_boolean()) return errorAt(node.source(), fmt::format("'{}' is true or false", key.name));
      return std::vector<std::string>{};
    }
    const toml::array* array = node.as_array();
    if (array == nullptr) {
      DELTAZ_TRY_ASSIGN(std::string text, textOf(node, key));
      return std::vector<std::string>{std::move(text)};
    }
    if (array->empty()) return errorAt(node.source(), fmt::format("'{}' is an empty list", key.name));
    // Several numbers are one value: west, south, east, north; several texts, or lists of numbers, are
    // several.
    if (key.kind == KeyKind::kValue || isNumbers(*array)) {
      DELTAZ_TRY_ASSIGN(std::string text, joined(*array, key));
      return std::vector<std::string>{std::move(text)};
    }
    std::vector<std::string> texts;
    for (const toml::node& element : *array) {
      const toml::array* numbers = element.as_array();
      DELTAZ_TRY_ASSIGN(std::string text, numbers != nullptr ? joined(*numbers, key) : textOf(element, key));
      texts.push_back(std::move(text));
    }
    return texts;
  }

  static bool isNumbers(const toml::array& array) {
    return std::all_of(array.begin(), array.end(),
                       [](const toml::node& element) { return element.is_number(); });
  }

  Result<std::string> joined(const toml::array& array, const PlanKey& key) const {
    std::string all;
    for (const toml::node& element : array) {
      DELTAZ_TRY_ASSIGN(const std::string text, textOf(element, key));
      all += (all.empty() ? "" : ",") + text;
    }
    return all;
  }

  Result<std::string> textOf(const toml::node& node, const PlanKey& key) const {
    if (const auto* text = node.as_string()) {
      const bool relative =
          key.is_path && folder_ != "." && !text->get().empty() && text->get().front() != '/';
      return relative ? joinPath(folder_, text->get()) : text->get();
    }
    if (!key.is_path) {
      if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
      if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
    }
    return errorAt(node.source(), fmt::format("the value of '{}' is of the wrong kind", key.name),
                   key.is_path ? "it is text: a file's name" : "it is text or a number");
  }

  const std::string& where_;
  const std::string& folder_;
  const std::vector<PlanSection>& schema_;
};

}  // namespace

Result<BuildPlan> parseBuildPlan(std::string_view text, const std::string& where, const std::string& folder,
                                 const std::vector<PlanSection>& schema) {
  try {
    const toml::table file = toml::parse(text);
    return PlanReader(where, folder, schema).read(file);
  } catch (const toml::parse_error& error) {
    const toml::source_position place = error.source().begin;
    return usageError(fmt::format("{}, line {}, column {}", where, place.line, place.column),
                      "this is not TOML", std::string(error.description()));
  }
}

Status checkPlan(const BuildPlan& plan, const std::string& where, const std::vector<PlanNames>& names,
                 const FileSystem& files) {
  const auto error_at = [&](const PlanValue& value, std::string what, std::string remedy) {
    return usageError(fmt::format("{}, line {}, column {}", where, value.line, value.column), std::move(what),
                      {}, std::move(remedy));
  };
  const auto values_of = [&](const std::string& section, const std::string& key) {
    std::vector<PlanValue> values;
    for (const PlanStep& step : plan.steps) {
      for (const PlanValue& value : step.values) {
        if (step.section == section && value.key == key) values.push_back(value);
      }
    }
    return values;
  };
  for (const PlanNames& kind : names) {
    std::vector<std::string> known;
    for (const PlanValue& value : values_of(kind.section, kind.name_key)) {
      if (std::find(known.begin(), known.end(), value.text) != known.end())
        return error_at(value, fmt::format("the name '{}' is given twice", value.text), "Give each its own");
      known.push_back(value.text);
    }
    if (kind.used_by_section.empty()) continue;
    for (const PlanValue& value : values_of(kind.used_by_section, kind.used_key)) {
      if (std::find(known.begin(), known.end(), value.text) != known.end()) continue;
      return error_at(value, fmt::format("there is no [[{}]] called '{}'", kind.section, value.text),
                      known.empty() ? fmt::format("Write a [[{}]] of this name", kind.section)
                                    : suggestion(value.text, known));
    }
  }
  for (const PlanStep& step : plan.steps) {
    for (const PlanValue& value : step.values) {
      if (!value.is_path || value.text.find(':') != std::string::npos || value.text.starts_with("/vsi"))
        continue;
      const Result<PathType> type = files.typeOf(value.text);
      if (type.ok() && type.value() == PathType::kAbsent)
        return error_at(value, fmt::format("there is no file {}", value.text),
                        "Names are relative to the build file");
    }
  }
  return Success{};
}

}  // namespace deltaz
