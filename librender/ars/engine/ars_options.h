// How the machine is built, and how a frame is drawn on it: what `--ars KEY=VALUE,...` says.
//
// Thread-safety: plain values and pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/error.h"
#include "librender/ars/machine/machine_configuration.h"
#include "librender/ars/tiler/tiler_configuration.h"

namespace deltaz {

struct ArsOptions {
  ars::MachineConfiguration machine;
  ars::TilerConfiguration tiler;
  bool oversample = false;
  // 3: red, green and blue one after the other, as colour pictures were made; 1: brightness alone.
  int passes = 3;
  // Name of the antialiaser's kernel (antialiaser/shift_add_filter.h), whose ratio is how many times as many
  // lines and pixels the machine draws; empty for none.
  std::string antialiaser;
  // In simulated time, with statistics; or the pixels alone, in a tenth of the time.
  bool timed = true;
};

// One key of the command line, for help and errors.
struct ArsKey {
  std::string_view name, values, meaning;
};
std::span<const ArsKey> arsKeys();

// "key=value,key=value" over `options`. kUsage names the key, its values and what is near a key there is none
// of; the machine that comes out is valid.
Result<ArsOptions> parseArsOptions(std::string_view text, ArsOptions options = {});
// One key and its value; the machine may not be valid yet. Errors name `option`, where the key was given.
Status setArsOption(std::string_view key, std::string_view value, ArsOptions& options,
                    std::string_view option = "--ars");

// What differs from the report's machine, as parseArsOptions reads it; empty if nothing does.
std::string describeArsOptions(const ArsOptions& options);
// Every setting as it takes effect, likewise: of buffers their number, not that it goes by the tilers.
std::string effectiveArsOptions(const ArsOptions& options);

}  // namespace deltaz
