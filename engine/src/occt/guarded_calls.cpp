#include "occt/guarded_calls.h"

#include <opencascade/Standard_OutOfMemory.hxx>
#include <opencascade/Standard_Type.hxx>

#include <limits>
#include <string>
#include <utility>

#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {

std::mutex& approximation_mutex() {
  static std::mutex mutex;
  return mutex;
}

Status status_of(const Standard_Failure& failure) {
  if (failure.IsKind(STANDARD_TYPE(Standard_OutOfMemory))) return Status(StatusCode::out_of_memory, "out of memory");
  const char* const message = failure.GetMessageString();
  const std::string type = std::string("OpenCASCADE: ") + failure.DynamicType()->Name();
  return Status(StatusCode::internal, message && *message ? type + ": " + message : type);
}

Status each_on_threads(std::size_t count, std::size_t grain, const Execution& execution,
                       FunctionRef<Status(std::size_t)> body) {
  std::mutex mutex;
  Status first;
  std::size_t first_place = std::numeric_limits<std::size_t>::max();
  const auto call = [&](std::size_t k) {
    Status status = caught_occt([&] { return body(k); });
    if (status.ok()) return;
    const std::lock_guard lock(mutex);
    if (k >= first_place) return;
    first = std::move(status);
    first_place = k;
  };
  const Status done = parallel_for(count, grain, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) call(k);
  });
  return done.ok() ? first : done;
}

}}  // namespace tessera::abi_0_1
