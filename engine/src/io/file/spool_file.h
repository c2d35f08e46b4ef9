#pragma once
// Bytes that wait on disk until they have a place in a file.

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "io/file/descriptor.h"
#include "io/file/output_file.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A file without a name, which goes with this object, also if the process is killed. One thread at a time.
class SpoolFile {
 public:
  /// Makes one on the file system of `path`, a file that need not exist. Errors: io_error.
  static Result<SpoolFile> make(const std::filesystem::path& path);

  /// Appends bytes. Errors: io_error, with `path` of make().
  Status write(std::string_view bytes);
  /// Writes all bytes to the end of another file, and gives back their room. Errors: io_error (reading).
  Status move_to(OutputFile& out);

 private:
  SpoolFile(std::filesystem::path path, Descriptor file) : path_(std::move(path)), file_(std::move(file)) {}

  std::filesystem::path path_;
  Descriptor file_;
};

}}  // namespace tessera::abi_0_1
