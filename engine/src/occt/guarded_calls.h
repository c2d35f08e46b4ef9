#pragma once
// Calls of OpenCASCADE: exceptions become values, and floating-point exceptions do not trap.

#include <cfenv>
#include <cstddef>
#include <mutex>
#include <opencascade/Standard_Failure.hxx>
#include <utility>

#include "base/function_ref.h"
#include "tessera/execution.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Keeps floating-point exceptions from trapping during its lifetime, on its thread: programs of OpenCASCADE may let
/// them trap (OSD::SetSignal), and what is computed here may divide by zero.
class UntrappedArithmetic {
 public:
  UntrappedArithmetic() { std::feholdexcept(&callers_); }
  UntrappedArithmetic(const UntrappedArithmetic&) = delete;
  UntrappedArithmetic& operator=(const UntrappedArithmetic&) = delete;
  ~UntrappedArithmetic() { std::fesetenv(&callers_); }

 private:
  std::fenv_t callers_;
};

/// Held by calls of OpenCASCADE's approximations (AdvApprox, AdvApp2Var): they are Fortran made into C++, and nobody
/// promises that several threads may call them.
std::mutex& approximation_mutex();

/// The Status of an exception of OpenCASCADE: out_of_memory, or internal with its type and message.
Status status_of(const Standard_Failure& failure);

/// Calls body() and returns its result, a Status or a Result; an exception, also one of OpenCASCADE, becomes a Status.
template <class Body>
auto caught_occt(Body&& body) noexcept -> decltype(body()) {
  return guarded([&]() -> decltype(body()) {
    try {
      return std::forward<Body>(body)();
    } catch (const Standard_Failure& failure) {
      return status_of(failure);
    }
  });
}

/// Calls body() so that nothing is thrown and nothing traps: the outermost layer of public calls.
template <class Body>
auto guarded_occt(Body&& body) noexcept -> decltype(body()) {
  const UntrappedArithmetic untrapped;
  return caught_occt(std::forward<Body>(body));
}

/// Calls body(k) for each k below `count`, by the threads of the caller's arena, `grain` of them in a piece. Returns
/// the error of the first k that fails, by its Status or by an exception; others are called all the same. Errors: also
/// cancelled.
Status each_on_threads(std::size_t count, std::size_t grain, const Execution& execution,
                       FunctionRef<Status(std::size_t)> body);

}}  // namespace tessera::abi_0_1
