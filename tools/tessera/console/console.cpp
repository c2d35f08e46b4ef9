#include "console/console.h"

#include <pthread.h>
#include <sys/time.h>

#include <csignal>
#include <cstdio>

#include "console/output.h"

namespace tessera::cli {
namespace {

std::atomic<bool> interrupt_flag{false};
volatile std::sig_atomic_t caught_signal = 0;
const char* program_name = "tessera";

/// How long the work has to see the flag, and to take back what it has written.
constexpr suseconds_t grace = 400'000;  // microseconds

/// Ends the process by a signal once its handler returns, and leaves no temporary.
void end_at_once(int signal) {
  remove_temporaries();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

extern "C" void remember_signal(int signal) {
  if (caught_signal != 0) return end_at_once(signal);
  caught_signal = signal;
  interrupt_flag.store(true, std::memory_order_relaxed);
  // Not all work looks at the flag. A timer of a parent is no child's, so it is set here, where worker processes come
  // by, too; setitimer() is one system call, which a handler may make.
  const itimerval end{.it_interval = {0, 0}, .it_value = {0, grace}};
  (void)::setitimer(ITIMER_REAL, &end, nullptr);
}

extern "C" void end_after_grace(int) { end_at_once(caught_signal); }

}  // namespace

Status print(std::string_view text) { return write_text(text, {}); }

Status write_text(std::string_view text, const std::string& path) {
  Result<OutputFile> out = open_output(path);
  if (!out) return out.status();
  out->write(text);
  return out->commit();
}

Status print_json(const Json& object) { return print(object.text() + "\n"); }

void complain(const std::string& message) { std::fprintf(stderr, "%s: %s\n", program_name, message.c_str()); }
void set_program_name(const char* name) { program_name = name; }
void warn(const std::string& message) { complain("warning: " + message); }

Status already_said(StatusCode code) { return Status(code, ""); }
bool is_already_said(const Status& status) { return !status.ok() && status.message().empty(); }

Status in_file(const std::filesystem::path& file, const Status& status) {
  return Status(status.code(), file.string() + ": " + status.message(), status.index());
}

void catch_signals() {
  std::signal(SIGXFSZ, SIG_IGN);
  struct sigaction action {};
  action.sa_handler = end_after_grace;
  sigemptyset(&action.sa_mask);
  sigaction(SIGALRM, &action, nullptr);
  sigset_t alarm;
  sigemptyset(&alarm);
  sigaddset(&alarm, SIGALRM);
  ::pthread_sigmask(SIG_UNBLOCK, &alarm, nullptr);
  action.sa_handler = remember_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // A process that was started with the signal ignored (nohup, a script's background) must continue to ignore it.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

const std::atomic<bool>& interrupted() { return interrupt_flag; }

void end_by_signal() {
  if (caught_signal == 0) return;
  std::signal(caught_signal, SIG_DFL);
  std::raise(caught_signal);
}

std::string counted(std::size_t count, const std::string& noun, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? noun : plural.empty() ? noun + "s" : plural);
}

std::string readable(double value, int digits) {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.*g", digits, value);
  return std::string(text, static_cast<std::size_t>(length));
}

}  // namespace tessera::cli
