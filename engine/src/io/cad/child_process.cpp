#include "io/cad/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

Status failure(const char* what, int error) {
  return Status(StatusCode::io_error, std::string(what) + ": " + std::generic_category().message(error));
}

/// The settings of a child when it starts.
class SpawnSettings {
 public:
  explicit SpawnSettings(int output) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes);
    sigset_t fatal, none;
    sigemptyset(&fatal);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE, SIGXCPU}) sigaddset(&fatal, signal);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &fatal);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  ~SpawnSettings() {
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
  }

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

/// Moves a descriptor above the standard streams, which this process may have closed.
Descriptor above_streams(int number) {
  Descriptor low(number);
  return number > STDERR_FILENO ? std::move(low) : Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return failure("a pipe cannot be made", errno);
  Descriptor input = above_streams(ends[0]), output = above_streams(ends[1]);
  if (!input.is_open() || !output.is_open()) return failure("a pipe cannot be made", errno);
  const SpawnSettings settings(output.number());
  pid_t id = 0;
  const int error =
      ::posix_spawn(&id, arguments[0], &settings.actions, &settings.attributes, arguments.data(), environ);
  if (error != 0) return failure("cannot be started", error);
  return ChildProcess(id, std::move(input));
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : id_(std::exchange(other.id_, 0)), output_(std::move(other.output_)) {}

ChildProcess::~ChildProcess() {
  if (id_ != 0) collect(milliseconds(0));
}

Reading ChildProcess::read(std::string& bytes, std::size_t size, const Patience& patience) {
  constexpr std::size_t portion = std::size_t{1} << 16;  // a pipe's
  const int glance = patience.limit || patience.cancel ? 20 : -1;
  const auto end = patience.limit ? Clock::now() + *patience.limit : Clock::time_point::max();
  while (bytes.size() < size) {
    if (patience.cancel && patience.cancel->load(std::memory_order_relaxed)) return Reading::cancelled;
    if (patience.limit && Clock::now() >= end) return Reading::late;
    pollfd wait{output_.number(), POLLIN, 0};
    if (::poll(&wait, 1, glance) <= 0) continue;
    const std::size_t used = bytes.size();
    bytes.resize(used + std::min(portion, size - used));
    const ssize_t got = ::read(output_.number(), bytes.data() + used, bytes.size() - used);
    const int error = errno;
    bytes.resize(used + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0 || (got < 0 && error != EINTR)) return Reading::ended;
  }
  return Reading::whole;
}

std::optional<int> ChildProcess::collect(milliseconds limit) {
  output_.close();
  const auto end = Clock::now() + limit;
  int status = 0, flags = WNOHANG;
  for (;;) {
    const pid_t found = ::waitpid(id_, &status, flags);
    if (found == id_ || (found < 0 && errno != EINTR)) {
      id_ = 0;
      return found > 0 && flags == WNOHANG ? std::optional(status) : std::nullopt;
    }
    if (found == 0 && Clock::now() < end) {
      std::this_thread::sleep_for(milliseconds(1));
    } else if (found == 0) {
      ::kill(id_, SIGKILL);
      flags = 0;
    }
  }
}

}}  // namespace tessera::abi_0_1
