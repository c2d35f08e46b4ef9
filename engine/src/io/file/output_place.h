#pragma once
// Where the bytes of an OutputFile go. A platform with files has posix_output.cpp, one without has no_files.cpp.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A place that takes bytes in order.
class OutputPlace {
 public:
  OutputPlace() = default;
  OutputPlace(const OutputPlace&) = delete;
  OutputPlace& operator=(const OutputPlace&) = delete;
  virtual ~OutputPlace() = default;

  /// Takes the first of these bytes. Returns how many, or -1 and sets errno; EINTR: call again.
  virtual std::ptrdiff_t take(std::string_view bytes) = 0;
  /// Closes the file, and keeps it from others until the object ends. Returns 0 or an errno.
  virtual int close() { return 0; }
  /// Gives the file that is closed its name, `target`; without it nothing of a temporary remains. Returns 0 or errno.
  virtual int publish(const std::filesystem::path&) { return 0; }
  /// The file that is written before it has its name; empty if there is none.
  virtual std::filesystem::path temporary() const { return {}; }
};

/// A place, and the file that it is.
struct OpenedPlace {
  std::unique_ptr<OutputPlace> place;
  std::filesystem::path target;  ///< behind symbolic links
};

/// Opens a temporary beside the file, or the file itself if it is no regular one. Errors: as OutputFile::make().
Result<OpenedPlace> open_place(const std::filesystem::path& path);
/// Opens the process's standard output. Errors: io_error.
Result<OpenedPlace> open_standard_output();

}}  // namespace tessera::abi_0_1
