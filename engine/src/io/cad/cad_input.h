#pragma once
// A CAD file as its readers take it: Tessera's as bytes, the program tessera-cad-reader as a path. Neither sees that a
// file is packed.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/file/file.h"
#include "io/file/memory_file.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A file, or bytes in memory. Calls are not for several threads at once.
class CadInput {
 public:
  /// A regular file. It is read here if it is packed, else where bytes() is called first. Errors: io_error (missing, a
  /// directory, no permission), unsupported (not a regular file), parse_error (empty), those of unpacking.
  static Result<CadInput> open(const std::filesystem::path& path);
  /// Bytes that outlive the object. Errors: parse_error (there are none), those of unpacking.
  static Result<CadInput> memory(std::string_view bytes, const std::filesystem::path& name);

  const std::string& name() const { return name_; }
  /// Returns the unpacked content, which lives as long as the object stays where it is. Errors: as read_file().
  Result<std::string_view> bytes();
  /// Returns a path that a child process can open during the object's lifetime: of the file itself, or of a copy in
  /// memory where that is packed or no file. Errors: io_error.
  Result<std::string> file();
  /// Whether the content is a model that was read before; see kept_model.h.
  bool is_kept_model() const;
  /// The size of what file() names.
  std::uint64_t file_bytes() const { return size_; }

 private:
  explicit CadInput(const std::filesystem::path& name) : name_(name.string()) {}
  Status unpack(std::string_view bytes);
  Status no_bytes() const;
  /// Whether a file that begins with these bytes is packed.
  bool is_packed(std::string_view begin) const;

  std::string name_;
  bool is_file_ = false;    ///< whether the file itself is the content
  std::string owned_;       ///< what was unpacked
  FileBytes read_;          ///< what was read where bytes() was called
  std::string_view given_;  ///< the caller's bytes, if these are the content
  std::uint64_t size_ = 0;
  MemoryFile copy_;
};

}}  // namespace tessera::abi_0_1
