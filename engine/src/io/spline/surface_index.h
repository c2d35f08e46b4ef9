#pragma once
// Where the surfaces of a file are, and the surfaces of a run.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "io/file/file_windows.h"
#include "io/spline/item_reader.h"

namespace tessera { inline namespace abi_0_1 {

/// How a file is read piece by piece, in bytes of text.
struct IndexOptions {
  std::size_t window = std::size_t{1} << 22;  ///< in memory at once; more where an item is longer
  std::size_t step = std::size_t{1} << 16;    ///< the least distance of two places that are kept
};

/// Places in a file of surfaces, so that a run of surfaces is found. Threads: any number of calls to read().
class SurfaceIndex {
 public:
  /// Reads the whole file once. Errors: those of FileWindows; unsupported (another format, a packed file; nothing that
  /// is read); those of the format's reader, but for numbers that its skip() does not check.
  static Result<SurfaceIndex> make(const std::filesystem::path& path, const IndexOptions& options = {});

  const FileWindows& file() const { return file_; }
  std::size_t surface_count() const { return surfaces_; }
  /// Requires first <= end <= surface_count(). Errors: those of FileWindows and of the format's reader.
  Result<Model> read(std::size_t first, std::size_t end) const;

 private:
  enum class Format : std::uint8_t { bpt, g2 };
  SurfaceIndex(FileWindows file, Format format, const IndexOptions& options)
      : file_(std::move(file)), name_(file_.path().string()), format_(format), options_(options) {}
  static Result<Format> format_of(const FileWindows& file);
  std::unique_ptr<ItemReader> reader() const;
  Status go(ItemWalk& walk, const FilePlace& from, ItemWalk::Take take) const;

  FileWindows file_;
  std::string name_;
  Format format_;
  IndexOptions options_;
  std::size_t surfaces_ = 0;
  std::vector<FilePlace> places_{FilePlace{}};  ///< each behind a surface, but for the first
};

}}  // namespace tessera::abi_0_1
