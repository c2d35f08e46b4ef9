#pragma once
// Files that appear whole or not at all.

#include <atomic>
#include <charconv>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/descriptor.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Unlinks the temporaries of all open OutputFiles. For signal handlers that end the process: async-signal-safe.
void remove_temporaries() noexcept;

/// The name of a file that is removed at the end, unless it is released. remove_temporaries knows it until then.
class TemporaryName {
 public:
  TemporaryName() = default;
  explicit TemporaryName(std::filesystem::path path);
  TemporaryName(TemporaryName&& other) noexcept
      : path_(std::exchange(other.path_, std::filesystem::path())), place_(std::exchange(other.place_, no_place)) {}
  TemporaryName& operator=(TemporaryName&&) = delete;
  ~TemporaryName();

  bool empty() const { return path_.empty(); }
  const char* c_str() const { return path_.c_str(); }
  void release();

 private:
  static constexpr std::size_t no_place = ~std::size_t{0};
  std::filesystem::path path_;
  std::size_t place_ = no_place;  // its place among the names that remove_temporaries sees
};

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

  OutputFile(OutputFile&& other) = default;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view bytes);
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
  OutputFile(Descriptor file, std::filesystem::path target, TemporaryName temporary, const std::atomic<bool>* cancel);
  char* room(std::size_t bytes) {
    if (buffer_.size() - used_ < bytes) flush();
    return buffer_.data() + used_;
  }
  void flush();
  void send(std::string_view bytes);
  void see_cancel();

  Descriptor file_;
  std::filesystem::path target_;
  TemporaryName temporary_;  // empty if written directly
  const std::atomic<bool>* cancel_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  Status status_;
};

}  // namespace tessera::inline abi_0_1
