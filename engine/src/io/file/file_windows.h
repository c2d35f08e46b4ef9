#pragma once
// Parts of a file that is too large for memory.

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/file/descriptor.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A regular file that is open, and that must not change. Threads: any number of calls to read().
class FileWindows {
 public:
  /// Errors: io_error (missing, a directory, no permission), unsupported (not a regular file), parse_error (empty).
  static Result<FileWindows> open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  /// Reads bytes, as many as asked for or to the end of the file. Errors: io_error (also for a file that has changed
  /// since it was opened).
  Status read(std::uint64_t offset, std::size_t bytes, std::string& into) const;

 private:
  FileWindows(std::filesystem::path path, Descriptor file) : path_(std::move(path)), file_(std::move(file)) {}

  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t size_ = 0;
  timespec changed_{};
};

}}  // namespace tessera::abi_0_1
