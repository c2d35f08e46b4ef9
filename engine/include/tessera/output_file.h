#pragma once
// Files that appear whole or not at all.

#include <atomic>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// Unlinks the temporaries of all open OutputFiles. For signal handlers that end the process: async-signal-safe.
void remove_temporaries() noexcept;

/// Writes beside the place of a file, then renames. The file appears at `commit`; without it nothing remains. Anything
/// but a regular file (a pipe, a terminal, /dev/stdout) is written directly. Memory: 1 MiB, whatever is written. After
/// a failed write later ones are dropped, and commit reports the first failure.
class OutputFile {
 public:
  /// Opens the file. Once `cancel` is true, writes fail with cancelled, and the file does not appear. Errors: io_error
  /// (a directory, a missing folder, no permission).
  static Result<OutputFile> create(const std::filesystem::path& path, const std::atomic<bool>* cancel = nullptr);
  /// The process's standard output.
  static OutputFile standard_output(const std::atomic<bool>* cancel = nullptr);

  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();  ///< without commit(), removes what was written

  void write(std::string_view bytes);  ///< writes bytes
  /// Writes a byte.
  void write(char c) {
    if (buffer_.size() - used_ < 1) flush();
    buffer_[used_++] = c;
  }
  /// Writes integers, and floats in the shortest form that reads back as the same number.
  template <class Number>
  void write_number(Number value) {
    char* const begin = room(32);
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + 32, value).ptr - begin);
  }
  /// Writes `digits` <= 17 significant digits.
  void write_number(double value, int digits) {
    char* const begin = room(32);
    used_ += static_cast<std::size_t>(std::to_chars(begin, begin + 32, value, std::chars_format::general, digits).ptr -
                                      begin);
  }

  /// The final place of the file.
  const std::filesystem::path& path() const { return target_; }
  /// Whether any write has failed: a long writer may stop early.
  bool failed() const { return !status_.ok(); }
  /// Writes the buffer, closes, renames. Call it once, last. Errors: io_error, cancelled.
  Status commit();

 private:
  class Destination;
  OutputFile(std::unique_ptr<Destination> destination, std::filesystem::path target, const std::atomic<bool>* cancel);
  char* room(std::size_t bytes) {
    if (buffer_.size() - used_ < bytes) flush();
    return buffer_.data() + used_;
  }
  void flush();
  void send(std::string_view bytes);
  void see_cancel();

  std::unique_ptr<Destination> destination_;
  std::filesystem::path target_;
  const std::atomic<bool>* cancel_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  Status status_;
};

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
