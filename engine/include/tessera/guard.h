#pragma once
// Exceptions as values: how the library, and code around it, turns what is thrown into a Status. Code that is compiled
// without exceptions has none to turn.

#include <exception>
#include <new>
#include <stdexcept>
#include <utility>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

#ifdef __cpp_exceptions
/// The Status of the exception that is being handled: out_of_memory, also of a container that would be longer than any
/// memory, or internal with its message.
[[gnu::cold]] inline Status status_of_exception() noexcept {
  try {
    try {
      throw;
    } catch (const std::bad_alloc&) {
      return Status(StatusCode::out_of_memory, "out of memory");
    } catch (const std::length_error&) {  // of a container
      return Status(StatusCode::out_of_memory, "out of memory");
    } catch (const std::exception& error) {
      return Status(StatusCode::internal, error.what());
    } catch (...) {
      return Status(StatusCode::internal, "unknown exception");
    }
  } catch (...) {  // no memory even for the message
    return Status(StatusCode::out_of_memory, {});
  }
}
#endif

/// Calls body() and returns its result, a Status or a Result; an exception becomes a Status.
template <class Body>
[[gnu::visibility("hidden")]] auto guarded(Body&& body) noexcept -> decltype(body()) {
#ifdef __cpp_exceptions
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    return status_of_exception();
  }
#else
  return std::forward<Body>(body)();
#endif
}

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
