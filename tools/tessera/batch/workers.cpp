#include "batch/workers.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <vector>

#include "console/console.h"
#include "line/common_options.h"
#include "tessera/guard.h"

namespace tessera::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// The seconds between a request to terminate and the next, and before the worker is killed.
constexpr std::chrono::milliseconds patience{500};
constexpr int requests = 3;

bool write_all(int file, const void* bytes, std::size_t count) {
  const char* at = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t written = ::write(file, at, count);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written, count -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int file, void* bytes, std::size_t count) {
  char* at = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t found = ::read(file, at, count);
    if (found < 0 && errno == EINTR) continue;
    if (found <= 0) return false;
    at += found, count -= static_cast<std::size_t>(found);
  }
  return true;
}

bool write_text(int file, const std::string& text) {
  const std::uint64_t size = text.size();
  return write_all(file, &size, sizeof size) && write_all(file, text.data(), text.size());
}

bool read_text(int file, std::string& text) {
  std::uint64_t size = 0;
  if (!read_all(file, &size, sizeof size)) return false;
  text.resize(size);
  return read_all(file, text.data(), size);
}

/// The bytes of address space that this process has.
std::uint64_t own_memory() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  file >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// A worker's life: jobs in, results out.
class Worker {
 public:
  Worker(int jobs, int results, const std::function<Status(std::size_t, std::string&)>& work)
      : jobs_(jobs), results_(results), work_(work), printed_(::memfd_create("output", 0)) {
    ::dup2(printed_, STDOUT_FILENO);
  }

  /// No exception leaves it: this copy of the process must not unwind what the parent has begun.
  void run() noexcept {
    for (std::uint64_t job = 0; read_all(jobs_, &job, sizeof job) && !interrupted();) {
      std::string note;
      const Status status = guarded([&] { return with_threads(1, [&] { return work_(job, note); }); });
      if (interrupted() || !send(status, note)) return;
    }
  }

 private:
  bool send(const Status& status, const std::string& note) {
    std::string output(static_cast<std::size_t>(std::max<off_t>(0, ::lseek(printed_, 0, SEEK_END))), '\0');
    ::lseek(printed_, 0, SEEK_SET);
    const bool is_whole = read_all(printed_, output.data(), output.size());
    ::lseek(printed_, 0, SEEK_SET);
    const std::uint8_t code = static_cast<std::uint8_t>(status.code());
    return is_whole && ::ftruncate(printed_, 0) == 0 && write_all(results_, &code, 1) &&
           write_text(results_, status.message()) && write_text(results_, output) && write_text(results_, note);
  }

  int jobs_, results_;
  const std::function<Status(std::size_t, std::string&)>& work_;
  int printed_;
};

/// A worker as its parent sees it.
struct Process {
  pid_t id = 0;
  int jobs = -1, results = -1;
  std::optional<std::size_t> job;
  Clock::time_point deadline = Clock::time_point::max();
  int asked = 0;  ///< how often it was asked to terminate
};

class Pool {
 public:
  Pool(const WorkerLimits& limits, const std::function<std::optional<std::size_t>()>& next,
       const std::function<Status(std::size_t, std::string&)>& work,
       const std::function<void(std::size_t, const JobResult&)>& done)
      : limits_(limits), next_(next), work_(work), done_(done), processes_(limits.workers) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() { end_all(); }

  Status run() {
    std::signal(SIGPIPE, SIG_IGN);
    for (;;) {
      for (Process& process : processes_)
        if (Status status = give_job(process); !status.ok()) return status;
      if (std::ranges::none_of(processes_, [](const Process& of) { return of.job.has_value(); })) break;
      wait();
      if (interrupted()) return Status(StatusCode::cancelled, "interrupted");
    }
    return {};
  }

 private:
  Status start(Process& process) {
    int jobs[2], results[2];
    if (::pipe(jobs) != 0 || ::pipe(results) != 0) return failed("a pipe");
    const pid_t parent = ::getpid();
    process.id = ::fork();
    if (process.id < 0) return failed("a process");
    if (process.id == 0) {
      // A worker whose parent was killed would hang without its timeout, or write while another run resumes.
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent) std::_Exit(0);
      ::setpgid(0, 0);  // with the programs that it starts
      for (const Process& other : processes_)
        for (const int file : {other.jobs, other.results})
          if (file >= 0) ::close(file);
      ::close(jobs[1]), ::close(results[0]);
      limit_memory();
      Worker(jobs[0], results[1], work_).run();
      std::_Exit(0);
    }
    ::setpgid(process.id, process.id);
    ::close(jobs[0]), ::close(results[1]);
    process.jobs = jobs[1], process.results = results[0];
    return {};
  }
  static Status failed(const std::string& what) {
    return Status(StatusCode::io_error, what + " could not be made: " + std::strerror(errno));
  }
  void limit_memory() const {
    if (limits_.memory == 0) return;
    const rlim_t most = own_memory() + limits_.memory;
    const rlimit limit{most, most};
    ::setrlimit(RLIMIT_AS, &limit);
  }

  Status give_job(Process& process) {
    if (process.job) return {};
    const std::optional<std::size_t> job = next_();
    if (!job) return {};
    if (process.id == 0)
      if (Status status = start(process); !status.ok()) return status;
    process.job = job;
    process.asked = 0;
    process.deadline =
        limits_.timeout > 0
            ? Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits_.timeout))
            : Clock::time_point::max();
    const std::uint64_t number = *job;
    (void)write_all(process.jobs, &number, sizeof number);  // a worker that has ended is seen below
    return {};
  }

  /// Waits for a result, the end of a worker, or a deadline.
  void wait() {
    std::vector<pollfd> files;
    std::vector<Process*> of;
    auto deadline = Clock::time_point::max();
    for (Process& process : processes_) {
      if (!process.job) continue;
      files.push_back({process.results, POLLIN, 0});
      of.push_back(&process);
      deadline = std::min(deadline, process.deadline);
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    const int milliseconds = deadline == Clock::time_point::max()
                                 ? -1
                                 : static_cast<int>(std::clamp<std::int64_t>(left.count() + 1, 0, 3'600'000));
    (void)::poll(files.data(), files.size(), milliseconds);  // an interrupt ends it too
    for (std::size_t k = 0; k < files.size(); ++k) {
      if (files[k].revents != 0) take_result(*of[k]);
      if (of[k]->job && Clock::now() >= of[k]->deadline) ask_to_end(*of[k]);
    }
  }

  void take_result(Process& process) {
    JobResult result;
    std::uint8_t code = 0;
    std::string message;
    const bool is_whole = read_all(process.results, &code, 1) && read_text(process.results, message) &&
                          read_text(process.results, result.output) && read_text(process.results, result.note);
    if (is_whole)
      result.status = code == 0 ? Status() : Status(static_cast<StatusCode>(code), message);
    else
      result.status = end_of(process), result.has_ended = true;
    const std::size_t job = *process.job;
    process.job.reset();
    done_(job, result);
  }

  /// Asks a worker to terminate, which takes away its temporary files; at last, kills it and what it has started.
  void ask_to_end(Process& process) {
    ::kill(-process.id, process.asked < requests ? SIGTERM : SIGKILL);
    ++process.asked;
    process.deadline = Clock::now() + patience;
  }

  /// Says why a worker has ended, and makes room for another.
  Status end_of(Process& process) {
    const bool was_asked = process.asked > 0;
    int state = 0;
    ::waitpid(process.id, &state, 0);
    ::kill(-process.id, SIGKILL);  // what it has started
    ::close(process.jobs), ::close(process.results);
    process = {.job = process.job};
    if (was_asked)
      return Status(StatusCode::cancelled, "took longer than " + readable(limits_.timeout, 3) + " s (--timeout)");
    const std::string how = WIFSIGNALED(state) ? std::string("by signal ") + ::strsignal(WTERMSIG(state))
                                               : "with status " + std::to_string(WEXITSTATUS(state));
    return Status(StatusCode::internal, "the process that worked on it ended " + how);
  }

  /// Ends all workers before the grace of this process is over (see console.cpp). A second request makes a worker end
  /// at once, without its temporaries.
  void end_all() {
    for (Process& process : processes_)
      if (process.id != 0) ::close(process.jobs);  // an idle worker ends
    for (const int until_next : {200, 100}) {      // milliseconds
      for (Process& process : processes_)
        if (process.id != 0 && process.job) ::kill(-process.id, SIGTERM);
      wait_for_ends(std::chrono::milliseconds(until_next));
    }
    for (Process& process : processes_) {
      if (process.id == 0) continue;
      if (process.job) ::kill(-process.id, SIGKILL);
      ::waitpid(process.id, nullptr, 0);
      ::close(process.results);
    }
  }

  /// Waits until all workers have closed their results, or time is up. A result that comes meanwhile is dropped.
  void wait_for_ends(std::chrono::milliseconds time) {
    const auto end = Clock::now() + time;
    for (Process& process : processes_) {
      while (process.id != 0 && process.job) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        pollfd file{process.results, POLLIN, 0};
        const int found = left > 0 ? ::poll(&file, 1, static_cast<int>(left)) : 0;
        if (found < 0 && errno == EINTR) continue;
        if (found <= 0) break;
        char dropped[4096];
        if (::read(process.results, dropped, sizeof dropped) <= 0) process.job.reset();  // it has ended
      }
    }
  }

  const WorkerLimits& limits_;
  const std::function<std::optional<std::size_t>()>& next_;
  const std::function<Status(std::size_t, std::string&)>& work_;
  const std::function<void(std::size_t, const JobResult&)>& done_;
  std::vector<Process> processes_;
};

}  // namespace

Status run_workers(const WorkerLimits& limits, const std::function<std::optional<std::size_t>()>& next,
                   const std::function<Status(std::size_t, std::string&)>& work,
                   const std::function<void(std::size_t, const JobResult&)>& done) {
  return Pool(limits, next, work, done).run();
}

}  // namespace tessera::cli
