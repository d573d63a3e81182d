// The host's side of the machine: buffers of triangles and tilers, each with a semaphore (report 5.2, Fig
// 53).
//
//   buffer   empty -> filling -> full -> transferring -> empty
//   tiler    available -> busy -> available; unavailable ones (out for repair) are never used
//
// A full buffer waits for a tiler, a tiler that is done takes the full buffer that has waited longest.
// Transfers end in any order, so neither buffers nor tilers are queues. A step that finds a buffer or tiler
// in the wrong state changes nothing and says so: Error of kInternal, "the diagnostic messages".
// Thread-safety: one thread an interface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "formats/error.h"

namespace deltaz::ars {

enum class BufferState : std::uint8_t { kEmpty, kFilling, kFull, kTransferring };
enum class TilerState : std::uint8_t { kAvailable, kBusy, kUnavailable };
std::string_view bufferStateName(BufferState state);
std::string_view tilerStateName(TilerState state);

class HardwareSoftwareInterface {
 public:
  // At least one of each. Buffers are empty, tilers available.
  HardwareSoftwareInterface(int tilers, int buffers);

  // Fail-soft: an available tiler is not used any more.
  Status takeOutOfService(int tiler);

  // The first empty buffer, now filling; none if there is none.
  std::optional<int> beginFilling();
  Status finishFilling(int buffer, std::size_t first_triangle, std::size_t last_triangle);

  struct Transfer {
    int buffer = 0, tiler = 0;
    std::size_t begin = 0, end = 0;  // triangles
  };
  // The buffer longest full goes to the tiler longest available; none if one is missing.
  std::optional<Transfer> beginTransfer();
  // The tiler's I/O is complete: its buffer is empty again.
  Status finishTransfer(int tiler);

  // All triangles are with the tilers, whose transfers are complete.
  bool idle() const;
  BufferState buffer(int number) const { return buffers_[static_cast<std::size_t>(number)].state; }
  TilerState tiler(int number) const { return tilers_[static_cast<std::size_t>(number)].state; }
  int tilersInService() const;

 private:
  struct Buffer {
    BufferState state = BufferState::kEmpty;
    std::size_t begin = 0, end = 0;
  };
  struct Tiler {
    TilerState state = TilerState::kAvailable;
    int buffer = -1;  // being transferred
  };
  Status expect(int buffer, BufferState state, const char* step) const;
  Status expectTiler(int tiler, TilerState state, const char* step) const;

  std::vector<Buffer> buffers_;
  std::vector<Tiler> tilers_;
  std::deque<int> full_, available_;  // in the order in which they became so
};

}  // namespace deltaz::ars
