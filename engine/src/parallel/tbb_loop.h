#pragma once
// The plain loop over threads. A file of its own lets the thread sanitizer exclude oneTBB's templates: it sees only
// half of oneTBB's synchronisation, because the other half is in a library that is not instrumented.

#include <cstddef>
#include <memory>

#include "base/function_ref.h"
#include "base/internal_export.h"

namespace tessera { inline namespace abi_0_1 {

/// Calls body(piece) once for each piece in [0, pieces), in the caller's arena, in any order. Exceptions of the body
/// propagate. All pieces run, even if the caller's own task group is cancelled meanwhile.
void tbb_loop(std::size_t pieces, FunctionRef<void(std::size_t)> body);

/// Runs calls whose tasks must not be skipped if the caller's own task group is cancelled meanwhile.
///
/// Task groups that a call makes and keeps, as Embree's scenes do, refer to that of this object: it must outlive them.
/// Calls must not throw. Threads: any number of calls. Errors: the constructor throws std::bad_alloc.
class TESSERA_INTERNAL_EXPORT ApartTasks {
 public:
  ApartTasks();
  ApartTasks(const ApartTasks&) = delete;
  ApartTasks& operator=(const ApartTasks&) = delete;
  ~ApartTasks();

  void run(FunctionRef<void()> call);

 private:
  struct Group;
  std::unique_ptr<Group> group_;
};

/// Calls work() in an arena of `threads` threads, at least 1, the caller's among them. Throws std::bad_alloc. Arenas
/// are kept for later calls.
void on_threads(int threads, FunctionRef<void()> work);

/// Calls a function of the user's. If it starts tasks and waits for them, this thread runs none of ours meanwhile.
TESSERA_INTERNAL_EXPORT void without_other_tasks(FunctionRef<void()> call);

}}  // namespace tessera::abi_0_1
