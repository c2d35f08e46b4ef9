#pragma once
// Files that a RIB file reads by ReadArchive.

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {

struct RibArchive {
  std::string name;  ///< its path, for messages
  std::string text;
};

/// The archives that are open, one within the other, and the text of all that were read. It must outlive the requests'
/// words, which view the text. Memory: the archives, each once.
class RibArchives {
 public:
  static constexpr std::size_t max_depth = 32;
  /// The texts that archives stand for are at most this many times the files' bytes and 1 MiB.
  static constexpr std::size_t max_copies = 64;

  /// `text` and `name` are those of the first file.
  RibArchives(std::string_view text, std::string_view name) : open_{std::string(name)}, files_bytes_(text.size()) {}

  /// Opens an archive that lies beside the file that names it or beside the first file, or below. Returns null if
  /// there is no such file. Errors, with the line of `at`: unsupported (an absolute path, a part "..", nesting beyond
  /// max_depth, more copies than max_copies), parse_error (an archive that reads itself), io_error.
  Result<const RibArchive*> open(const TextCursor& at, std::string_view name);
  /// Ends the innermost archive.
  void close() { open_.pop_back(); }

 private:
  Result<const RibArchive*> load(const TextCursor& at, const std::string& path);

  std::vector<std::string> open_;  // paths, the first file first
  std::map<std::string, std::unique_ptr<const RibArchive>> read_;
  std::size_t files_bytes_, opened_bytes_ = 0;
};

}}  // namespace tessera::abi_0_1
