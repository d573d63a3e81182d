#include "libdb/build/worker_pool.h"

#include <algorithm>
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace deltaz {

struct WorkerPool::Arena {
  tbb::task_arena arena;
};

// More threads than the machine has would only wait for each other.
WorkerPool::WorkerPool(int threads)
    : arena_(new Arena{tbb::task_arena(threads > 0 ? std::min(threads, tbb::info::default_concurrency())
                                                   : tbb::task_arena::automatic)}) {}

WorkerPool::~WorkerPool() = default;

void WorkerPool::forEach(std::size_t count, const std::function<void(std::size_t)>& work) {
  arena_->arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
                      });
  });
}

}  // namespace deltaz
