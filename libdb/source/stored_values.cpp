#include "libdb/source/stored_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "libdb/source/simple_fraction.h"

namespace deltaz {

namespace {

struct NamedType {
  std::string_view name;
  StoredType type;
};
constexpr std::array<NamedType, 10> kTypes = {
    {{"Byte", {false, 8, 0, 255}},
     {"Int8", {false, 8, -128, 127}},
     {"Int16", {false, 16, -32768, 32767}},
     {"UInt16", {false, 16, 0, 65535}},
     {"Int32", {false, 32, -2147483648.0, 2147483647.0}},
     {"UInt32", {false, 32, 0, 4294967295.0}},
     {"Int64", {false, 64, -9223372036854775808.0, 9223372036854775808.0}},
     {"UInt64", {false, 64, 0, 18446744073709551616.0}},
     {"Float32", {true, 32, 0, 0}},
     {"Float64", {true, 64, 0, 0}}}};

}  // namespace

std::optional<StoredType> storedTypeOf(const std::string& name) {
  for (const NamedType& entry : kTypes) {
    if (entry.name == name) return entry.type;
  }
  return std::nullopt;
}

StoredValues::StoredValues(const SourceDescription& source, const StoredType& type, const Rational& unit,
                           const Rational& quantum)
    : type_(type), scale_(source.scale), offset_(source.offset), unit_(unit.value()) {
  const std::optional<Rational> per_unit = quotient(unit, quantum);
  const std::optional<Rational> scale = fractionOf(source.scale), offset = fractionOf(source.offset);
  std::optional<Rational> factor, shift;
  if (per_unit && scale) factor = product(*per_unit, *scale);
  if (per_unit && offset) shift = product(*per_unit, *offset);
  if (factor && shift) {
    factor_ = static_cast<double>(factor->numerator);
    divisor_ = static_cast<double>(factor->denominator);
    shift_ = shift->value();
  } else {
    factor_ = unit_ * scale_ / quantum.value();
    shift_ = unit_ * offset_ / quantum.value();
  }
}

double StoredValues::storedOf(double quanta) const {
  const double value = (quanta - shift_) * divisor_ / factor_;
  if (type_.floating) return type_.bits == 32 ? static_cast<double>(static_cast<float>(value)) : value;
  return std::clamp(std::round(value), type_.lowest, type_.highest);
}

}  // namespace deltaz
