#pragma once
// A bar on standard error that tells how far long work is, if that is a terminal; a pipe sees nothing of it.

#include <string>
#include <string_view>

#include "console.h"

namespace tessera::cli {

/// Names the file that the next bars belong to: "(2/5) teapot.bpt"; empty for none.
void set_progress_subject(std::string subject);

/// Appears once the work has taken a tenth of a second, and is removed at the end.
class Progress {
 public:
  explicit Progress(std::string_view work);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Options for a library call: its progress comes here, and an interrupt cancels it.
  Execution execution();
  /// `share`: of the work done, 0 to 1.
  void tell(double share);

 private:
  std::string work_;
  bool terminal_;
  Stopwatch clock_;
  double shown_at_ = -1;  // seconds; below 0: not yet
};

/// The line without its control characters: "work [#####-----]  50% 3 s left", at most `columns` long.
std::string progress_line(const std::string& work, double share, double seconds, int columns);

}  // namespace tessera::cli
