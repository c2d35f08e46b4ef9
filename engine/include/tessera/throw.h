#pragma once
// Errors as exceptions, for programs that prefer them to values. The library itself throws none of these. Nothing is
// declared where exceptions are turned off.
//
// Threads: any.

#include <stdexcept>
#include <utility>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

#ifdef __cpp_exceptions

/// A Status that is an error, as an exception; what() is its message.
class StatusError : public std::runtime_error {
 public:
  /// Takes an error.
  explicit StatusError(Status status) : std::runtime_error(status.message()), status_(std::move(status)) {}
  const Status& status() const { return status_; }  ///< the code and the index as well

 private:
  Status status_;
};

/// Throws StatusError unless the status is success.
inline void throw_if_failed(const Status& status) {
  if (!status.ok()) throw StatusError(status);
}
/// Returns the value of a result. Throws StatusError if there is none.
template <class T>
T value_or_throw(Result<T> result) {
  throw_if_failed(result.status());
  return *std::move(result);
}

#endif

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
