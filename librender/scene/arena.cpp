#include "librender/scene/arena.h"

#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <tbb/info.h>
#include <tbb/task_arena.h>

namespace deltaz {

Result<Picture> drawOnThreads(int threads, const std::function<Result<Picture>()>& draw) {
  try {
    const int most = tbb::info::default_concurrency();
    tbb::task_arena arena(threads > 0 ? std::min(threads, most) : most);
    std::optional<Result<Picture>> result;
    arena.execute([&] { result.emplace(draw()); });
    return std::move(*result);
  } catch (const std::bad_alloc&) {
    return accessError("picture", "cannot be drawn", "there is not enough memory", "Draw a smaller one");
  } catch (const std::exception& exception) {
    return internalError("picture", exception.what());
  }
}

}  // namespace deltaz
