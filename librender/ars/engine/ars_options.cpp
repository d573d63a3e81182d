#include "librender/ars/engine/ars_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <functional>
#include <optional>

#include "formats/near_names.h"
#include "librender/ars/antialiaser/shift_add_filter.h"

namespace deltaz {

namespace {

using ars::MachineConfiguration;

Error badValue(std::string_view option, const ArsKey& key, std::string_view value) {
  return usageError(fmt::format("{} {}", option, key.name), fmt::format("'{}' is no value of it", value), {},
                    fmt::format("Give {}", key.values));
}

std::optional<int> integerOf(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// What a key does: false if the value is none of its own. And what value it has.
struct Setting {
  ArsKey key;
  std::function<bool(std::string_view, ArsOptions&)> set;
  std::function<std::string(const ArsOptions&)> get;
};

template <class Reference>
Setting integer(ArsKey key, int least, int most, Reference reference) {
  return {key,
          [=](std::string_view text, ArsOptions& options) {
            const std::optional<int> value = integerOf(text);
            if (!value || *value < least || *value > most) return false;
            reference(options) = *value;
            return true;
          },
          [=](const ArsOptions& options) {
            ArsOptions copy = options;
            return fmt::format("{}", reference(copy));
          }};
}

template <class Reference>
Setting onOff(ArsKey key, Reference reference) {
  return {key,
          [=](std::string_view text, ArsOptions& options) {
            if (text != "on" && text != "off") return false;
            reference(options) = text == "on";
            return true;
          },
          [=](const ArsOptions& options) {
            ArsOptions copy = options;
            return std::string(reference(copy) ? "on" : "off");
          }};
}

// One of several words.
template <class Value, std::size_t kCount, class Reference>
Setting oneOf(ArsKey key, std::array<std::pair<std::string_view, Value>, kCount> words, Reference reference) {
  return {key,
          [=](std::string_view text, ArsOptions& options) {
            for (const auto& [word, value] : words) {
              if (word != text) continue;
              reference(options) = value;
              return true;
            }
            return false;
          },
          [=](const ArsOptions& options) {
            ArsOptions copy = options;
            for (const auto& [word, value] : words) {
              if (value == reference(copy)) return std::string(word);
            }
            return std::string();
          }};
}

// Widths that pull others along with them (number_profile.h).
Setting width(ArsKey key, int least, int most, ars::NumberProfile (*with)(ars::NumberProfile, int),
              int (*get)(const ars::NumberProfile&)) {
  return {key,
          [=](std::string_view text, ArsOptions& options) {
            const std::optional<int> bits = integerOf(text);
            if (!bits || *bits < least || *bits > most) return false;
            options.tiler.numbers = with(options.tiler.numbers, *bits);
            return true;
          },
          [=](const ArsOptions& options) { return fmt::format("{}", get(options.tiler.numbers)); }};
}

Setting unavailableTilers() {
  return {{"unavailable", "tilers' numbers from 0 with + between, or none", "tilers out of service"},
          [](std::string_view text, ArsOptions& options) {
            std::vector<int> tilers;
            while (text != "none") {
              const std::size_t plus = std::min(text.find('+'), text.size());
              const std::optional<int> tiler = integerOf(text.substr(0, plus));
              if (!tiler) return false;
              tilers.push_back(*tiler);
              if (plus == text.size()) break;
              text.remove_prefix(plus + 1);
            }
            options.machine.unavailable = std::move(tilers);
            return true;
          },
          [](const ArsOptions& options) {
            std::string text;
            for (const int tiler : options.machine.unavailable)
              text += fmt::format("{}{}", text.empty() ? "" : "+", tiler);
            return text.empty() ? std::string("none") : text;
          }};
}

// The keys' texts refer to these names as long as the program runs.
const std::string& kernelNames() {
  static const std::string names = [] {
    std::string text = "off";
    for (const ars::ShiftAddKernel& kernel : ars::shiftAddKernels()) text += fmt::format(", {}", kernel.name);
    return text;
  }();
  return names;
}

Setting antialiaserKernel() {
  return {{"antialiaser", kernelNames(), "filter from more samples to a pixel (off; 1983: report)"},
          [](std::string_view text, ArsOptions& options) {
            if (text != "off" && !ars::shiftAddKernelNamed(text)) return false;
            options.antialiaser = text == "off" ? std::string_view() : text;
            return true;
          },
          [](const ArsOptions& options) {
            return options.antialiaser.empty() ? std::string("off") : options.antialiaser;
          }};
}

std::vector<Setting> makeSettings() {
  using ars::HashingMode;
  using ars::MemoryDesign;
  using ars::QueueDiscipline;
  using ars::TieRule;
  const auto machine = [](auto MachineConfiguration::*member) {
    return [member](ArsOptions & options) -> auto& {
      return options.machine.*member;
    };
  };
  const auto correction = [](bool ars::TilerCorrections::*member) {
    return [member](ArsOptions& options) -> bool& { return options.tiler.corrections.*member; };
  };
  using Numbers = ars::NumberProfile;
  std::vector<Setting> all;
  all.push_back(integer({"tilers", "1, 2, 4, ... 64", "tilers (4)"}, 1, ars::kMaximumTilers,
                        machine(&MachineConfiguration::tilers)));
  all.push_back(integer({"memories", "1, 2, 4, ... 64", "depth/frame memories (8)"}, 1, ars::kMaximumMemories,
                        machine(&MachineConfiguration::memories)));
  all.push_back(unavailableTilers());
  all.push_back(oneOf<HashingMode, 3>(
      {"mode", "sequential, interleave or scramble", "which memory holds which pixel (scramble)"},
      {{{"sequential", HashingMode::kSequential},
        {"interleave", HashingMode::kInterleave},
        {"scramble", HashingMode::kScramble}}},
      machine(&MachineConfiguration::mode)));
  all.push_back(oneOf<QueueDiscipline, 2>(
      {"discipline", "strict or queue-first", "what a B-cell serves first (strict: Table 10, inputs first)"},
      {{{"strict", QueueDiscipline::kInputsFirst}, {"queue-first", QueueDiscipline::kQueueFirst}}},
      machine(&MachineConfiguration::discipline)));
  all.push_back(integer({"queue", "0 to 65536 pixels", "queue of each output of a B-cell (256)"}, 0,
                        ars::kMaximumQueueDepth, machine(&MachineConfiguration::queue_depth)));
  all.push_back(integer({"fifo", "1 to 65536 pixels", "output FIFO of a tiler (64)"}, 1,
                        ars::kMaximumFifoDepth, machine(&MachineConfiguration::output_fifo)));
  all.push_back(integer({"memory-fifo", "1 to 65536 pixels", "FIFO before a memory (64)"}, 1,
                        ars::kMaximumFifoDepth, machine(&MachineConfiguration::memory_fifo)));
  all.push_back(integer({"transfer-fifo", "1 to 65536 triangles", "FIFO before set-up (2)"}, 1,
                        ars::kMaximumFifoDepth, machine(&MachineConfiguration::transfer_fifo)));
  all.push_back(integer({"setup-fifo", "1 to 65536 triangles", "FIFO behind set-up (5)"}, 1,
                        ars::kMaximumFifoDepth, machine(&MachineConfiguration::set_up_fifo)));
  all.push_back(oneOf<MemoryDesign, 4>(
      {"alternative", "1, 2, 3 or 4", "design of the memory's control, Fig 85 (1: as built)"},
      {{{"1", MemoryDesign::kVariable},
        {"2", MemoryDesign::kNoEarlyEnd},
        {"3", MemoryDesign::kNoLookAhead},
        {"4", MemoryDesign::kFixed}}},
      machine(&MachineConfiguration::memory_design)));
  all.push_back(oneOf<TieRule, 2>({"ties", "first or brighter", "which of equally near pixels stays (first)"},
                                  {{{"first", TieRule::kFirstStays}, {"brighter", TieRule::kBrighter}}},
                                  machine(&MachineConfiguration::ties)));
  all.push_back(integer({"clock", "1 to 1000 percent", "clock of the tilers (100)"}, 1, 1000,
                        machine(&MachineConfiguration::tiler_clock_percent)));
  all.push_back(integer({"buffers", "1 to 10000, or 0 for one more than tilers", "host's buffers (0)"}, 0,
                        10'000, machine(&MachineConfiguration::buffers)));
  all.push_back(integer({"buffer-triangles", "1 to 1000000", "triangles in a buffer (32)"}, 1, 1'000'000,
                        machine(&MachineConfiguration::buffer_triangles)));
  all.push_back(integer({"word-ns", "0 to 1000000", "transfer of a word from the host (0; worst case 1200)"},
                        0, 1'000'000, machine(&MachineConfiguration::word_transfer)));
  all.push_back(integer({"host-ns", "0 to 1000000", "what the host takes to make a triangle (0)"}, 0,
                        1'000'000, machine(&MachineConfiguration::host_triangle)));
  all.push_back(onOff({"barriers", "on or off", "drain between background and foreground (on; 1983: off)"},
                      machine(&MachineConfiguration::barriers)));
  all.push_back(oneOf<bool, 2>({"sampling", "under or over", "which pixels a triangle takes (under)"},
                               {{{"under", false}, {"over", true}}},
                               [](ArsOptions& options) -> bool& { return options.oversample; }));
  all.push_back(oneOf<int, 2>({"passes", "1 or 3", "brightness, or red, green and blue in turn (3)"},
                              {{{"1", 1}, {"3", 3}}},
                              [](ArsOptions& options) -> int& { return options.passes; }));
  all.push_back(antialiaserKernel());
  all.push_back(onOff({"timing", "on or off", "in simulated time, or pixels alone (on)"},
                      [](ArsOptions& options) -> bool& { return options.timed; }));
  all.push_back(onOff({"top-left", "on or off", "edges belong to one triangle; ours (off)"},
                      correction(&ars::TilerCorrections::top_left_rule)));
  all.push_back(onOff({"clamp-depth", "on or off", "depths within the triangle's; ours (off)"},
                      correction(&ars::TilerCorrections::clamp_depth)));
  all.push_back(onOff({"true-color", "on or off", "colours linear in space; ours (off)"},
                      correction(&ars::TilerCorrections::true_color)));
  all.push_back(width({"vertex-bits", "0 to 12", "fraction bits of vertices (6)"}, 0,
                      ars::kLargestVertexFractionBits, ars::withVertexFractionBits,
                      [](const Numbers& numbers) { return numbers.vertex_fraction_bits; }));
  all.push_back(width({"color-bits", "2 to 24", "mantissa bits of colour planes (10)"}, 2, 24,
                      ars::withColorMantissaBits,
                      [](const Numbers& numbers) { return numbers.color.mantissa_bits; }));
  all.push_back(width({"plane-bits", "2 to 24", "mantissa bits of depth planes (24)"}, 2, 24,
                      ars::withPlaneMantissaBits,
                      [](const Numbers& numbers) { return numbers.depth_plane.mantissa_bits; }));
  all.push_back(width({"depth-bits", "2 to 27", "mantissa bits of depths in memory (19)"}, 2, 27,
                      ars::withDepthMantissaBits,
                      [](const Numbers& numbers) { return numbers.depth.mantissa_bits; }));
  return all;
}

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all = makeSettings();
  return all;
}

}  // namespace

std::span<const ArsKey> arsKeys() {
  static const std::vector<ArsKey> keys = [] {
    std::vector<ArsKey> names;
    for (const Setting& setting : settings()) names.push_back(setting.key);
    return names;
  }();
  return keys;
}

Status setArsOption(std::string_view key, std::string_view value, ArsOptions& options,
                    std::string_view option) {
  for (const Setting& setting : settings()) {
    if (setting.key.name != key) continue;
    if (!setting.set(value, options)) return badValue(option, setting.key, value);
    return Success{};
  }
  std::vector<std::string> names;
  for (const ArsKey& each : arsKeys()) names.emplace_back(each.name);
  return usageError(std::string(option), fmt::format("there is no key '{}'", key), nearNamesText(key, names),
                    "See dbview(1) for the keys and their values");
}

Result<ArsOptions> parseArsOptions(std::string_view text, ArsOptions options) {
  std::vector<std::string_view> seen;
  while (!text.empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    const std::string_view part = text.substr(0, comma);
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return usageError("--ars", fmt::format("'{}' is not KEY=VALUE", part), {},
                        "Give settings as KEY=VALUE with commas between, e.g. tilers=2,mode=sequential");
    }
    const std::string_view key = part.substr(0, equals);
    if (std::find(seen.begin(), seen.end(), key) != seen.end())
      return usageError("--ars", fmt::format("{} stands there twice", key), {}, "Give each key once");
    seen.push_back(key);
    DELTAZ_TRY(setArsOption(key, part.substr(equals + 1), options));
    text.remove_prefix(comma);
    if (text.empty()) break;
    text.remove_prefix(1);
    if (text.empty()) return usageError("--ars", "nothing stands behind the last comma", {}, "Leave it out");
  }
  DELTAZ_TRY(ars::validate(options.machine));
  DELTAZ_TRY(ars::checkNumberProfile(options.tiler.numbers));
  return options;
}

std::string effectiveArsOptions(const ArsOptions& options) {
  ArsOptions effective = options;
  effective.machine.buffers = ars::bufferCount(options.machine);
  std::string text;
  for (const Setting& setting : settings())
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", setting.key.name, setting.get(effective));
  return text;
}

std::string describeArsOptions(const ArsOptions& options) {
  const ArsOptions of_report;
  std::string text;
  for (const Setting& setting : settings()) {
    const std::string value = setting.get(options);
    if (value != setting.get(of_report))
      text += fmt::format("{}{}={}", text.empty() ? "" : ",", setting.key.name, value);
  }
  return text;
}

}  // namespace deltaz
