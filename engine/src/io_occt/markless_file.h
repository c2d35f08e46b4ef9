#pragma once
// Files that begin with a byte order mark.

#include <string>

#include "io_occt/memory_file.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A file without the byte order mark that an editor may have put before it. OpenCASCADE would take the mark for text,
/// and in IGES it moves the columns of the first line. path() can be opened during the object's lifetime.
class MarklessFile {
 public:
  /// Uses the file itself, or a copy in memory if it has the mark. Errors: io_error.
  static Result<MarklessFile> make(const std::string& path);
  const std::string& path() const { return path_; }

 private:
  MarklessFile() = default;
  std::string path_;
  MemoryFile copy_;
};

}}  // namespace tessera::abi_0_1
