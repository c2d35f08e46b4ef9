#pragma once
// A progress bar for long work on standard error, if that is a terminal; a pipe gets nothing.

#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "console/console.h"

namespace tessera::cli {

/// Sets the file that the next bars belong to, such as "(2/5) teapot.bpt"; empty for none.
void set_progress_subject(std::string subject);

/// Appears once the work has taken a tenth of a second, and is removed at the end.
class Progress {
 public:
  explicit Progress(std::string_view work);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Options for a library call: it reports its progress here, and an interrupt cancels it.
  Execution execution();
  /// Shows `share` of the work done, 0 to 1.
  void tell(double share);

 private:
  std::string work_;
  bool terminal_;
  Stopwatch clock_;
  double shown_at_ = -1;  // seconds; below 0: not shown yet
};

/// One bar for parts that threads work on side by side. Threads: any number.
class PartsProgress {
 public:
  PartsProgress(std::string_view work, std::size_t parts) : bar_(work), shares_(parts) {}

  /// Options for a library call that works on a part: it reports its progress here, and an interrupt cancels it.
  Execution execution(std::size_t part);
  /// Shows `share` of a part done, 0 to 1.
  void tell(std::size_t part, double share);

 private:
  std::mutex mutex_;
  Progress bar_;
  std::vector<double> shares_;
  double sum_ = 0;
};

/// "12 s" or "1:05", rounded up; empty from 99 hours on.
std::string duration_text(double seconds);

/// The text of the bar without control characters: "work [#####-----]  50% 3 s left", at most `columns` long.
std::string progress_line(const std::string& work, double share, double seconds, int columns);

}  // namespace tessera::cli
