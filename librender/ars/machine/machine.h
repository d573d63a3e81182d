// The machine: host interface, tilers, distribution tree and memories, put together as configured, run on a
// stream of triangles either in simulated time or without any.
//
// Both runs leave the same picture in the memories, to the last bit, if none of the pixels that arrive as
// near as what is there is of another colour (MemoryCounts::split_ties is 0, in one run, whichever), or with
// TieRule::kBrighter; and if background pixels stand behind barriers. So do all configurations.
//
// One colour word is held at a time: a picture in colours is three runs with a reading after each.
// Cost: some 250 ns a pixel timed, 25 ns not; small triangles more. Thread-safety: one thread a machine.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/error.h"
#include "librender/ars/machine/machine_configuration.h"
#include "librender/ars/machine/pass_statistics.h"
#include "librender/ars/machine/pixel_source.h"

namespace deltaz::ars {

class Machine {
 public:
  // kUsage as validate says. Memories hold nothing but zeros.
  static Result<Machine> make(const MachineConfiguration& configuration);

  // Statistics are verified (verifyConservation); kInternal if they do not add up or a semaphore is in the
  // wrong state.
  Result<PassStatistics> runTimed(const PixelSource& source);

  // In the order of the stream, without clocks. What the memories counted.
  MemoryCounts runFunctional(const PixelSource& source);

  // READ of every word, line by line: 512 x 512 colours. Clears INIT flags; where the next run writes
  // nothing, this picture stays.
  std::vector<std::uint8_t> readPicture();

  // Looks without READ.
  std::uint8_t color(int i, int j) const;
  std::uint32_t depth(int i, int j) const;
  bool written(int i, int j) const;  // by anything but BG, since the last reading

  // All words to zero, INIT clear: the reset before the first frame.
  void reset();

  const MachineConfiguration& configuration() const { return configuration_; }

 private:
  explicit Machine(const MachineConfiguration& configuration);
  MemoryModule module();  // of the whole picture
  static constexpr std::size_t placeOf(int i, int j) {
    return static_cast<std::size_t>(i) * kScreenPixels + static_cast<std::size_t>(j);
  }

  MachineConfiguration configuration_;
  MemoryMap map_;
  std::vector<std::uint64_t> words_;  // of all memories, line by line, and FunctionalMemory's padding
};

}  // namespace deltaz::ars
