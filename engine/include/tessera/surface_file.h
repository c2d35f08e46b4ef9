#pragma once
// Models larger than memory: a file of surfaces that is read in runs.
//
// Memory: a file keeps 32 bytes for each 64 KiB of its text. Threads: any number of calls at once on one file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A .bpt or .g2 file that stays on disk.
///
/// The surfaces of all runs, one run after the other, are those of read_model() for the whole file: the same numbers,
/// trims and placements, in the same order.
class SurfaceFile {
 public:
  /// Opens a file, and reads it once to find where its surfaces are. The coordinates of a .bpt file are not looked at:
  /// read() checks them.
  ///
  /// Errors, with the file and the line as from read_model(): io_error, parse_error, unsupported (another format, a
  /// packed file, a pipe; nothing in the file that is read), out_of_memory. Memory: 4 MiB, or up to 4 times the longest
  /// surface's text.
  static Result<SurfaceFile> open(const std::filesystem::path& path);

  SurfaceFile(SurfaceFile&&) noexcept;
  SurfaceFile& operator=(SurfaceFile&&) noexcept;
  ~SurfaceFile();

  std::size_t size() const;                   ///< the surfaces of the file, at least 1
  std::uint64_t bytes() const;                ///< the file's size
  const std::filesystem::path& path() const;  ///< as open() was given it

  /// Reads the surfaces first to end - 1. The model's name is the file's. Its warnings report what is skipped before
  /// each surface of the run, and after the last surface of the file. A run of no surfaces gives an empty model.
  ///
  /// Errors: invalid_argument (first above end, end above size()), io_error (the file has changed since it was opened),
  /// parse_error, out_of_memory. Memory: the model, and what open() takes for the text.
  Result<Model> read(std::size_t first, std::size_t end) const;

 private:
  class [[gnu::visibility("hidden")]] Content;
  explicit SurfaceFile(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
