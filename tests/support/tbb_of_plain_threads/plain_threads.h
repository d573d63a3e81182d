// What this project uses of oneTBB, made of std::thread, for builds with the thread sanitizer: it sees no
// further than code that was compiled with it, so that where TBB's library starts and awaits work looks like
// a race to it. Slow, fair and simple; put before TBB's own headers when DELTAZ_SANITIZE holds "thread".
//
// Work is shared out among as many threads as the arena has, whatever the machine has, so that races show on
// small machines. Parallel loops within parallel loops run on the thread that meets them.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {

namespace info {
inline int default_concurrency() {
  return 4;
}
}  // namespace info

namespace plain {

// Of the thread that asks.
struct Place {
  int concurrency = info::default_concurrency(), index = 0;
  bool in_loop = false;
};

inline Place& place() {
  thread_local Place here;
  return here;
}

// Back to what it was, however the scope is left.
class Moved {
 public:
  explicit Moved(Place to) : before_(std::exchange(place(), to)) {}
  ~Moved() { place() = before_; }
  Moved(const Moved&) = delete;
  Moved& operator=(const Moved&) = delete;

 private:
  Place before_;
};

}  // namespace plain

class task_arena {
 public:
  static constexpr int automatic = -1;

  explicit task_arena(int concurrency = automatic)
      : concurrency_(concurrency == automatic ? info::default_concurrency() : std::max(1, concurrency)) {}

  int max_concurrency() const { return concurrency_; }

  template <class Function>
  auto execute(Function&& function) {
    const plain::Moved moved({.concurrency = concurrency_});
    return std::forward<Function>(function)();
  }

 private:
  int concurrency_;
};

namespace this_task_arena {
inline int current_thread_index() {
  return plain::place().index;
}
inline int max_concurrency() {
  return plain::place().concurrency;
}
}  // namespace this_task_arena

template <class Value>
class blocked_range {
 public:
  blocked_range(Value begin, Value end, std::size_t = 1) : begin_(begin), end_(end) {}

  Value begin() const { return begin_; }
  Value end() const { return end_; }

 private:
  Value begin_, end_;
};

// The first exception that a body throws reaches the caller.
template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  if (!(range.begin() < range.end())) return;
  const int threads = plain::place().concurrency;
  if (plain::place().in_loop || threads == 1) {
    body(range);
    return;
  }
  const Value step = std::max<Value>(1, (range.end() - range.begin()) / static_cast<Value>(4 * threads));
  std::atomic<Value> next{range.begin()};
  std::exception_ptr thrown;
  std::mutex of_thrown;
  const auto work = [&](int index) {
    const plain::Moved moved({.concurrency = threads, .index = index, .in_loop = true});
    try {
      // Relaxed: nothing may rely on one piece of work coming after another.
      for (Value first; (first = next.fetch_add(step, std::memory_order_relaxed)) < range.end();)
        body(blocked_range<Value>(first, std::min<Value>(range.end(), first + step)));
    } catch (...) {
      const std::lock_guard lock(of_thrown);
      if (!thrown) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (int index = 1; index < threads; ++index) others.emplace_back(work, index);
  work(0);
  for (std::thread& other : others) other.join();
  if (thrown) std::rethrow_exception(thrown);
}

template <class Value, class End, class Body>
void parallel_for(Value begin, End end, const Body& body) {
  parallel_for(blocked_range<Value>(begin, static_cast<Value>(end)), [&](const blocked_range<Value>& range) {
    for (Value n = range.begin(); n < range.end(); ++n) body(n);
  });
}

template <class Value>
class enumerable_thread_specific {
 public:
  explicit enumerable_thread_specific(std::function<Value()> make) : make_(std::move(make)) {}

  Value& local() {
    const std::lock_guard lock(mutex_);
    Value*& own = of_thread_[std::this_thread::get_id()];
    if (own == nullptr) own = &values_.emplace_back(make_());
    return *own;
  }

  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }

 private:
  std::function<Value()> make_;
  std::deque<Value> values_;
  std::map<std::thread::id, Value*> of_thread_;
  std::mutex mutex_;
};

}  // namespace tbb

namespace oneapi {
namespace tbb = ::tbb;
}
