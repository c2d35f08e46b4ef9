#include "parallel/tbb_loop.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#ifdef TESSERA_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace tessera::inline abi_0_1 {
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
  Order order;
  order.call_begins();
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pieces, 1), [&](const tbb::blocked_range<std::size_t>& range) {
    order.piece_begins();
    for (std::size_t piece = range.begin(); piece != range.end(); ++piece) body(piece);
    order.piece_ends();
  });
  order.call_ends();
}

}  // namespace tessera::inline abi_0_1
