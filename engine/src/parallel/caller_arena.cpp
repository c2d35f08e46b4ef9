#include "parallel/caller_arena.h"

#include <tbb/task_arena.h>

namespace tessera { inline namespace abi_0_1 {

int arena_threads() { return tbb::this_task_arena::max_concurrency(); }

void in_own_arena(int threads, FunctionRef<void()> work) {
  tbb::task_arena arena(threads);
  arena.execute([&] { work(); });
}

}}  // namespace tessera::abi_0_1
