// The distribution tree, cycle by cycle: pixels from the tilers find their memories through A-cells and
// B-cells (report 4.3, Tables 9 and 10). A cycle is 100 ns; at most one pixel enters a cell's output in one.
//
// Between two cells stands one register, which is the upper one's TAL or TAR and the lower one's upper
// buffer, or T if that is an A-cell, which has one more behind it, B. Cells are served from the memories
// upwards, so a pixel that leaves makes room for the next within the cycle, as Table 9 does, and the tree
// carries one pixel a cycle and output.
//
// A B-cell's output, left or right alike:
//   free      upper left pixel, else upper right pixel, else the queue's first
//   occupied  upper left pixel into the queue, else upper right pixel, if the queue has room
// That is Table 10, and as it asks the queue last, pixels overtake others of the same tiler. The queue-first
// discipline, ours, asks it first; then none does.
//
// Every register's time is counted: busy in the cycles in which its pixel goes on, blocked where that cannot
// because what lies below is full, lost where the other input or the queue was served, starved where it is
// empty.
//
// Cost: some ten nanoseconds for a cell that has something to do. Thread-safety: one thread a tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "librender/ars/distribution/memory_map.h"
#include "librender/ars/distribution/tree_shape.h"

namespace deltaz::ars {

inline constexpr int kQueueDepth = 256;  // of each output of a B-cell (report 4.3.4.2)
inline constexpr int kMaximumQueueDepth = 1 << 16;

enum class QueueDiscipline : std::uint8_t { kInputsFirst, kQueueFirst };
std::string_view queueDisciplineName(QueueDiscipline discipline);  // "strict", "queue-first"
std::optional<QueueDiscipline> queueDisciplineNamed(std::string_view name);

// A pixel packet on its way: what the memory will write, and where.
struct TreePixel {
  std::uint64_t word = 0;      // memoryWord of depth and colour
  std::uint32_t address = 0;   // 18 bits, i above j
  std::uint32_t sequence = 0;  // counts up within a tiler, from 1
  std::uint8_t memory = 0, tiler = 0;
  bool background = false;
};

// What feeds the tree.
class TreeInlets {
 public:
  static constexpr std::int64_t kNoCycle = INT64_MAX;
  TreeInlets() = default;
  TreeInlets(const TreeInlets&) = delete;
  TreeInlets& operator=(const TreeInlets&) = delete;
  virtual ~TreeInlets() = default;
  // The first cycle in which the tiler's next pixel can be taken; kNoCycle if none is known of. Asked after
  // every take, and by DistributionTree::wake.
  virtual std::int64_t readyCycle(int tiler) = 0;
  virtual TreePixel take(int tiler, std::int64_t cycle) = 0;
};

// What the tree feeds.
class TreeOutlets {
 public:
  TreeOutlets() = default;
  TreeOutlets(const TreeOutlets&) = delete;
  TreeOutlets& operator=(const TreeOutlets&) = delete;
  virtual ~TreeOutlets() = default;
  // False: no room in this cycle.
  virtual bool offer(int memory, const TreePixel& pixel, std::int64_t cycle) = 0;
};

// Cycles of one register; their sum is the number of cycles run.
struct RegisterStatistics {
  std::int64_t busy = 0, starved = 0, blocked = 0, lost = 0;
  std::int64_t sum() const { return busy + starved + blocked + lost; }
};

// One output of a B-cell and its queue.
struct QueueStatistics {
  std::int64_t direct = 0, queued = 0;  // pixels that went to the output at once, and through the queue
  int high_water = 0;
  std::vector<std::int64_t> cycles_at_length;  // 0 .. high_water
};

struct TreeLevelStatistics {
  CellKind kind = CellKind::kSwitch;
  std::vector<RegisterStatistics> inputs;   // by input; of A-cells buffer T
  std::vector<RegisterStatistics> buffers;  // A-cells: buffer B
  std::vector<QueueStatistics> queues;      // B-cells, by output
};

struct TreeStatistics {
  std::int64_t cycles = 0;
  std::vector<TreeLevelStatistics> levels;
  std::vector<RegisterStatistics> outlets;  // by memory: the register before the memory's FIFO
  std::int64_t entered = 0, left = 0;       // pixels
  std::int64_t overtaken = 0;  // pixels that reached their memory after a later one of their tiler

  int longestQueue() const;
};

class DistributionTree {
 public:
  // Inlets and outlets outlive the tree. queue_depth: 0..kMaximumQueueDepth.
  DistributionTree(int tilers, int memories, TreeInlets& inlets, TreeOutlets& outlets,
                   QueueDiscipline discipline = QueueDiscipline::kInputsFirst, int queue_depth = kQueueDepth);

  // Asks the inlets anew when a tiler that knew of no pixel knows of one.
  void wake(int tiler);
  // Runs one cycle; cycles come in order, and those left out must be ones in which nothing could happen.
  void run(std::int64_t cycle);
  // The first cycle from `cycle` on in which something can happen; kNoCycle if nothing ever will.
  std::int64_t nextCycle(std::int64_t cycle) const;
  bool empty() const { return inside_ == 0; }

  // After cycles 0 .. cycles - 1.
  TreeStatistics statistics(std::int64_t cycles) const;
  int memories() const { return shape_.memories; }

 private:
  static constexpr int kWires = 64;

  // Registers that hold a pixel each, and what became of them.
  struct Registers {
    std::uint64_t occupied = 0;
    std::array<TreePixel, kWires> pixel{};
    std::array<RegisterStatistics, kWires> statistics{};
    std::array<std::int64_t, kWires> last_busy{};  // cycle, -1 before the first

    bool holds(int k) const { return (occupied >> k & 1) != 0; }
    void fill(int k, const TreePixel& what, std::int64_t cycle);
    void leave(int k, std::int64_t cycle);
  };
  // First in, first out; room grows up to the depth of the queues.
  struct Queue {
    std::vector<TreePixel> ring;
    int first = 0, length = 0, high_water = 0;
    std::int64_t direct = 0, queued = 0, changed = 0;
    std::vector<std::int64_t> cycles_at_length;

    void push(const TreePixel& pixel, std::int64_t cycle);
    TreePixel pop(std::int64_t cycle);
    void countLength(std::int64_t cycle);
  };
  struct Level {
    Registers inputs;            // of A-cells: buffer T
    Registers buffers;           // A-cells: buffer B
    std::uint64_t queueing = 0;  // outputs whose queue is not empty
    std::vector<Queue> queues;
  };

  // What the outputs of the level above `level` fill.
  Registers& entrance(std::size_t level) { return level < levels_.size() ? levels_[level].inputs : outlet_; }
  void leaveTree(std::int64_t cycle);
  void splitLevel(std::size_t level, std::int64_t cycle);
  void switchLevel(std::size_t level, std::int64_t cycle);
  void serveOutput(std::size_t level, int output, Registers& down, int left, int right, std::int64_t cycle);
  void enterTree(std::int64_t cycle);

  TreeShape shape_;
  TreeInlets& inlets_;
  TreeOutlets& outlets_;
  QueueDiscipline discipline_;
  int queue_depth_;
  std::vector<Level> levels_;
  Registers outlet_;
  std::vector<std::int64_t> ready_;  // by tiler: TreeInlets::readyCycle
  std::int64_t earliest_ready_ = 0;
  std::int64_t inside_ = 0, entered_ = 0, left_ = 0, overtaken_ = 0;
  std::vector<std::uint32_t> latest_;  // by memory and tiler: greatest sequence number arrived
};

}  // namespace deltaz::ars
