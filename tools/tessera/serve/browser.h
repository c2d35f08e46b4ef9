#pragma once
// The user's browser.

#include <sys/types.h>

#include <string>

namespace tessera::cli {

/// Opens an address by xdg-open, which goes on by itself when this process is interrupted.
class BrowserStart {
 public:
  explicit BrowserStart(const std::string& address);

  /// Returns the sentence of what has gone wrong, once; empty if nothing has, or if xdg-open is not yet done.
  std::string take_fault();

 private:
  pid_t child_ = 0;  ///< 0: nothing to wait for
  std::string fault_;
};

}  // namespace tessera::cli
