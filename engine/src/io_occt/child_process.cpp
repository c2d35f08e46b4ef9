#include "io_occt/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>
#include <system_error>

#include "base/text.h"
#include "io/descriptor.h"

namespace tessera::inline abi_0_1 {
namespace {

using Size = std::uint64_t;
constexpr int child_failed = 1, child_out_of_memory = 2;

Status no_child(const char* what) {
  return Status(StatusCode::internal, std::string(what) + ": " + std::generic_category().message(errno));
}

/// Bytes of data of this process, as RLIMIT_DATA counts them; 0 if the system does not say.
std::size_t data_bytes() {
  std::FILE* const file = std::fopen("/proc/self/statm", "re");
  if (!file) return 0;
  unsigned long size = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  const int found = std::fscanf(file, "%lu %lu %lu %lu %lu %lu", &size, &resident, &shared, &text, &library, &data);
  std::fclose(file);
  return found == 6 ? data * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

/// Lowers a limit; never raises one.
template <class Resource>
void lower(Resource resource, rlim_t value) {
  rlimit now{};
  if (::getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min(now.rlim_cur, value);
  ::setrlimit(resource, &now);
}

bool write_all(int descriptor, const char* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t done = ::write(descriptor, bytes, count);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
  return true;
}

/// Detaches the child: it must not disturb the parent, and it must end with it.
void leave_the_parent(int& output, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(child_failed);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU})
    std::signal(signal, SIG_DFL);
  if (output < 3) output = ::fcntl(output, F_DUPFD, 3);  // the parent may have had no streams
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) ::dup2(nowhere, stream);
  if (output != 3) output = ::dup2(output, 3);
  ::close_range(4, std::numeric_limits<unsigned>::max(), 0);
}

[[noreturn]] void live_as_child(FunctionRef<std::string()> work, const ChildLimits& limits, std::size_t data_before,
                                int output, pid_t parent) noexcept {
  leave_the_parent(output, parent);
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, limits.cpu_seconds);
  if (data_before > 0) lower(RLIMIT_DATA, data_before + limits.memory_bytes);
  try {
    const std::string bytes = work();
    const Size size = bytes.size();
    char head[sizeof size];
    std::memcpy(head, &size, sizeof size);
    const bool written = write_all(output, head, sizeof size) && write_all(output, bytes.data(), bytes.size());
    ::_exit(written ? 0 : child_failed);
  } catch (const std::bad_alloc&) {
    ::_exit(child_out_of_memory);
  } catch (...) {
    ::_exit(child_failed);
  }
}

/// Reads up to `count` bytes; fewer if the other end closes first.
std::size_t read_up_to(int descriptor, char* bytes, std::size_t count) {
  std::size_t used = 0;
  while (used < count) {
    const ssize_t got = ::read(descriptor, bytes + used, count - used);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    used += static_cast<std::size_t>(got);
  }
  return used;
}

/// Reads what live_as_child writes; false if it is incomplete.
bool receive(int descriptor, std::string& bytes) {
  Size size = 0;
  std::array<char, sizeof size> head;
  if (read_up_to(descriptor, head.data(), head.size()) != head.size()) return false;
  std::memcpy(&size, head.data(), sizeof size);
  constexpr Size portion = Size{1} << 24;
  while (bytes.size() < size) {
    const std::size_t used = bytes.size(), more = static_cast<std::size_t>(std::min(portion, size - used));
    bytes.resize(used + more);
    if (read_up_to(descriptor, bytes.data() + used, more) != more) return false;
  }
  return true;
}

Status end_of(int status, const ChildLimits& limits, std::string_view worker) {
  const std::string who(worker);
  if (WIFEXITED(status) && WEXITSTATUS(status) == child_out_of_memory)
    return Status(StatusCode::out_of_memory, who + " exceeded its memory limit");
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return Status(StatusCode::internal,
                  who + " did not end within " + counted(limits.cpu_seconds, "second") + " of processor time");
  if (!WIFSIGNALED(status)) return Status(StatusCode::internal, who + " ended without a result");
  const char* const signal = ::sigdescr_np(WTERMSIG(status));
  return Status(StatusCode::internal, who + " crashed (" + (signal ? signal : "unknown signal") + ")");
}

}  // namespace

Result<std::string> run_in_child(FunctionRef<std::string()> work, const ChildLimits& limits, std::string_view worker) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return no_child("a pipe cannot be made");
  Descriptor input(ends[0]), output(ends[1]);
  const std::size_t data_before = data_bytes();
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) return no_child("a process cannot be made");
  if (child == 0) live_as_child(work, limits, data_before, output.number(), parent);
  output.close();

  std::string bytes;
  bool complete = false;
  try {
    complete = receive(input.number(), bytes);
  } catch (...) {  // no memory for the bytes: the child must end all the same
    ::kill(child, SIGKILL);
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
    throw;
  }
  input.close();
  // If the program itself collects its children, or ignores them, there is no status: the bytes received decide.
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) break;
  }
  if (complete) return bytes;
  return end_of(status, limits, worker);
}

}  // namespace tessera::inline abi_0_1
