#include "parallel/tbb_loop.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <map>
#include <mutex>

#ifdef TESSERA_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Tells the thread sanitizer what oneTBB guarantees: the call happens before its pieces, and these before its return.
/// Pieces are not ordered among themselves, so races between them are found.
class Order {
 public:
#ifdef TESSERA_THREAD_SANITIZER
  void call_begins() { __tsan_release(&begun_); }
  void piece_begins() { __tsan_acquire(&begun_); }
  void piece_ends() { __tsan_release(&ended_); }
  void call_ends() { __tsan_acquire(&ended_); }

 private:
  char begun_ = 0, ended_ = 0;  // only their addresses matter
#else
  void call_begins() {}
  void piece_begins() {}
  void piece_ends() {}
  void call_ends() {}
#endif
};

}  // namespace

void tbb_loop(std::size_t pieces, FunctionRef<void(std::size_t)> body) {
  if (tbb::this_task_arena::max_concurrency() == 1) {  // tasks would take longer than small pieces do
    for (std::size_t piece = 0; piece < pieces; ++piece) body(piece);
    return;
  }
  Order order;
  order.call_begins();
  // oneTBB would skip pieces without a word once a task group around this call is cancelled. Its threads take the
  // floating-point settings of this one.
  using Context = tbb::task_group_context;
  Context context(Context::isolated, Context::default_traits | Context::fp_settings);
  const auto run = [&](const tbb::blocked_range<std::size_t>& range) {
    order.piece_begins();
    for (std::size_t piece = range.begin(); piece != range.end(); ++piece) body(piece);
    order.piece_ends();
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pieces, 1), run, context);
  order.call_ends();
}

struct ApartTasks::Group {
  tbb::task_group_context context{tbb::task_group_context::isolated};
};

ApartTasks::ApartTasks() : group_(std::make_unique<Group>()) {}
ApartTasks::~ApartTasks() = default;

void ApartTasks::run(FunctionRef<void()> call) {
  const auto run = [&](const tbb::blocked_range<std::size_t>&) { call(); };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, 1, 1), run, group_->context);
}

void on_threads(int threads, FunctionRef<void()> work) {
  static std::mutex mutex;
  static std::map<int, tbb::task_arena>& arenas = *new std::map<int, tbb::task_arena>;  // oneTBB may end before them
  tbb::task_arena* arena = nullptr;
  {
    const std::lock_guard lock(mutex);
    arena = &arenas.try_emplace(threads, threads).first->second;
  }
  arena->execute([&] { work(); });
}

void without_other_tasks(FunctionRef<void()> call) {
  tbb::this_task_arena::isolate([&] { call(); });
}

}}  // namespace tessera::abi_0_1
