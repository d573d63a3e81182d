// Runs independent pieces of work on several threads. Thread-safety: one forEach at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace deltaz {

class WorkerPool {
 public:
  // `threads` at most as many as the machine has; 0: as many.
  explicit WorkerPool(int threads);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // Calls work(i) once for every i below `count`; the order must not matter. The first exception comes out.
  void forEach(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace deltaz
