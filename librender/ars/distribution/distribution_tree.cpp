#include "librender/ars/distribution/distribution_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace deltaz::ars {

std::string_view queueDisciplineName(QueueDiscipline discipline) {
  return discipline == QueueDiscipline::kInputsFirst ? "strict" : "queue-first";
}

std::optional<QueueDiscipline> queueDisciplineNamed(std::string_view name) {
  for (const QueueDiscipline discipline : {QueueDiscipline::kInputsFirst, QueueDiscipline::kQueueFirst})
    if (queueDisciplineName(discipline) == name) return discipline;
  return std::nullopt;
}

int TreeStatistics::longestQueue() const {
  int longest = 0;
  for (const TreeLevelStatistics& level : levels)
    for (const QueueStatistics& queue : level.queues) longest = std::max(longest, queue.high_water);
  return longest;
}

// A register is looked at before it can be filled again in the same cycle, so one that is filled in cycle n
// was empty from the cycle after it was last busy up to n, both included.
void DistributionTree::Registers::fill(int k, const TreePixel& what, std::int64_t cycle) {
  const auto at = static_cast<std::size_t>(k);
  pixel[at] = what;
  occupied |= std::uint64_t{1} << k;
  statistics[at].starved += cycle - last_busy[at];
}

void DistributionTree::Registers::leave(int k, std::int64_t cycle) {
  const auto at = static_cast<std::size_t>(k);
  occupied &= ~(std::uint64_t{1} << k);
  ++statistics[at].busy;
  last_busy[at] = cycle;
}

void DistributionTree::Queue::countLength(std::int64_t cycle) {
  cycles_at_length[static_cast<std::size_t>(length)] += cycle - changed;
  changed = cycle;
}

void DistributionTree::Queue::push(const TreePixel& pixel, std::int64_t cycle) {
  countLength(cycle);
  const int room = static_cast<int>(ring.size());
  if (length == room) {
    std::vector<TreePixel> larger(static_cast<std::size_t>(std::max(4, 2 * room)));
    for (int k = 0; k < length; ++k)
      larger[static_cast<std::size_t>(k)] = ring[static_cast<std::size_t>((first + k) % room)];
    ring = std::move(larger);
    first = 0;
  }
  const int size = static_cast<int>(ring.size());
  ring[static_cast<std::size_t>((first + length) % size)] = pixel;
  ++length;
  ++queued;
  if (length > high_water) {
    high_water = length;
    cycles_at_length.resize(static_cast<std::size_t>(high_water) + 1);
  }
}

TreePixel DistributionTree::Queue::pop(std::int64_t cycle) {
  countLength(cycle);
  const TreePixel pixel = ring[static_cast<std::size_t>(first)];
  first = first + 1 == static_cast<int>(ring.size()) ? 0 : first + 1;
  --length;
  return pixel;
}

DistributionTree::DistributionTree(int tilers, int memories, TreeInlets& inlets, TreeOutlets& outlets,
                                   QueueDiscipline discipline, int queue_depth)
    : shape_(treeShape(tilers, memories)),
      inlets_(inlets),
      outlets_(outlets),
      discipline_(discipline),
      queue_depth_(queue_depth),
      levels_(shape_.levels.size()),
      ready_(static_cast<std::size_t>(tilers)),
      latest_(static_cast<std::size_t>(tilers) * static_cast<std::size_t>(memories)) {
  assert(queue_depth >= 0 && queue_depth <= kMaximumQueueDepth);
  outlet_.last_busy.fill(-1);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    levels_[l].inputs.last_busy.fill(-1);
    levels_[l].buffers.last_busy.fill(-1);
    if (shape_.levels[l].kind == CellKind::kSplit) continue;
    levels_[l].queues.resize(static_cast<std::size_t>(shape_.levels[l].outputs()));
    for (Queue& queue : levels_[l].queues) queue.cycles_at_length.resize(1);
  }
  for (int tiler = 0; tiler < tilers; ++tiler)
    ready_[static_cast<std::size_t>(tiler)] = inlets_.readyCycle(tiler);
  earliest_ready_ = *std::min_element(ready_.begin(), ready_.end());
}

void DistributionTree::wake(int tiler) {
  std::int64_t& ready = ready_[static_cast<std::size_t>(tiler)];
  if (ready == TreeInlets::kNoCycle) ready = inlets_.readyCycle(tiler);
  earliest_ready_ = std::min(earliest_ready_, ready);
}

std::int64_t DistributionTree::nextCycle(std::int64_t cycle) const {
  return inside_ > 0 ? cycle : std::max(cycle, earliest_ready_);
}

void DistributionTree::run(std::int64_t cycle) {
  leaveTree(cycle);
  for (std::size_t l = levels_.size(); l-- > 0;) {
    if (shape_.levels[l].kind == CellKind::kSplit) {
      splitLevel(l, cycle);
    } else {
      switchLevel(l, cycle);
    }
  }
  if (earliest_ready_ <= cycle) enterTree(cycle);
}

void DistributionTree::leaveTree(std::int64_t cycle) {
  for (std::uint64_t left = outlet_.occupied; left != 0; left &= left - 1) {
    const int memory = std::countr_zero(left);
    const auto at = static_cast<std::size_t>(memory);
    const TreePixel& pixel = outlet_.pixel[at];
    if (!outlets_.offer(memory, pixel, cycle)) {
      ++outlet_.statistics[at].blocked;
      continue;
    }
    outlet_.leave(memory, cycle);
    --inside_;
    ++left_;
    std::uint32_t& latest = latest_[at * static_cast<std::size_t>(shape_.tilers) + pixel.tiler];
    if (pixel.sequence < latest) ++overtaken_;
    latest = std::max(latest, pixel.sequence);
  }
}

void DistributionTree::splitLevel(std::size_t level, std::int64_t cycle) {
  const TreeLevel& shape = shape_.levels[level];
  Registers &t = levels_[level].inputs, &b = levels_[level].buffers, &down = entrance(level + 1);
  for (std::uint64_t left = t.occupied | b.occupied; left != 0; left &= left - 1) {
    const int cell = std::countr_zero(left);
    const auto at = static_cast<std::size_t>(cell);
    if (b.holds(cell)) {
      const int bit = b.pixel[at].memory >> shape.routing_shift & 1;
      const int to = shape.leads_to[2 * at + static_cast<std::size_t>(bit)];
      if (down.holds(to)) {
        ++b.statistics[at].blocked;
      } else {
        down.fill(to, b.pixel[at], cycle);
        b.leave(cell, cycle);
      }
    }
    if (!t.holds(cell)) continue;
    if (b.holds(cell)) {
      ++t.statistics[at].blocked;
    } else {
      b.fill(cell, t.pixel[at], cycle);
      t.leave(cell, cycle);
    }
  }
}

void DistributionTree::switchLevel(std::size_t level, std::int64_t cycle) {
  const TreeLevel& shape = shape_.levels[level];
  Level& state = levels_[level];
  const bool merge = shape.kind == CellKind::kMerge;
  Registers &up = state.inputs, &down = entrance(level + 1);
  // Cells by the bit of their left input: those with a pixel at an input or in a queue.
  constexpr std::uint64_t kEven = 0x5555555555555555;
  std::uint64_t active = up.occupied | up.occupied >> 1;
  if (!merge) active |= state.queueing | state.queueing >> 1;
  active &= kEven;
  if (merge) {
    for (std::uint64_t left = state.queueing; left != 0; left &= left - 1)
      active |= std::uint64_t{1} << 2 * std::countr_zero(left);
  }
  for (; active != 0; active &= active - 1) {
    const int left = std::countr_zero(active), right = left + 1;
    const bool has_left = up.holds(left), has_right = up.holds(right);
    if (merge) {
      serveOutput(level, left / 2, down, has_left ? left : -1, has_right ? right : -1, cycle);
      continue;
    }
    const int left_bit =
        has_left ? up.pixel[static_cast<std::size_t>(left)].memory >> shape.routing_shift & 1 : -1;
    const int right_bit =
        has_right ? up.pixel[static_cast<std::size_t>(right)].memory >> shape.routing_shift & 1 : -1;
    for (int bit = 0; bit < 2; ++bit) {
      const int output = left + bit;
      const bool queueing = (state.queueing >> output & 1) != 0;
      if (left_bit == bit || right_bit == bit || queueing)
        serveOutput(level, output, down, left_bit == bit ? left : -1, right_bit == bit ? right : -1, cycle);
    }
  }
}

// `left` and `right`: the inputs whose pixel wants this output, or -1.
void DistributionTree::serveOutput(std::size_t level, int output, Registers& down, int left, int right,
                                   std::int64_t cycle) {
  Level& state = levels_[level];
  Registers& up = state.inputs;
  Queue& queue = state.queues[static_cast<std::size_t>(output)];
  const int to = shape_.levels[level].leads_to[static_cast<std::size_t>(output)];
  const bool free = !down.holds(to);
  const int first = left >= 0 ? left : right;  // -1 if neither
  const auto lose = [&up](int input) { ++up.statistics[static_cast<std::size_t>(input)].lost; };

  if (free && queue.length > 0 && (first < 0 || discipline_ == QueueDiscipline::kQueueFirst)) {
    down.fill(to, queue.pop(cycle), cycle);
    if (queue.length == 0) state.queueing &= ~(std::uint64_t{1} << output);
    if (left >= 0) lose(left);
    if (right >= 0) lose(right);
    return;
  }
  if (first < 0) return;
  const TreePixel& pixel = up.pixel[static_cast<std::size_t>(first)];
  if (free) {
    down.fill(to, pixel, cycle);
    ++queue.direct;
  } else if (queue.length < queue_depth_) {
    queue.push(pixel, cycle);
    state.queueing |= std::uint64_t{1} << output;
  } else {
    if (left >= 0) ++up.statistics[static_cast<std::size_t>(left)].blocked;
    if (right >= 0) ++up.statistics[static_cast<std::size_t>(right)].blocked;
    return;
  }
  up.leave(first, cycle);
  if (left >= 0 && right >= 0) lose(right);
}

void DistributionTree::enterTree(std::int64_t cycle) {
  Registers& top = entrance(0);
  earliest_ready_ = TreeInlets::kNoCycle;
  for (int tiler = 0; tiler < shape_.tilers; ++tiler) {
    std::int64_t& ready = ready_[static_cast<std::size_t>(tiler)];
    const int to = shape_.tiler_leads_to[static_cast<std::size_t>(tiler)];
    if (ready <= cycle && !top.holds(to)) {
      top.fill(to, inlets_.take(tiler, cycle), cycle);
      ++inside_;
      ++entered_;
      ready = inlets_.readyCycle(tiler);
    }
    earliest_ready_ = std::min(earliest_ready_, ready);
  }
}

TreeStatistics DistributionTree::statistics(std::int64_t cycles) const {
  // A register that is empty now has starved since it was last busy.
  const auto up_to = [cycles](const Registers& registers, int count) {
    std::vector<RegisterStatistics> result(registers.statistics.begin(),
                                           registers.statistics.begin() + count);
    for (int k = 0; k < count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!registers.holds(k)) result[at].starved += cycles - 1 - registers.last_busy[at];
    }
    return result;
  };
  TreeStatistics result{.cycles = cycles,
                        .levels = {},
                        .outlets = up_to(outlet_, shape_.memories),
                        .entered = entered_,
                        .left = left_,
                        .overtaken = overtaken_};
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const TreeLevel& shape = shape_.levels[l];
    TreeLevelStatistics level{
        .kind = shape.kind, .inputs = up_to(levels_[l].inputs, shape.inputs()), .buffers = {}, .queues = {}};
    if (shape.kind == CellKind::kSplit) level.buffers = up_to(levels_[l].buffers, shape.cells);
    for (const Queue& queue : levels_[l].queues) {
      level.queues.push_back({.direct = queue.direct,
                              .queued = queue.queued,
                              .high_water = queue.high_water,
                              .cycles_at_length = queue.cycles_at_length});
      level.queues.back().cycles_at_length[static_cast<std::size_t>(queue.length)] += cycles - queue.changed;
    }
    result.levels.push_back(level);
  }
  return result;
}

}  // namespace deltaz::ars
