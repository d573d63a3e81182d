// One number of the report beside ours, for `dbview ars-report`. Thread-safety: plain values.
#pragma once

#include <optional>
#include <string>

namespace deltaz::ars {

struct ReportRow {
  std::string id;                   // "table23.oversample.4.efficiency"
  std::string description;          // with units
  std::optional<double> published;  // nothing where the figure is lost or the report is silent
  double ours = 0;
  std::string note;  // what stands in the way, where the two differ

  // ours / published; nothing without a published number other than 0.
  std::optional<double> ratio() const {
    if (!published.has_value() || *published == 0) return std::nullopt;
    return ours / *published;
  }
};

}  // namespace deltaz::ars
