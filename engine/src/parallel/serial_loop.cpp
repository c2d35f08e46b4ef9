// Loops on the calling thread, where there is no oneTBB: in the place of tbb_loop.cpp and caller_arena.cpp.

#include "parallel/caller_arena.h"
#include "parallel/tbb_loop.h"

#ifdef __wasm__
/// Lets the host set tsr_run.cancel: no other thread can.
extern "C" [[clang::import_module("tessera"), clang::import_name("poll")]] void tessera_host_poll();
#else
static void tessera_host_poll() {}
#endif

namespace tessera { inline namespace abi_0_1 {

void tbb_loop(std::size_t pieces, FunctionRef<void(std::size_t)> body) {
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    tessera_host_poll();
    body(piece);
  }
}

struct ApartTasks::Group {};
ApartTasks::ApartTasks() = default;
ApartTasks::~ApartTasks() = default;
void ApartTasks::run(FunctionRef<void()> call) { call(); }

void on_threads(int, FunctionRef<void()> work) { work(); }
void without_other_tasks(FunctionRef<void()> call) { call(); }
int arena_threads() { return 1; }
void in_own_arena(int, FunctionRef<void()> work) { work(); }

}}  // namespace tessera::abi_0_1
