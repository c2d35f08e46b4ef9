#pragma once
// Calls of functions that the caller passed in: their exceptions become errors.

#include <exception>
#include <limits>
#include <new>
#include <string>
#include <type_traits>
#include <utility>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns what `function` returns. An exception becomes a Status: out_of_memory or else invalid_argument, with a
/// message that begins with place(), for example "the curve at t = 0.5".
template <class Function, class Place>
auto called(Function&& function, Place&& place) -> Result<std::invoke_result_t<Function>> {
  try {
    return std::forward<Function>(function)();
  } catch (const std::bad_alloc&) {
    return Status(StatusCode::out_of_memory, "out of memory");
  } catch (const std::exception& error) {
    return Status(StatusCode::invalid_argument, place() + " threw: " + error.what());
  } catch (...) {
    return Status(StatusCode::invalid_argument, place() + " threw an exception that is no std::exception");
  }
}

/// Returns the bound that the caller's function returns; infinity if it returns none or throws.
template <class Function>
double bound_of(Function&& function) {
  try {
    const double bound = std::forward<Function>(function)();
    if (bound >= 0) return bound;
  } catch (...) {  // a bound is optional: without one a fit is sampled
  }
  return std::numeric_limits<double>::infinity();
}

}}  // namespace tessera::abi_0_1
