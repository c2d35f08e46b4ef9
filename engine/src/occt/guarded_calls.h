#pragma once
// Calls of OpenCASCADE whose exceptions become values.

#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>
#include <opencascade/Standard_Type.hxx>
#include <string>
#include <utility>

#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The Status of an exception of OpenCASCADE: out_of_memory, or internal with its type and message.
[[gnu::cold]] inline Status status_of(const Standard_Failure& failure) {
  if (failure.IsKind(STANDARD_TYPE(Standard_OutOfMemory))) return Status(StatusCode::out_of_memory, "out of memory");
  const char* const message = failure.GetMessageString();
  return Status(StatusCode::internal, std::string("OpenCASCADE: ") + failure.DynamicType()->Name() +
                                          (message && *message ? std::string(": ") + message : std::string()));
}

/// Calls body() and returns its result, a Status or a Result; an exception, also one of OpenCASCADE, becomes a Status.
template <class Body>
auto guarded_occt(Body&& body) noexcept -> decltype(body()) {
  return guarded([&]() -> decltype(body()) {
    try {
      return std::forward<Body>(body)();
    } catch (const Standard_Failure& failure) {
      return status_of(failure);
    }
  });
}

}}  // namespace tessera::abi_0_1
