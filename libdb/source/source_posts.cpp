#include "libdb/source/source_posts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "formats/terrain_segment.h"
#include "libdb/source/simple_fraction.h"
#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

constexpr double kFloatMax = 3.4028234663852886e38;

// What programs write for "no elevation" without always saying so.
constexpr std::array<double, 16> kCustomarySentinels = {-32768,
                                                        -32767,
                                                        32767,
                                                        -9999,
                                                        -99999,
                                                        65535,
                                                        -2147483648.0,
                                                        2147483647.0,
                                                        -kFloatMax,
                                                        kFloatMax,
                                                        -std::numeric_limits<double>::max(),
                                                        std::numeric_limits<double>::max(),
                                                        -1e38,
                                                        1e38,
                                                        -3.4e38,
                                                        1e30};

// Fractions of a unit that decimal and binary roundings give, coarsest first.
constexpr std::array<std::int64_t, 29> kDenominators = {1,   2,   4,   5,   8,   10,  16,  20,  25,  32,
                                                        40,  50,  64,  80,  100, 125, 128, 160, 200, 250,
                                                        256, 320, 400, 500, 512, 625, 640, 800, 1000};

// Equal as the raster stores it: a sentinel declared in text may differ in the last digits of a float, and a
// very large one (the lowest float) in more.
bool isDeclared(double value, double nodata, const StoredType& type) {
  if (std::isnan(nodata)) return false;  // NaN is always void
  if (value == nodata) return true;
  if (!type.floating) return false;
  if (type.bits == 32 && static_cast<float>(value) == static_cast<float>(nodata)) return true;
  return std::abs(nodata) > 1e30 && std::abs(value - nodata) <= 1e-5 * std::abs(nodata);
}

class Interpreter {
 public:
  Interpreter(PostValues values, const std::vector<std::uint8_t>& masked, PostMeaning& meaning, RawGrid& grid,
              std::vector<std::string>& warnings)
      : values_(std::move(values)),
        masked_(masked),
        meaning_(meaning),
        grid_(grid),
        warnings_(warnings),
        columns_(static_cast<std::size_t>(meaning.source.columns)) {}

  Status run() {
    DELTAZ_TRY(markDeclaredVoids());
    markUndeclaredSentinels();
    if (voids_ == values_.size())
      return refusedSource(meaning_.path, "the source has no elevations", "every post is void");
    DELTAZ_TRY(chooseQuantum());
    DELTAZ_TRY(convert());
    warnOfRange();
    return Success{};
  }

 private:
  bool isValid(std::size_t k) const { return grid_.valid.empty() || grid_.valid[k] != 0; }

  // Marks post k void; `sentinel` is what is to stand there when the grid is written back.
  Status makeVoid(std::size_t k, double sentinel) {
    if (grid_.valid.empty()) grid_.valid.assign(values_.size(), 1);
    std::vector<double>& kinds = grid_.header.sentinels;
    std::size_t kind = 0;
    while (kind < kinds.size() && kinds[kind] != sentinel &&
           !(std::isnan(kinds[kind]) && std::isnan(sentinel)))
      ++kind;
    if (kind == kinds.size()) {
      if (kinds.size() == 64)
        return refusedSource(meaning_.path, "the source has more than 64 different values for void posts");
      kinds.push_back(sentinel);
    }
    if (kind > 0 && grid_.void_kinds.empty()) grid_.void_kinds.assign(values_.size(), 0);
    if (!grid_.void_kinds.empty()) grid_.void_kinds[k] = static_cast<std::uint8_t>(kind);
    grid_.valid[k] = 0;
    ++voids_;
    return Success{};
  }

  Status markDeclaredVoids() {
    const std::optional<double> nodata = meaning_.source.nodata;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const double value = values_[k];
      if (std::isnan(value) || (nodata && isDeclared(value, *nodata, meaning_.type)))
        DELTAZ_TRY(makeVoid(k, value));
    }
    if (masked_.empty()) return Success{};
    std::optional<double> sentinel = nodata;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (masked_[k] == 0 || !isValid(k)) continue;
      if (!sentinel) {
        DELTAZ_TRY_ASSIGN(sentinel, unusedValue());
        meaning_.source.nodata = sentinel;
      }
      DELTAZ_TRY(makeVoid(k, *sentinel));
    }
    return Success{};
  }

  // A value of the stored type that no post outside the mask has.
  Result<double> unusedValue() const {
    return unusedStoredValue(meaning_.type, meaning_.path, [this](double value) {
      for (std::size_t k = 0; k < values_.size(); ++k) {
        if (masked_[k] == 0 && values_[k] == value) return true;
      }
      return false;
    });
  }

  // ---- sentinels nobody declared

  static bool isCustomary(double value) {
    // Rounding to float may have happened on the way.
    return std::any_of(kCustomarySentinels.begin(), kCustomarySentinels.end(), [value](double sentinel) {
      return value == sentinel ||
             (std::abs(sentinel) > 1e9 && std::abs(value - sentinel) <= 1e-6 * std::abs(sentinel));
    });
  }

  void markUndeclaredSentinels() {
    std::vector<std::size_t> suspects;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (isValid(k) && isCustomary(values_[k])) suspects.push_back(k);
    }
    std::vector<double> judged;
    for (const std::size_t first : suspects) {
      const double value = values_[first];
      if (std::find(judged.begin(), judged.end(), value) != judged.end()) continue;
      judged.push_back(value);
      const Judgement judgement = judge(value, suspects);
      if (judgement == Judgement::kUnknown) warnAlone(value, suspects);
      if (judgement != Judgement::kSentinel) continue;
      std::size_t count = 0;
      for (const std::size_t k : suspects) {
        if (values_[k] != value) continue;
        if (!makeVoid(k, value).ok()) return;
        ++count;
      }
      warnings_.push_back(
          fmt::format("{}: {} post{} of value {} {} taken for void: a customary sentinel that the source "
                      "does not declare, "
                      "far from every neighbour (declare it with --nodata)",
                      meaning_.path, count, count == 1 ? "" : "s", value, count == 1 ? "is" : "are"));
    }
  }

  void warnAlone(double value, const std::vector<std::size_t>& suspects) {
    const auto count =
        std::count_if(suspects.begin(), suspects.end(), [&](std::size_t k) { return values_[k] == value; });
    warnings_.push_back(fmt::format(
        "{}: {} post{} of value {} {} kept as heights, though it is a customary sentinel and no other height "
        "is beside them (if it means void, say so with --nodata)",
        meaning_.path, count, count == 1 ? "" : "s", value, count == 1 ? "is" : "are"));
  }

  // A sentinel stands, at every post of its value, far above or below all neighbours.
  enum class Judgement : std::uint8_t { kHeight, kSentinel, kUnknown };
  Judgement judge(double value, const std::vector<std::size_t>& suspects) const {
    const double metres_per_step = std::abs(meaning_.source.scale) * meaning_.unit.value();
    const std::size_t rows = values_.size() / columns_;
    bool has_neighbour = false;
    for (const std::size_t k : suspects) {
      if (values_[k] != value) continue;
      const std::size_t column = k % columns_, row = k / columns_;
      const auto isNear = [&](std::size_t neighbour) {
        if (!isValid(neighbour) || isCustomary(values_[neighbour])) return false;
        has_neighbour = true;
        return std::abs(values_[neighbour] - value) * metres_per_step < kImplausibleJump;
      };
      if ((column > 0 && isNear(k - 1)) || (column + 1 < columns_ && isNear(k + 1)) ||
          (row > 0 && isNear(k - columns_)) || (row + 1 < rows && isNear(k + columns_)))
        return Judgement::kHeight;
    }
    return has_neighbour || std::abs(value) * metres_per_step > kImplausibleHeight ? Judgement::kSentinel
                                                                                   : Judgement::kUnknown;
  }

  // ---- quantum

  // The largest error over all valid posts that `quantum` makes, metres; 0 if every stored value comes back.
  // With `exact_only` it stops at the first that does not, with infinity.
  double errorOf(const Rational& quantum, bool exact_only) const {
    const StoredValues stored(meaning_.source, meaning_.type, meaning_.unit, quantum);
    double largest = 0;
    bool exact = true;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (!isValid(k)) continue;
      const double value = values_[k];
      const double quanta = std::round(stored.quantaOf(value));
      if (!(std::abs(quanta) <= kMaximumHeightQuanta)) {
        if (exact_only) return std::numeric_limits<double>::infinity();
        continue;  // convert() says so
      }
      if (stored.storedOf(quanta) == value) continue;
      exact = false;
      if (exact_only) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, std::abs(quanta * quantum.value() - stored.elevationOf(value)));
    }
    return exact ? 0 : largest;
  }

  // The quantum that whole numbers with a simple scale and offset have by themselves.
  std::optional<Rational> quantumOfIntegers() const {
    if (meaning_.type.floating) return std::nullopt;
    const std::optional<Rational> scale = fractionOf(meaning_.source.scale);
    const std::optional<Rational> offset = fractionOf(meaning_.source.offset);
    if (!scale || !offset) return std::nullopt;
    const std::optional<Rational> step = commonMeasure(*scale, *offset);
    return step ? product(*step, meaning_.unit) : std::nullopt;
  }

  Status chooseQuantum() {
    GridHeader& header = grid_.header;
    if (meaning_.quantum) {
      header.quantum = *meaning_.quantum;
      header.height_error = errorOf(header.quantum, false);
      return Success{};
    }
    if (const std::optional<Rational> quantum = quantumOfIntegers()) {
      header.quantum = *quantum;
      header.height_error = errorOf(header.quantum, false);
      return Success{};
    }
    constexpr Rational kMetre{1, 1};
    for (const Rational& unit : {meaning_.unit, kMetre}) {
      for (const std::int64_t denominator : kDenominators) {
        const std::optional<Rational> candidate = product(unit, {1, denominator});
        if (!candidate || candidate->value() < kFinestExactQuantum) break;
        if (errorOf(*candidate, true) != 0) continue;
        header.quantum = *candidate;
        return Success{};
      }
      if (meaning_.unit == kMetre) break;
    }
    header.quantum = kCoarseQuantum;
    header.height_error = errorOf(header.quantum, false);
    return Success{};
  }

  Status convert() {
    const StoredValues stored(meaning_.source, meaning_.type, meaning_.unit, grid_.header.quantum);
    const std::size_t posts = values_.size();
    std::vector<std::int32_t> heights = std::move(values_.integers);
    heights.resize(posts);
    const bool from_integers = values_.numbers.empty();
    for (std::size_t k = 0; k < posts; ++k) {
      const double value = from_integers ? static_cast<double>(heights[k]) : values_.numbers[k];
      heights[k] = 0;
      if (!isValid(k)) continue;
      const double quanta = std::round(stored.quantaOf(value));
      if (!(std::abs(quanta) <= kMaximumHeightQuanta)) {
        return refusedSource(meaning_.path, fmt::format("the elevation {} is out of range", value),
                             "in whole height steps it does not fit 31 bits",
                             "If it means void, say so with --nodata");
      }
      heights[k] = static_cast<std::int32_t>(quanta);
    }
    grid_.heights = std::move(heights);
    return Success{};
  }

  // Nothing is changed: it may be another planet, or not.
  void warnOfRange() {
    const double quantum = grid_.header.quantum.value();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t k = 0; k < grid_.heights.size(); ++k) {
      if (!isValid(k)) continue;
      const double height = static_cast<double>(grid_.heights[k]) * quantum;
      low = std::min(low, height);
      high = std::max(high, height);
    }
    if (low >= kLowestOnEarth && high <= kHighestOnEarth) return;
    warnings_.push_back(
        fmt::format("{}: its heights reach from {} to {} m, as none on Earth do; they are kept (if a value "
                    "means void, say so with --nodata)",
                    meaning_.path, low, high));
  }

  PostValues values_;
  const std::vector<std::uint8_t>& masked_;
  PostMeaning& meaning_;
  RawGrid& grid_;
  std::vector<std::string>& warnings_;
  const std::size_t columns_;
  std::size_t voids_ = 0;
};

}  // namespace

Result<double> unusedStoredValue(const StoredType& type, const std::string& path,
                                 const std::function<bool(double)>& used) {
  for (const double value :
       {-32768.0, -32767.0, -9999.0, 65535.0, 0.0, 255.0, type.lowest, type.highest, 254.0}) {
    if (!type.floating && (value < type.lowest || value > type.highest)) continue;
    if (!used(value)) return value;
  }
  return refusedSource(path, "no value is left to mean void", "the elevations use every customary one",
                       "Name one with --nodata");
}

Status interpretPosts(PostValues values, const std::vector<std::uint8_t>& masked, PostMeaning& meaning,
                      RawGrid& grid, std::vector<std::string>& warnings) {
  return Interpreter(std::move(values), masked, meaning, grid, warnings).run();
}

}  // namespace deltaz
