#include "librender/ars/machine/hardware_software_interface.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <fmt/format.h>

namespace deltaz::ars {

std::string_view bufferStateName(BufferState state) {
  constexpr std::array<std::string_view, 4> kNames = {"empty", "filling", "full", "transferring"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string_view tilerStateName(TilerState state) {
  constexpr std::array<std::string_view, 3> kNames = {"available", "busy", "unavailable"};
  return kNames[static_cast<std::size_t>(state)];
}

HardwareSoftwareInterface::HardwareSoftwareInterface(int tilers, int buffers)
    : buffers_(static_cast<std::size_t>(buffers)), tilers_(static_cast<std::size_t>(tilers)) {
  assert(tilers >= 1 && buffers >= 1);
  for (int tiler = 0; tiler < tilers; ++tiler) available_.push_back(tiler);
}

Status HardwareSoftwareInterface::expect(int buffer, BufferState state, const char* step) const {
  if (buffer < 0 || buffer >= static_cast<int>(buffers_.size()))
    return internalError(fmt::format("buffer {}", buffer), fmt::format("there is none to {}", step));
  const BufferState is = buffers_[static_cast<std::size_t>(buffer)].state;
  if (is == state) return Success{};
  return internalError(
      fmt::format("buffer {}", buffer),
      fmt::format("is {} where {} needs one that is {}", bufferStateName(is), step, bufferStateName(state)));
}

Status HardwareSoftwareInterface::expectTiler(int tiler, TilerState state, const char* step) const {
  if (tiler < 0 || tiler >= static_cast<int>(tilers_.size()))
    return internalError(fmt::format("tiler {}", tiler), fmt::format("there is none to {}", step));
  const TilerState is = tilers_[static_cast<std::size_t>(tiler)].state;
  if (is == state) return Success{};
  return internalError(
      fmt::format("tiler {}", tiler),
      fmt::format("is {} where {} needs one that is {}", tilerStateName(is), step, tilerStateName(state)));
}

Status HardwareSoftwareInterface::takeOutOfService(int tiler) {
  DELTAZ_TRY(expectTiler(tiler, TilerState::kAvailable, "taking out of service"));
  tilers_[static_cast<std::size_t>(tiler)].state = TilerState::kUnavailable;
  std::erase(available_, tiler);
  return Success{};
}

std::optional<int> HardwareSoftwareInterface::beginFilling() {
  for (std::size_t number = 0; number < buffers_.size(); ++number) {
    if (buffers_[number].state != BufferState::kEmpty) continue;
    buffers_[number].state = BufferState::kFilling;
    return static_cast<int>(number);
  }
  return std::nullopt;
}

Status HardwareSoftwareInterface::finishFilling(int buffer, std::size_t first_triangle,
                                                std::size_t last_triangle) {
  DELTAZ_TRY(expect(buffer, BufferState::kFilling, "the end of filling"));
  buffers_[static_cast<std::size_t>(buffer)] = {
      .state = BufferState::kFull, .begin = first_triangle, .end = last_triangle};
  full_.push_back(buffer);
  return Success{};
}

std::optional<HardwareSoftwareInterface::Transfer> HardwareSoftwareInterface::beginTransfer() {
  if (full_.empty() || available_.empty()) return std::nullopt;
  Buffer& buffer = buffers_[static_cast<std::size_t>(full_.front())];
  const Transfer transfer{
      .buffer = full_.front(), .tiler = available_.front(), .begin = buffer.begin, .end = buffer.end};
  full_.pop_front();
  available_.pop_front();
  buffer.state = BufferState::kTransferring;
  tilers_[static_cast<std::size_t>(transfer.tiler)] = {.state = TilerState::kBusy, .buffer = transfer.buffer};
  return transfer;
}

Status HardwareSoftwareInterface::finishTransfer(int tiler) {
  DELTAZ_TRY(expectTiler(tiler, TilerState::kBusy, "the end of a transfer"));
  Tiler& busy = tilers_[static_cast<std::size_t>(tiler)];
  DELTAZ_TRY(expect(busy.buffer, BufferState::kTransferring, "the end of a transfer"));
  buffers_[static_cast<std::size_t>(busy.buffer)].state = BufferState::kEmpty;
  busy = {};
  available_.push_back(tiler);
  return Success{};
}

bool HardwareSoftwareInterface::idle() const {
  const auto empty = [](const Buffer& buffer) { return buffer.state == BufferState::kEmpty; };
  return std::all_of(buffers_.begin(), buffers_.end(), empty);
}

int HardwareSoftwareInterface::tilersInService() const {
  const auto used = [](const Tiler& tiler) { return tiler.state != TilerState::kUnavailable; };
  return static_cast<int>(std::count_if(tilers_.begin(), tilers_.end(), used));
}

}  // namespace deltaz::ars
