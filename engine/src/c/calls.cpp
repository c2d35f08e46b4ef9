#include "c/calls.h"

#include <array>

#include "c/forks.h"
#include "parallel/tbb_loop.h"
#include "tessera/version.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct LastError {
  std::string message;
  std::ptrdiff_t index = Status::no_index;
};
LastError& last_error() {
  thread_local LastError error;
  return error;
}

constexpr std::array kind_names{"model",           "set",   "plan",     "scene",    "list of hits",
                                "scene of points", "solid", "measures", "sections", "list of bytes"};
static_assert(kind_names.size() == static_cast<std::size_t>(Object::Kind::bytes) + 1);
const char* name_of(Object::Kind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

constexpr std::array status_names{"ok",
                                  "invalid_argument",
                                  "non_finite",
                                  "invalid_weight",
                                  "unsupported_degree",
                                  "count_mismatch",
                                  "buffer_too_small",
                                  "unsupported",
                                  "isa_unavailable",
                                  "stale",
                                  "parse_error",
                                  "io_error",
                                  "out_of_memory",
                                  "cancelled",
                                  "internal",
                                  "invalid_handle",
                                  "in_use"};
static_assert(status_names.size() == TSR_IN_USE + 1);
static_assert(static_cast<int>(StatusCode::internal) == TSR_INTERNAL);

}  // namespace

tsr_status finish(CStatus&& status) noexcept {
  LastError& error = last_error();
  error.message = std::move(status.message);
  error.index = status.index;
  return status.code;
}

CStatus no_such_handle(const void* handle, Object::Kind wanted) {
  if (!handle) return {TSR_INVALID_HANDLE, std::string("the handle of a ") + name_of(wanted) + " is null"};
  const Pin pin(handle);
  return {TSR_INVALID_HANDLE, pin.object() ? std::string("expected the handle of a ") + name_of(wanted) + ", found a " +
                                                 name_of((*pin.object())->kind())
                                           : "the handle was released, or is none"};
}

CStatus in_use(Object::Kind kind) {
  return {TSR_IN_USE, std::string("another call uses the ") + name_of(kind) + ", and one of the two changes it"};
}

bool Usage::begin_reading() {
  std::int32_t count = count_.load(std::memory_order_relaxed);
  while (count >= 0)
    if (count_.compare_exchange_weak(count, count + 1, std::memory_order_acquire)) return true;
  return false;
}

bool Usage::begin_changing() {
  std::int32_t none = 0;
  return count_.compare_exchange_strong(none, -1, std::memory_order_acquire);
}

CStatus check_size(const char* name, std::size_t given, std::size_t least, std::size_t own) {
  if (given >= least && given <= own) return {};
  return bad(std::string(name) + ": struct_size is " + std::to_string(given) + ", expected " +
             (least == own ? "" : std::to_string(least) + " to ") + std::to_string(own));
}

CStatus check_member(const char* name, const char* member, std::int64_t value, std::int64_t most) {
  if (value >= 0 && value <= most) return {};
  return bad(std::string(name) + ": " + member + " is " + std::to_string(value) + ", expected 0" +
             (most == 0 ? "" : (most == 1 ? " or " : " to ") + std::to_string(most)));
}

CStatus run_work(const tsr_run* run, FunctionRef<CStatus(const Execution&)> work) {
  tsr_run options{};
  if (CStatus status = read_struct("tsr_run", run, options); status.code) return status;
  if (CStatus status = check_member("tsr_run", "threads", options.threads, TSR_MAX_THREADS); status.code) return status;
  if (is_forked())
    return {TSR_UNSUPPORTED,
            "this process was forked after Tessera had computed: its threads are the parent's; start "
            "the process anew (spawn, exec)"};
  Execution execution;
  static_assert(sizeof(std::atomic<bool>) == 1);
  execution.cancel = reinterpret_cast<const std::atomic<bool>*>(const_cast<const std::uint8_t*>(options.cancel));
  if (options.progress) execution.progress = [&](double share) { options.progress(share, options.user); };
  CStatus status;
  const auto body = [&] { status = guarded([&]() -> CStatus { return work(execution); }); };
  options.threads == 0 ? body() : on_threads(options.threads, body);
  return status;
}

}}  // namespace tessera::abi_0_1

using namespace tessera;

extern "C" {

uint32_t tsr_version(void) { return TESSERA_VERSION_NUMBER; }

const char* tsr_last_message(int64_t* index) {
  if (index) *index = last_error().index;
  return last_error().message.c_str();
}

const char* tsr_status_name(tsr_status code) {
  return code >= 0 && static_cast<std::size_t>(code) < status_names.size()
             ? status_names[static_cast<std::size_t>(code)]
             : "unknown";
}

tsr_status tsr_retain(void* handle) {
  return retain_handle(handle) ? TSR_OK : finish({TSR_INVALID_HANDLE, "the handle is null, was released, or is none"});
}

tsr_status tsr_release(void* handle) {
  if (!handle || release_handle(handle)) return TSR_OK;
  return finish({TSR_INVALID_HANDLE, "the handle was released before, or is none"});
}

}  // extern "C"
