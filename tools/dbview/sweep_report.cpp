#include "tools/dbview/sweep_report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

#include "tools/dbview/options.h"

namespace deltaz {

namespace {

// Two significant digits, and no more zeros than needed.
std::string shortNumber(double value) {
  if (!std::isfinite(value)) return "?";
  if (value == 0) return "0";
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(std::abs(value)))), 0, 6);
  return fmt::format("{:.{}f}", value, digits);
}

std::string decibels(const PictureError& error) {
  const double value = error.peakSignalToNoise();
  return std::isfinite(value) ? fmt::format("{:.1f}", value) : "same";
}

bool contains(const std::vector<std::size_t>& front, std::size_t k) {
  return std::find(front.begin(), front.end(), k) != front.end();
}

std::string tableOf(const SweepReport& report, std::span<const SweepRow> rows) {
  const std::vector<SweptKnob> knobs = sweptKnobs(report);
  std::string text = fmt::format("{:>8}", "tol px");
  for (const SweptKnob& knob : knobs) text += fmt::format(" {:>9}", knob.heading);
  text += fmt::format(" {:>8} {:>8} {:>8} {:>9} {:>9} {:>8} {:>8} {:>7} {:>10} {:>9}  {}\n", "ms", "least",
                      "most", "worst px", "99.9% px", "bound px", "differ", "PSNR dB", "triangles",
                      "read KiB", "front");
  const std::vector<std::size_t> moved = frontOf(rows, SweepMeasure::kDisplacement),
                                 colored = frontOf(rows, SweepMeasure::kPicture);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SweepRow& row = rows[k];
    std::string line = fmt::format("{:>8}", toleranceText(row.setting));
    for (const SweptKnob& knob : knobs) line += fmt::format(" {:>9}", knob.text(row.setting));
    line += fmt::format(
        " {:>8.2f} {:>8.2f} {:>8.2f} {:>9.3f} {:>9.3f} {:>8.3f} {:>7.2f}% {:>7} {:>10} {:>9}  {}{}",
        row.milliseconds.median, row.milliseconds.minimum, row.milliseconds.maximum, row.displacement.largest,
        row.displacement.nearly_all, row.statistics.projected_error, 100 * row.picture.differingShare(),
        decibels(row.picture), row.statistics.triangles.drawn, row.statistics.bytes_read / 1024,
        contains(moved, k) ? "d" : "", contains(colored, k) ? "c" : "");
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::vector<SweptKnob> sweptKnobs(const SweepReport& report) {
  const auto differ = [&](const auto& value) {
    return std::any_of(report.all.begin(), report.all.end(), [&](const SweepRow& row) {
      return value(row.setting) != value(report.all.front().setting);
    });
  };
  std::vector<SweptKnob> knobs;
  if (differ([](const SweepSetting& setting) { return setting.lod; })) {
    knobs.push_back({"lod", [](const SweepSetting& setting) { return std::string(lodName(setting.lod)); },
                     [](const SweepSetting& setting) {
                       return std::string(setting.lod == LodScheme::kReport ? "by range" : "by error");
                     }});
  }
  if (differ([](const SweepSetting& setting) { return setting.transform; })) {
    const auto name = [](const SweepSetting& setting) {
      return std::string(transformName(setting.transform));
    };
    knobs.push_back({"transform", name, name});
  }
  if (differ([](const SweepSetting& setting) { return setting.samples; })) {
    knobs.push_back({"samples",
                     [](const SweepSetting& setting) { return fmt::format("{}", setting.samples); },
                     [](const SweepSetting& setting) {
                       return fmt::format("{} sample{}", setting.samples, setting.samples == 1 ? "" : "s");
                     }});
  }
  if (differ([](const SweepSetting& setting) { return setting.database; })) {
    knobs.push_back({"quantum m",
                     [&](const SweepSetting& setting) { return report.quanta[setting.database]; },
                     [&](const SweepSetting& setting) {
                       return fmt::format("quantum {} m", report.quanta[setting.database]);
                     }});
  }
  return knobs;
}

std::string toleranceText(const SweepSetting& setting) {
  return setting.lod == LodScheme::kReport ? "-" : fmt::format("{}", setting.tolerance);
}

std::string knobsName(const SweepReport& report, const SweepSetting& setting) {
  std::string name;
  for (const SweptKnob& knob : sweptKnobs(report)) name += (name.empty() ? "" : ", ") + knob.phrase(setting);
  return name;
}

std::string settingName(const SweepReport& report, const SweepSetting& setting) {
  const std::string knobs = knobsName(report, setting);
  if (setting.lod == LodScheme::kReport) return knobs.empty() ? "by range" : knobs;
  return fmt::format("{} px{}{}", setting.tolerance, knobs.empty() ? "" : ", ", knobs);
}

std::string frontSentence(const SweepReport& report, SweepMeasure measure) {
  std::string sentence;
  for (const std::size_t k : frontOf(report.all, measure)) {
    const SweepRow& row = report.all[k];
    const bool first = sentence.empty();
    std::string error;
    if (measure == SweepMeasure::kDisplacement) {
      error = shortNumber(row.displacement.largest);
      error += first && row.displacement.largest > 1 ? " pixels cost" : first ? " pixel costs" : " pixel";
      if (!first && row.displacement.largest > 1) error += "s";
    } else if (row.picture.mean_square == 0) {
      error = first ? "the reference's own colours cost" : "the reference's own colours";
    } else {
      error = decibels(row.picture) + (first ? " dB cost" : " dB");
    }
    sentence += fmt::format("{}{} {} ms ({})", first ? "" : ", ", error,
                            fmt::format("{:.1f}", row.milliseconds.median), settingName(report, row.setting));
  }
  return sentence;
}

std::string textReport(const SweepReport& report) {
  const SweepMachine& machine = report.machine;
  std::string text = fmt::format("{}: {} view{}, {} settings, {} frames each on {} thread{}", report.area,
                                 report.views.size(), report.views.size() == 1 ? "" : "s", report.all.size(),
                                 report.repeats, machine.threads, machine.threads == 1 ? "" : "s");
  text += machine.load_before >= 0 && machine.load_after >= 0
              ? fmt::format("; load of the machine {:.1f} before, {:.1f} after, {} processors\n",
                            machine.load_before, machine.load_after, machine.processors)
              : "\n";
  for (const SweepOfView& view : report.views) {
    text += fmt::format("\n{}, {} x {}\n", view.view.name, view.view.camera.width, view.view.camera.height);
    text += tableOf(report, view.rows);
  }
  if (report.views.size() > 1) {
    text += "\nall views: mean times, worst displacements, sums\n";
    text += tableOf(report, report.all);
  }
  text += fmt::format(
      "\nfront: nothing is both faster and nearer to the full-resolution surface (d), or to the colours at "
      "tolerance {}{} (c)\n",
      report.reference_tolerance,
      report.reference_samples > 1 ? fmt::format(" with {} samples", report.reference_samples) : "");
  for (const SweepMeasure measure : {SweepMeasure::kDisplacement, SweepMeasure::kPicture}) {
    if (const std::string sentence = frontSentence(report, measure); !sentence.empty())
      text += sentence + ".\n";
  }
  return text;
}

}  // namespace deltaz
