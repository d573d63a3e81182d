#include "libdb/source/height_units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace deltaz {

namespace {

struct UnitName {
  std::string_view name;
  Rational metres;
};
constexpr Rational kMetre{1, 1}, kCentimetre{1, 100}, kDecimetre{1, 10}, kFoot{381, 1250},
    kSurveyFoot{1200, 3937};
constexpr std::array<UnitName, 22> kUnits = {{{"", kMetre},
                                              {"m", kMetre},
                                              {"metre", kMetre},
                                              {"metres", kMetre},
                                              {"meter", kMetre},
                                              {"meters", kMetre},
                                              {"cm", kCentimetre},
                                              {"centimetre", kCentimetre},
                                              {"centimeter", kCentimetre},
                                              {"dm", kDecimetre},
                                              {"decimetre", kDecimetre},
                                              {"decimeter", kDecimetre},
                                              {"ft", kFoot},
                                              {"foot", kFoot},
                                              {"feet", kFoot},
                                              {"international foot", kFoot},
                                              {"ft_int", kFoot},
                                              {"us-ft", kSurveyFoot},
                                              {"ftus", kSurveyFoot},
                                              {"us survey foot", kSurveyFoot},
                                              {"foot_us", kSurveyFoot},
                                              {"sft", kSurveyFoot}}};

}  // namespace

std::optional<Rational> metresPerUnit(const std::string& unit) {
  std::string lower = unit;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const UnitName& entry : kUnits) {
    if (entry.name == lower) return entry.metres;
  }
  return std::nullopt;
}

}  // namespace deltaz
