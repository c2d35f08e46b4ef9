#pragma once
// Another program that runs as a child process: what it prints is read in pieces, and it never outlives the object.

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/file/descriptor.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// How long to wait for a child.
struct Patience {
  std::optional<std::chrono::milliseconds> limit = {};  ///< none: for ever
  const std::atomic<bool>* cancel = nullptr;            ///< seen within a fiftieth of a second
};

enum class Reading { whole, ended, late, cancelled };

/// A child process with no descriptors but its streams, nothing to read on standard input, and standard output and
/// error in one pipe. It blocks no signals, and ignores only what its caller wants to be ignored (nohup: SIGHUP). The
/// destructor kills and collects it. Other children of the process are left alone, and a process that ignores SIGCHLD
/// loses only the exit status.
class ChildProcess {
 public:
  /// Starts `words[0]`, a path, with these arguments. Errors: io_error ("cannot be started: Permission denied").
  static Result<ChildProcess> start(const std::vector<std::string>& words);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  /// Appends what the child prints until `bytes` holds `size` bytes (whole), the child closes its streams (ended), time
  /// is up (late), or the caller gives up (cancelled).
  Reading read(std::string& bytes, std::size_t size, const Patience& patience);
  /// Waits up to `limit` for the child's end, then kills it. The status of waitpid; none if it was killed, or if the
  /// process ignores its children.
  std::optional<int> collect(std::chrono::milliseconds limit);

 private:
  ChildProcess(pid_t id, Descriptor output) : id_(id), output_(std::move(output)) {}
  pid_t id_;  ///< 0: collected
  Descriptor output_;
};

}}  // namespace tessera::abi_0_1
