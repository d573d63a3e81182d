// What dbview sweep found, for people: a table of each view, one of all views together, and sentences that
// name what an error costs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "librender/sweep/sweep.h"

namespace deltaz {

// The machine while the sweep ran. Loads are the mean number of runnable processes over a minute; negative if
// the system does not tell.
struct SweepMachine {
  int processors = 0, threads = 0;
  double load_before = -1, load_after = -1;
};

struct SweepReport {
  std::string area;  // base name
  int repeats = 0;
  double reference_tolerance = 0;
  int reference_samples = 1;
  Sampling sampling;                // pattern and filter of all pictures
  std::vector<std::string> quanta;  // of the databases, metres
  SweepMachine machine;
  std::vector<SweepOfView> views;
  std::vector<SweepRow> all;  // over all views
};

// A knob besides the tolerance, of which several values were tried.
struct SweptKnob {
  std::string heading;                                     // of the table's column
  std::function<std::string(const SweepSetting&)> text;    // in the table: "0.1"
  std::function<std::string(const SweepSetting&)> phrase;  // in a sentence: "quantum 0.1 m"
};
std::vector<SweptKnob> sweptKnobs(const SweepReport& report);

// "0.5", or "-" where ranges stand in the tolerance's place.
std::string toleranceText(const SweepSetting& setting);

// The values of the swept knobs, "quantum 0.1 m, ..."; empty where none was swept.
std::string knobsName(const SweepReport& report, const SweepSetting& setting);

// "0.5 px", or with whatever other knobs were swept: "0.5 px, quantum 0.1 m".
std::string settingName(const SweepReport& report, const SweepSetting& setting);

// "0.79 pixel costs 2.1 ms (0.5 px), 0.42 pixel 3.0 ms (0.25 px)": the front of a measure, the cheapest
// first. Empty where the front is.
std::string frontSentence(const SweepReport& report, SweepMeasure measure);

std::string textReport(const SweepReport& report);

}  // namespace deltaz
