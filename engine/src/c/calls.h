#pragma once
// Shared by all functions of the C interface: errors as codes and sentences, structs of other sizes, views, how calls
// run.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/function_ref.h"
#include "c/handles.h"
#include "tessera/execution.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"
#include "tessera/tessera_c_queries.h"
#include "tessera/tessera_c_shapes.h"

namespace tessera { inline namespace abi_0_1 {

/// The result of a call: a Status, or one of the two codes that C++ has no use for.
struct CStatus {
  tsr_status code = TSR_OK;
  std::ptrdiff_t index = Status::no_index;
  std::string message;

  CStatus() = default;
  CStatus(tsr_status of, std::string why) : code(of), message(std::move(why)) {}
  CStatus(const Status& status)
      : code(static_cast<tsr_status>(status.code())), index(status.index()), message(status.message()) {}
};

/// Keeps an error for tsr_last_message(), and returns its code.
tsr_status finish(CStatus&& status) noexcept;

/// Runs the body of a function; it returns a CStatus or a Status.
template <class Body>
tsr_status c_call(Body&& body) noexcept {
  CStatus status = guarded([&]() -> CStatus { return body(); });
  return status.code == TSR_OK ? TSR_OK : finish(std::move(status));
}

inline CStatus bad(std::string why) { return {TSR_INVALID_ARGUMENT, std::move(why)}; }
inline CStatus null_pointer(const char* name) { return bad(std::string(name) + " is a null pointer"); }

/// Says why a handle is no object of a kind.
CStatus no_such_handle(const void* handle, Object::Kind wanted);

/// An object for the time of a call.
template <class T>
class Held {
 public:
  explicit Held(const void* handle) : handle_(handle), pin_(handle) {
    if (pin_.object() && (*pin_.object())->kind() == T::of_kind) object_ = static_cast<T*>(pin_.object()->get());
  }
  explicit operator bool() const { return object_ != nullptr; }
  T* operator->() const { return object_; }
  T& operator*() const { return *object_; }
  std::shared_ptr<T> shared() const { return std::static_pointer_cast<T>(*pin_.object()); }
  CStatus error() const { return no_such_handle(handle_, T::of_kind); }

 private:
  const void* handle_;
  Pin pin_;
  T* object_ = nullptr;
};

/// How many calls use an object: any number that read it, or one that changes it. No call waits.
class Usage {
 public:
  bool begin_reading();
  void end_reading() { count_.fetch_sub(1, std::memory_order_release); }
  bool begin_changing();
  void end_changing() { count_.store(0, std::memory_order_release); }

 private:
  std::atomic<std::int32_t> count_ = 0;  // -1: one changes it
};
class Reading {
 public:
  explicit Reading(Usage& usage) : Reading(&usage) {}
  /// Of nothing, if there is no usage.
  explicit Reading(Usage* usage) : usage_(usage && usage->begin_reading() ? usage : nullptr) {}
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;
  ~Reading() {
    if (usage_) usage_->end_reading();
  }
  explicit operator bool() const { return usage_ != nullptr; }

 private:
  Usage* usage_;
};
class Changing {
 public:
  explicit Changing(Usage& usage) : usage_(usage.begin_changing() ? &usage : nullptr) {}
  Changing(const Changing&) = delete;
  Changing& operator=(const Changing&) = delete;
  ~Changing() {
    if (usage_) usage_->end_changing();
  }
  explicit operator bool() const { return usage_ != nullptr; }

 private:
  Usage* usage_;
};
CStatus in_use(Object::Kind kind);

/// Checks the size of a caller's struct; `least` is that of its first version.
CStatus check_size(const char* name, std::size_t given, std::size_t least, std::size_t own);

/// Checks a member that must be from 0 to `most`.
CStatus check_member(const char* name, const char* member, std::int64_t value, std::int64_t most);

/// A count of the caller's; the largest there is for those beyond memory.
inline std::size_t clamped_count(std::uint64_t count) {
  return static_cast<std::size_t>(std::min<std::uint64_t>(count, std::numeric_limits<std::size_t>::max()));
}

/// Checks the members that mean the same in every struct: `reserved` is 0, flags are 0 or 1.
template <class T>
CStatus check_members(const char* name, const T& read) {
  CStatus status;
  if constexpr (requires { read.reserved; }) status = check_member(name, "reserved", read.reserved, 0);
  if constexpr (requires { read.is_double; })
    if (!status.code) status = check_member(name, "is_double", read.is_double, 1);
  if constexpr (requires { read.is_editable; })
    if (!status.code) status = check_member(name, "is_editable", read.is_editable, 1);
  return status;
}

/// Reads a struct of the caller's, which may be of an earlier version, over the defaults in `out`, and checks the
/// members that all structs have in common.
template <class T>
CStatus read_struct(const char* name, const T* given, T& out) {
  if (!given) return {};
  if (CStatus status = check_size(name, given->struct_size, sizeof(T), sizeof(T)); status.code) return status;
  std::memcpy(&out, given, std::min(given->struct_size, sizeof(T)));
  return check_members(name, out);
}
/// Writes a struct of the caller's, and keeps its struct_size.
template <class T>
CStatus write_struct(const char* name, T* out, T filled) {
  if (!out) return null_pointer(name);
  if (CStatus status = check_size(name, out->struct_size, sizeof(T), sizeof(T)); status.code) return status;
  filled.struct_size = out->struct_size;
  std::memcpy(out, &filled, std::min(out->struct_size, sizeof(T)));
  return {};
}

/// Runs work as the caller wants it: on so many threads, with progress, until it is cancelled. Errors: those of the
/// struct; TSR_UNSUPPORTED in a forked child.
CStatus run_work(const tsr_run* run, FunctionRef<CStatus(const Execution&)> work);

/// Turns a view of the caller's memory into one of T. Errors: TSR_INVALID_ARGUMENT (strides or an address that do not
/// suit T).
template <class T, int N>
CStatus view_of(const char* name, const void* data, std::size_t count, std::int64_t record, std::int64_t component,
                VectorView<T, N>& view);
template <class T, int N>
CStatus view_of(const char* name, const tsr_out& out, VectorView<T, N>& view) {
  return view_of(name, out.data, out.count, out.record, out.component, view);
}
template <class T, int N>
CStatus view_of(const char* name, const tsr_in& in, VectorView<T, N>& view) {
  return view_of(name, in.data, in.count, in.record, in.component, view);
}

template <class T, int N>
CStatus view_of(const char* name, const void* data, std::size_t count, std::int64_t record, std::int64_t component,
                VectorView<T, N>& view) {
  view = {};
  if (!data) return {};
  constexpr auto size = static_cast<std::int64_t>(sizeof(T));
  if (record == 0) record = N * size;
  if (component == 0) component = size;
  if (record % size != 0 || component % size != 0 || std::bit_cast<std::uintptr_t>(data) % alignof(T) != 0)
    return bad(std::string(name) + ": addresses must be multiples of " + std::to_string(size));
  if (!std::in_range<std::ptrdiff_t>(record) || !std::in_range<std::ptrdiff_t>(component))
    return bad(std::string(name) + ": records or components are further apart than memory is large");
  T* const first = static_cast<T*>(const_cast<void*>(data));
  const auto step = static_cast<std::ptrdiff_t>(component / size);
  for (int c = 0; c < N; ++c) view.component[static_cast<std::size_t>(c)] = first + c * step;
  view.stride = static_cast<std::ptrdiff_t>(record / size);
  view.size = count;
  return {};
}

/// Sets `out` to a new handle of the object.
template <class Handle>
CStatus give(Handle** out, std::shared_ptr<Object> object) {
  *out = static_cast<Handle*>(add_handle(std::move(object)));
  return {};
}

}}  // namespace tessera::abi_0_1
