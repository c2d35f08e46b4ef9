#pragma once
// Text as a file in memory, for readers that take a path.

#include <string>
#include <string_view>

#include "io/file/descriptor.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A file in memory. path() can be opened during the object's lifetime, also by child processes.
class MemoryFile {
 public:
  MemoryFile() = default;  ///< no file
  /// A copy of `bytes`; messages name `original`. Errors: io_error.
  static Result<MemoryFile> make(std::string_view bytes, const std::string& original);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  Descriptor copy_;
};

}}  // namespace tessera::abi_0_1
