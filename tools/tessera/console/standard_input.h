#pragma once
// Standard input as a file, for readers that decide by the extension.

#include <string>

#include "tessera/status.h"

namespace tessera::cli {

/// A copy of standard input in a folder of its own, which is removed with this object.
class StandardInput {
 public:
  /// Copies standard input up to its end. `format` is the extension without the dot. Errors: io_error.
  static Result<StandardInput> make(const std::string& format);
  StandardInput(StandardInput&&) noexcept;
  StandardInput& operator=(StandardInput&&) = delete;
  ~StandardInput();

  const std::string& path() const { return path_; }
  /// A message of the file's reader, which names standard input instead of the copy.
  std::string renamed(const std::string& message) const;

 private:
  StandardInput() = default;
  std::string folder_, path_;
};

}  // namespace tessera::cli
