#include "librender/ars/machine/machine_configuration.h"

#include <algorithm>
#include <bit>
#include <fmt/format.h>

namespace deltaz::ars {

namespace {

Status inRange(const char* what, int value, int least, int most) {
  if (value >= least && value <= most) return Success{};
  return usageError("machine configuration", fmt::format("{} {} cannot be", value, what), {},
                    fmt::format("give {} to {}", least, most));
}

Status powerOfTwo(const char* what, int value, int most) {
  if (value >= 1 && value <= most && std::has_single_bit(static_cast<unsigned>(value))) return Success{};
  return usageError("machine configuration", fmt::format("{} {} cannot be", value, what),
                    "cells of the distribution tree sort by one bit each",
                    fmt::format("give a power of two from 1 to {}", most));
}

}  // namespace

int bufferCount(const MachineConfiguration& configuration) {
  return configuration.buffers == kOneBufferMoreThanTilers ? configuration.tilers + 1 : configuration.buffers;
}

Status validate(const MachineConfiguration& configuration) {
  DELTAZ_TRY(powerOfTwo("tilers", configuration.tilers, kMaximumTilers));
  DELTAZ_TRY(powerOfTwo("memories", configuration.memories, kMaximumMemories));
  DELTAZ_TRY(inRange("pixels in a queue", configuration.queue_depth, 0, kMaximumQueueDepth));
  DELTAZ_TRY(inRange("bits of depth mantissa", configuration.depth_mantissa_bits, 1, 31));
  DELTAZ_TRY(inRange("pixels in a memory's FIFO", configuration.memory_fifo, 1, kMaximumFifoDepth));
  DELTAZ_TRY(inRange("pixels in a tiler's output FIFO", configuration.output_fifo, 1, kMaximumFifoDepth));
  DELTAZ_TRY(inRange("triangles in a transfer FIFO", configuration.transfer_fifo, 1, kMaximumFifoDepth));
  DELTAZ_TRY(inRange("triangles in a set-up FIFO", configuration.set_up_fifo, 1, kMaximumFifoDepth));
  DELTAZ_TRY(inRange("percent of the tilers' clock", configuration.tiler_clock_percent, 1, 1000));
  DELTAZ_TRY(inRange("buffers", configuration.buffers, 0, 10'000));
  DELTAZ_TRY(inRange("triangles in a buffer", configuration.buffer_triangles, 1, 1'000'000));
  DELTAZ_TRY(inRange("nanoseconds a word", configuration.word_transfer, 0, 1'000'000));
  DELTAZ_TRY(inRange("nanoseconds a triangle", configuration.host_triangle, 0, 1'000'000));
  std::vector<bool> out(static_cast<std::size_t>(configuration.tilers));
  for (const int tiler : configuration.unavailable) {
    if (tiler < 0 || tiler >= configuration.tilers)
      return usageError("machine configuration", fmt::format("there is no tiler {} to be unavailable", tiler),
                        {}, fmt::format("give 0 to {}", configuration.tilers - 1));
    out[static_cast<std::size_t>(tiler)] = true;
  }
  if (std::all_of(out.begin(), out.end(), [](bool one) { return one; }))
    return usageError("machine configuration", "no tiler is available", {}, "leave at least one in service");
  return Success{};
}

}  // namespace deltaz::ars
