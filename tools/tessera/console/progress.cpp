#include "console/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "console/terminal.h"

namespace tessera::cli {
namespace {

constexpr double first_after = 0.1, again_after = 0.05;  // seconds

std::string& subject() {
  static std::string words;
  return words;
}

std::string padded_percent(double share) {
  const std::string number = std::to_string(static_cast<int>(100 * share));
  return std::string(number.size() < 3 ? 3 - number.size() : 0, ' ') + number + "%";
}

/// "12 s left" or "1:05 left", once enough is known.
std::string time_left(double share, double seconds) {
  constexpr double enough = 0.5;  // seconds
  if (seconds < enough || share <= 0) return {};
  const std::string left = duration_text(seconds / share - seconds);
  return left.empty() ? left : " " + left + " left";
}

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds < 359999)) return {};  // 99 hours
  const int whole = static_cast<int>(std::ceil(seconds));
  if (whole < 60) return std::to_string(whole) + " s";
  const std::string rest = std::to_string(whole % 60);
  return std::to_string(whole / 60) + ":" + (rest.size() < 2 ? "0" : "") + rest;
}

void set_progress_subject(std::string words) { subject() = std::move(words); }

std::string progress_line(const std::string& work, double share, double seconds, int columns) {
  constexpr int widest = 40, narrowest = 10;
  share = std::clamp(share, 0.0, 1.0);
  const std::string tail = " " + padded_percent(share) + time_left(share, seconds);
  const int room = columns - 1 - static_cast<int>(work.size() + tail.size() + 3);
  std::string line = work;
  if (room >= narrowest) {
    const int width = std::min(room, widest), done = static_cast<int>(share * width);
    line += " [" + std::string(static_cast<std::size_t>(done), '#') +
            std::string(static_cast<std::size_t>(width - done), '-') + "]";
  }
  line += tail;
  return line.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
}

Progress::Progress(std::string_view work)
    : work_(subject().empty() ? std::string(work) : subject() + ": " + std::string(work)),
      terminal_(errors_take_escapes()) {}

Progress::~Progress() {
  if (shown_at_ >= 0) std::fputs("\r\x1b[K", stderr);
}

Execution Progress::execution() {
  Execution execution;
  execution.cancel = &interrupted();
  if (terminal_) execution.progress = [this](double share) { tell(share); };
  return execution;
}

void Progress::tell(double share) {
  if (!terminal_) return;
  const double now = clock_.seconds();
  if (now < (shown_at_ < 0 ? first_after : shown_at_ + again_after)) return;
  shown_at_ = now;
  std::fprintf(stderr, "\r%s\x1b[K", progress_line(work_, share, now, terminal_size().columns).c_str());
}

Execution PartsProgress::execution(std::size_t part) {
  Execution execution = bar_.execution();
  if (execution.progress) execution.progress = [this, part](double share) { tell(part, share); };
  return execution;
}

void PartsProgress::tell(std::size_t part, double share) {
  const std::lock_guard lock(mutex_);
  sum_ += share - shares_[part];
  shares_[part] = share;
  bar_.tell(sum_ / static_cast<double>(shares_.size()));
}

}  // namespace tessera::cli
