#pragma once
// No exception leaves the library: public entry points run their body in guarded().

#include <exception>
#include <new>
#include <string>
#include <utility>

#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The status of the exception that is being handled.
[[gnu::cold]] inline Status status_of_exception() noexcept {
  try {
    try {
      throw;
    } catch (const std::bad_alloc&) {
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

/// Calls body() and returns what it returns; an exception becomes a Status. R is Status or Result<T>.
template <class Body>
auto guarded(Body&& body) noexcept -> decltype(body()) {
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    return status_of_exception();
  }
}

}  // namespace tessera::inline abi_0_1
