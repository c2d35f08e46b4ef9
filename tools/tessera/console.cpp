#include "console.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace tessera::cli {
namespace {

std::atomic<bool> interrupt_flag{false};
volatile std::sig_atomic_t caught_signal = 0;

extern "C" void remember_signal(int signal) {
  if (caught_signal != 0) {
    remove_temporaries();
    std::signal(signal, SIG_DFL);
    std::raise(signal);  // delivered on return from here
    return;
  }
  caught_signal = signal;
  interrupt_flag.store(true, std::memory_order_relaxed);
}

}  // namespace

Result<OutputFile> open_output(const std::string& path) {
  if (path.empty()) return OutputFile::standard_output(&interrupt_flag);
  return OutputFile::create(path, &interrupt_flag);
}

Status print(std::string_view text) {
  OutputFile out = OutputFile::standard_output(&interrupt_flag);
  out.write(text);
  return out.commit();
}

Status print_json(const Json& object) {
  // File names need not be UTF-8, JSON must.
  return print(object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Status in_file(const std::filesystem::path& file, const Status& status) {
  return Status(status.code(), file.string() + ": " + status.message(), status.index());
}

void catch_signals() {
  std::signal(SIGXFSZ, SIG_IGN);
  struct sigaction action {};
  action.sa_handler = remember_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // A process that was started with the signal ignored (nohup, a script's background) shall go on ignoring it.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

const std::atomic<bool>& interrupted() { return interrupt_flag; }

void end_by_signal() {
  if (caught_signal == 0) return;
  std::signal(caught_signal, SIG_DFL);
  std::raise(caught_signal);
}

Progress::Progress(std::string_view work) : work_(work), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (percent_ >= 0) std::fputs("\r\x1b[K", stderr);
}

Execution Progress::execution() {
  Execution execution;
  execution.cancel = &interrupt_flag;
  if (terminal_) execution.progress = [this](double share) { tell(share); };
  return execution;
}

void Progress::tell(double share) {
  const int percent = static_cast<int>(100 * share);
  if (!terminal_ || percent == percent_) return;
  percent_ = percent;
  std::fprintf(stderr, "\r%s %d%%\x1b[K", work_.c_str(), percent);
}

std::string readable(double value, int digits) {
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%.*g", digits, value);
  return std::string(text, static_cast<std::size_t>(length));
}

}  // namespace tessera::cli
