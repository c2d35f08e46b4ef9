#pragma once
// Errors as values: Status, and Result for a value or an error. No exception leaves the library but std::bad_alloc
// where memory runs out, from copies of values and from functions that return a std::vector or a std::string, which say
// so.
//
// Threads: any number of calls at once on const objects.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Kind of an error. The message gives the details.
enum class StatusCode : std::uint8_t {
  ok,                  ///< success
  invalid_argument,    ///< a value outside its stated range; in options and tolerances NaN and infinity as well
  non_finite,          ///< NaN or infinity in a point, a parameter, a domain, a map or another number of a surface
  invalid_weight,      ///< a rational weight that is not finite and positive
  unsupported_degree,  ///< a degree below 1 or above max_degree
  count_mismatch,      ///< a list whose length does not fit the others
  buffer_too_small,    ///< an output view with less room than the call needs
  unsupported,         ///< valid, but not available here (a kind of block, a file format)
  isa_unavailable,     ///< an instruction set that is unknown or that this machine lacks
  stale,               ///< an object made for an earlier state of the patch set, or for another set
  parse_error,         ///< a file whose content does not follow its format
  io_error,            ///< a file that cannot be opened, read or written
  out_of_memory,       ///< an allocation failed
  cancelled,           ///< the caller's cancellation flag was seen; outputs are partly written
  internal,            ///< a fault of the library or of a dependency
};

/// Returns the code's name as spelled above, for messages and logs.
std::string_view name(StatusCode code);

/// Success or an error: a code, a sentence, and the index of the offending element if there is one.
class [[nodiscard]] Status {
 public:
  static constexpr std::ptrdiff_t no_index = -1;  ///< index() of a status that names no element

  Status() = default;  ///< success; never allocates
  /// Makes an error. The message is a sentence. Cold: code that leads to a call is compiled for size.
  [[gnu::cold]] Status(StatusCode code, std::string message, std::ptrdiff_t index = no_index);

  bool ok() const { return code_ == StatusCode::ok; }
  StatusCode code() const { return code_; }                ///< ok for success
  const std::string& message() const { return message_; }  ///< empty for success
  std::ptrdiff_t index() const { return index_; }          ///< of the offending element, or no_index

 private:
  StatusCode code_ = StatusCode::ok;
  std::ptrdiff_t index_ = no_index;
  std::string message_;
};

/// A value, or the Status that says why there is none. The value of a failed Result must not be read: std::optional's
/// hardened modes assert this; otherwise the behaviour is undefined.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}         ///< success
  Result(Status status) : status_(std::move(status)) {  ///< failure; `status` must not be ok
    assert(!status_.ok());
  }

  bool ok() const { return value_.has_value(); }
  explicit operator bool() const { return ok(); }
  const Status& status() const { return status_; }  ///< success if there is a value

  T& value() & { return *value_; }
  const T& value() const& { return *value_; }
  T&& value() && { return *std::move(value_); }
  T& operator*() & { return *value_; }
  const T& operator*() const& { return *value_; }
  T&& operator*() && { return *std::move(value_); }
  T* operator->() { return &*value_; }
  const T* operator->() const { return &*value_; }

 private:
  std::optional<T> value_;
  Status status_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
