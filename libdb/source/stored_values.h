// How the values a raster stores and heights in whole quanta follow from each other, in one place for import
// and export. A stored value v is the elevation v * scale + offset in the source's unit. Where scale and
// offset are simple fractions the arithmetic is that of whole numbers, so that what went in comes out.
// Thread-safety: plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "formats/area.h"

namespace deltaz {

// Types of stored values, by GDAL's names.
struct StoredType {
  bool floating = false;
  int bits = 0;
  double lowest = 0, highest = 0;  // of whole-number types
};
// Nothing for complex and unknown types.
std::optional<StoredType> storedTypeOf(const std::string& name);

class StoredValues {
 public:
  // `unit` is metres in a unit of the source's elevations, `quantum` metres in a height step.
  StoredValues(const SourceDescription& source, const StoredType& type, const Rational& unit,
               const Rational& quantum);

  // The height nearest to a stored value, in quanta, not yet rounded.
  double quantaOf(double stored) const { return stored * factor_ / divisor_ + shift_; }
  // The stored value of a height, as the type holds it.
  double storedOf(double quanta) const;
  // Metres.
  double elevationOf(double stored) const { return (stored * scale_ + offset_) * unit_; }

 private:
  StoredType type_;
  double scale_, offset_, unit_;
  double factor_ = 1, divisor_ = 1, shift_ = 0;  // quanta = stored * factor / divisor + shift
};

}  // namespace deltaz
