#pragma once
// Writes files whole or not at all. For the library itself and the project's own tools; users have io.h.
//
// Threads: one at a time for each object, any number for different ones.

#include <atomic>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/internal_export.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

class OutputPlace;
struct OpenedPlace;

/// Unlinks the temporaries of open OutputFiles, of at most eight at once. For signal handlers that end the process:
/// async-signal-safe.
void remove_temporaries() noexcept;

/// Writes beside the place of a file, then renames. The file appears at commit(); without it nothing remains. Anything
/// but a regular file (a pipe, a terminal, /dev/stdout) is written directly. Errors: after a failed write later ones
/// are dropped, and commit() reports the first failure. Memory: 1 MiB, whatever is written.
class OutputFile {
 public:
  /// Opens the file. Once `cancel` is true, writes fail with cancelled, and the file does not appear. Errors: io_error
  /// (a directory, a missing folder, no permission), out_of_memory.
  TESSERA_INTERNAL_EXPORT static Result<OutputFile> make(const std::filesystem::path& path,
                                                         const std::atomic<bool>* cancel = nullptr);
  /// Writes to the process's standard output, directly. Errors: io_error (it is closed), out_of_memory.
  static Result<OutputFile> standard_output(const std::atomic<bool>* cancel = nullptr);
  /// Writes to `bytes`, which is cleared, must outlive the object, and is complete after commit(). `name` stands for
  /// the file in messages. Errors: out_of_memory.
  static Result<OutputFile> memory(std::string& bytes, const std::filesystem::path& name,
                                   const std::atomic<bool>* cancel = nullptr);

  TESSERA_INTERNAL_EXPORT OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  TESSERA_INTERNAL_EXPORT ~OutputFile();  ///< without commit(), removes what was written

  TESSERA_INTERNAL_EXPORT void write(std::string_view bytes);  ///< writes the bytes as they are
  void write(char c) {                                         ///< writes one byte
    if (buffer_bytes - used_ < 1) flush();
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
  /// The file that is written, until commit() gives it its place; empty if the place is written directly. For other
  /// processes that write parts of it.
  std::filesystem::path temporary() const;
  /// Whether any write has failed: a long writer may stop early.
  bool failed() const { return !status_.ok(); }
  /// Writes the buffer, closes, renames. Call it once, last. Errors: io_error, cancelled.
  TESSERA_INTERNAL_EXPORT Status commit();

 private:
  OutputFile(std::unique_ptr<OutputPlace> place, std::filesystem::path target, const std::atomic<bool>* cancel);
  static Result<OutputFile> opened(Result<OpenedPlace>&& from, const std::atomic<bool>* cancel);
  char* room(std::size_t bytes) {
    if (buffer_bytes - used_ < bytes) flush();
    return buffer_.get() + used_;
  }
  void flush();
  void send(std::string_view bytes);
  void fail(int error_number);
  void see_cancel();

  std::unique_ptr<OutputPlace> place_;
  std::filesystem::path target_;
  const std::atomic<bool>* cancel_;
  static constexpr std::size_t buffer_bytes = std::size_t{1} << 16;  ///< small, for the many files of a batch
  std::unique_ptr<char[]> buffer_ = std::make_unique_for_overwrite<char[]>(buffer_bytes);
  std::size_t used_ = 0;
  Status status_;
};

}}  // namespace tessera::abi_0_1
