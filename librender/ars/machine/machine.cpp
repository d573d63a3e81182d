#include "librender/ars/machine/machine.h"

#include <algorithm>

#include "librender/ars/machine/functional_memory.h"
#include "librender/ars/machine/hardware_software_interface.h"
#include "librender/ars/words/triangle_words.h"

namespace deltaz::ars {

namespace {

TilerPipelineTiming timingOf(const MachineConfiguration& configuration) {
  TilerPipelineTiming timing;
  timing.transfer = Picoseconds{kTriangleWordCount} * configuration.word_transfer * kNanosecond;
  timing.transfer_fifo = configuration.transfer_fifo;
  timing.set_up_fifo = configuration.set_up_fifo;
  timing.output_fifo = configuration.output_fifo;
  timing.clock_percent = configuration.tiler_clock_percent;
  return timing;
}

// The tilers' output FIFOs, as the tree sees them.
class TilerBank final : public TreeInlets {
 public:
  explicit TilerBank(std::vector<TilerPipeline>& tilers) : tilers_(tilers) {}

  std::int64_t readyCycle(int tiler) override {
    const Picoseconds ready = tilers_[static_cast<std::size_t>(tiler)].ready();
    return ready == kNever ? kNoCycle : treeCycleAt(ready);
  }
  TreePixel take(int tiler, std::int64_t cycle) override {
    changed_ = true;
    return tilers_[static_cast<std::size_t>(tiler)].take(cycle * kTreeCycle);
  }
  // Whether a pixel was taken since the last time this was asked.
  bool changed() { return std::exchange(changed_, false); }

 private:
  std::vector<TilerPipeline>& tilers_;
  bool changed_ = false;
};

class MemoryBank final : public TreeOutlets {
 public:
  explicit MemoryBank(std::vector<MemoryChannel>& channels) : channels_(channels) {}

  bool offer(int memory, const TreePixel& pixel, std::int64_t cycle) override {
    MemoryChannel& channel = channels_[static_cast<std::size_t>(memory)];
    const Picoseconds now = cycle * kTreeCycle;
    if (!channel.hasRoom(now)) return false;
    channel.accept(pixel.address, pixel.word, pixel.background, now);
    return true;
  }

 private:
  std::vector<MemoryChannel>& channels_;
};

// The host: fills buffers and gives them to tilers as both become free.
class Host {
 public:
  Host(const MachineConfiguration& configuration, std::vector<TilerPipeline>& tilers)
      : interface_(configuration.tilers, bufferCount(configuration)),
        buffer_triangles_(static_cast<std::size_t>(configuration.buffer_triangles)),
        triangle_time_(configuration.host_triangle * kNanosecond),
        tilers_(tilers) {}

  Status takeOutOfService(int tiler) {
    if (interface_.tiler(tiler) == TilerState::kUnavailable) return Success{};  // said twice
    return interface_.takeOutOfService(tiler);
  }

  // Triangles up to `end` may be sent, from `now` on.
  void release(std::size_t end, Picoseconds now) {
    end_ = end;
    fillNext(now);
    findNextEvent();
  }

  Picoseconds nextEvent() const { return next_event_; }
  void findNextEvent() {
    next_event_ = filling_ ? filled_at_ : kNever;
    for (std::size_t t = 0; t < tilers_.size(); ++t)
      if (interface_.tiler(static_cast<int>(t)) == TilerState::kBusy)
        next_event_ = std::min(next_event_, tilers_[t].transferred());
  }

  // Does what is due by `now`; `tree` hears of tilers that have something new to do.
  Status run(Picoseconds now, DistributionTree& tree) {
    while (next_event_ <= now) {
      const Picoseconds time = next_event_;
      if (filling_ && filled_at_ == time) {
        DELTAZ_TRY(interface_.finishFilling(*filling_, filling_begin_, begin_));
        filling_.reset();
      }
      for (std::size_t t = 0; t < tilers_.size(); ++t) {
        const int tiler = static_cast<int>(t);
        if (interface_.tiler(tiler) == TilerState::kBusy && tilers_[t].transferred() == time)
          DELTAZ_TRY(interface_.finishTransfer(tiler));
      }
      fillNext(time);
      while (const auto transfer = interface_.beginTransfer()) {
        tilers_[static_cast<std::size_t>(transfer->tiler)].assign(transfer->begin, transfer->end, time);
        tree.wake(transfer->tiler);
      }
      findNextEvent();
    }
    return Success{};
  }

  bool idle() const { return begin_ == end_ && interface_.idle(); }

 private:
  void fillNext(Picoseconds now) {
    if (filling_ || begin_ == end_) return;
    filling_ = interface_.beginFilling();
    if (!filling_) return;
    filling_begin_ = begin_;
    begin_ = std::min(end_, begin_ + buffer_triangles_);
    filled_at_ = now + static_cast<Picoseconds>(begin_ - filling_begin_) * triangle_time_;
  }

  HardwareSoftwareInterface interface_;
  std::size_t buffer_triangles_;
  Picoseconds triangle_time_;
  std::vector<TilerPipeline>& tilers_;
  std::size_t begin_ = 0, end_ = 0;  // triangles not in a buffer yet
  std::optional<int> filling_;
  std::size_t filling_begin_ = 0;
  Picoseconds filled_at_ = 0, next_event_ = kNever;
};

// Ends of the parts of the stream that are to be in memory one after the other.
std::vector<std::size_t> partEnds(const PixelSource& source, bool barriers) {
  std::vector<std::size_t> ends;
  if (barriers) {
    for (const std::size_t barrier : source.barriers())
      if (barrier > (ends.empty() ? 0 : ends.back()) && barrier < source.triangles()) ends.push_back(barrier);
  }
  ends.push_back(source.triangles());
  return ends;
}

}  // namespace

Machine::Machine(const MachineConfiguration& configuration)
    : configuration_(configuration), map_(configuration.memories, configuration.mode) {
  reset();
}

Result<Machine> Machine::make(const MachineConfiguration& configuration) {
  DELTAZ_TRY(validate(configuration));
  return Machine(configuration);
}

void Machine::reset() {
  words_.assign(FunctionalMemory::kWords + FunctionalMemory::kPadding, 0);
}

MemoryModule Machine::module() {
  return MemoryModule(words_, configuration_.ties, configuration_.depth_mantissa_bits);
}

Result<PassStatistics> Machine::runTimed(const PixelSource& source) {
  const CycleLengths lengths = cycleLengths(configuration_.memory_design);
  const TilerPipelineTiming timing = timingOf(configuration_);
  std::vector<TilerPipeline> tilers;
  tilers.reserve(static_cast<std::size_t>(configuration_.tilers));
  for (int tiler = 0; tiler < configuration_.tilers; ++tiler)
    tilers.emplace_back(tiler, source, map_, timing);
  std::vector<MemoryModule> modules(static_cast<std::size_t>(map_.memories()), module());
  std::vector<MemoryChannel> channels;
  channels.reserve(modules.size());
  for (MemoryModule& module : modules) channels.emplace_back(module, lengths, configuration_.memory_fifo);
  TilerBank inlets(tilers);
  MemoryBank outlets(channels);
  DistributionTree tree(configuration_.tilers, configuration_.memories, inlets, outlets,
                        configuration_.discipline, configuration_.queue_depth);
  Host host(configuration_, tilers);
  for (const int tiler : configuration_.unavailable) DELTAZ_TRY(host.takeOutOfService(tiler));

  Picoseconds now = 0;
  std::int64_t cycle = 0;
  const std::vector<std::size_t> ends = partEnds(source, configuration_.barriers);
  for (const std::size_t end : ends) {
    cycle = std::max(cycle, treeCycleAt(now));
    host.release(end, now);
    while (true) {
      const std::int64_t tree_cycle = tree.nextCycle(cycle);
      if (host.nextEvent() != kNever &&
          (tree_cycle == TreeInlets::kNoCycle || host.nextEvent() <= tree_cycle * kTreeCycle)) {
        DELTAZ_TRY(host.run(host.nextEvent(), tree));
        continue;
      }
      if (tree_cycle == TreeInlets::kNoCycle) break;
      tree.run(tree_cycle);
      cycle = tree_cycle + 1;
      if (inlets.changed()) host.findNextEvent();
    }
    for (const TilerPipeline& tiler : tilers) {
      if (!tiler.finished() || !host.idle()) return internalError("machine", "stopped before all was drawn");
      now = std::max(now, tiler.idleAt());
    }
    for (const MemoryChannel& channel : channels) now = std::max(now, channel.idleAt());
  }

  PassStatistics statistics;
  statistics.duration = now;
  statistics.reading = Picoseconds{map_.wordsPerMemory()} * lengths.of(MemoryCycle::kRead) * kNanosecond;
  statistics.barriers = static_cast<int>(ends.size()) - 1;
  for (const TilerPipeline& tiler : tilers) statistics.tilers.push_back(tiler.statistics(now));
  statistics.tree = tree.statistics(std::max(cycle, treeCycleAt(now)));
  for (std::size_t m = 0; m < modules.size(); ++m)
    statistics.memories.push_back({.counts = modules[m].counts(), .channel = channels[m].statistics(now)});
  DELTAZ_TRY(verifyConservation(statistics, lengths));
  return statistics;
}

MemoryCounts Machine::runFunctional(const PixelSource& source) {
  FunctionalMemory memory(words_, configuration_.ties, configuration_.depth_mantissa_bits);
  for (std::size_t triangle = 0; triangle < source.triangles(); ++triangle) source.write(triangle, memory);
  return memory.counts();
}

std::vector<std::uint8_t> Machine::readPicture() {
  MemoryModule memory = module();
  std::vector<std::uint8_t> picture;
  picture.reserve(FunctionalMemory::kWords);
  for (std::uint32_t place = 0; place < FunctionalMemory::kWords; ++place)
    picture.push_back(memory.read(place));
  return picture;
}

std::uint8_t Machine::color(int i, int j) const {
  return static_cast<std::uint8_t>(words_[placeOf(i, j)]);
}

std::uint32_t Machine::depth(int i, int j) const {
  return static_cast<std::uint32_t>((words_[placeOf(i, j)] & ~kInitFlag) >> kColorBits);
}

bool Machine::written(int i, int j) const {
  return (words_[placeOf(i, j)] & kInitFlag) != 0;
}

}  // namespace deltaz::ars
