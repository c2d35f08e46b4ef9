// A .ply file of pieces whose number is not known before: records of each kind wait in a file of their own.

#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/descriptor.h"
#include "io/file/file.h"
#include "io/file/output_file.h"
#include "io/mesh/mesh_pieces.h"
#include "io/mesh/packed_records.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

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

Result<SpoolFile> SpoolFile::make(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  Descriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (!file.is_open()) {  // a file system without such files
    std::string name = (folder / ".tessera-XXXXXX").string();
    file = Descriptor(::mkostemp(name.data(), O_CLOEXEC));
    if (!file.is_open()) return io_failure(path, "cannot be written in " + folder.string(), errno);
    ::unlink(name.c_str());
  }
  return SpoolFile(path, std::move(file));
}

Status SpoolFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::write(file_.number(), bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return io_failure(path_, "cannot be written", errno);
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return {};
}

Status SpoolFile::move_to(OutputFile& out) {
  std::vector<char> buffer(std::size_t{1} << 20);
  std::uint64_t offset = 0;
  while (!out.failed()) {
    const ssize_t got = ::pread(file_.number(), buffer.data(), buffer.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return io_failure(path_, "cannot be read back", errno);
    if (got == 0) break;
    out.write({buffer.data(), static_cast<std::size_t>(got)});
    offset += static_cast<std::uint64_t>(got);
  }
  file_ = Descriptor();
  return {};
}

}  // namespace

class PlyStream::Content {
 public:
  explicit Content(OutputFile to) : out(std::move(to)) {}

  Status append(const Mesh& piece, std::uint64_t patch_count);
  Status commit();
  Status named(const Status& status) const {
    return {status.code(), out.path().string() + ": " + status.message(), status.index()};
  }

  OutputFile out;
  std::array<std::optional<SpoolFile>, 3> spools;  ///< `[MeshRecord]`
  MeshTotals totals;
  std::uint64_t patches = 0;

 private:
  Status spool(const PlyLayout& layout, const Mesh& piece, const PiecePlace& place, MeshRecord kind);
};

Status PlyStream::Content::append(const Mesh& piece, std::uint64_t patch_count) {
  const MeshTotals own = MeshTotals::of(piece);
  MeshTotals all = totals.triangles + totals.quads > 0 ? totals : own;
  all.vertices = totals.vertices + own.vertices;
  all.triangles = totals.triangles + own.triangles;
  all.quads = totals.quads + own.quads;
  if (own.vertices > 0) {
    const Result<PlyLayout> layout = PlyLayout::make(all);
    if (!layout) return named(layout.status());
    const PiecePlace place{totals.vertices, totals.triangles, totals.quads, patches};
    if (const Status status = layout->check(piece, place); !status.ok()) return named(status);
    for (const MeshRecord kind : {MeshRecord::vertex, MeshRecord::triangle, MeshRecord::quad})
      if (Status status = spool(*layout, piece, place, kind); !status.ok()) return status;
    totals = all;
  }
  patches += patch_count;
  return {};
}

Status PlyStream::Content::spool(const PlyLayout& layout, const Mesh& piece, const PiecePlace& place, MeshRecord kind) {
  const std::uint64_t bytes = layout.range(piece, place, kind).bytes;
  if (bytes == 0) return {};
  std::optional<SpoolFile>& file = spools[static_cast<std::size_t>(kind)];
  if (!file) {
    Result<SpoolFile> made = SpoolFile::make(out.path());
    if (!made) return made.status();
    file.emplace(*std::move(made));
  }
  Status status;
  const auto write = [&](std::string_view packed) {
    if (status.ok()) status = file->write(packed);
    return status.ok();
  };
  const Status packed = write_packed(
      PackedSink(write), bytes / layout.record_bytes(kind), layout.record_bytes(kind),
      [&](std::size_t first, std::size_t last, char* to) { layout.pack(piece, place, kind, first, last, to); });
  return packed.ok() ? status : packed;
}

Status PlyStream::Content::commit() {
  const Result<PlyLayout> layout = PlyLayout::make(totals);
  if (!layout) return named(layout.status());
  out.write(layout->header());
  for (std::optional<SpoolFile>& file : spools) {
    if (!file) continue;
    if (Status status = file->move_to(out); !status.ok()) return status;
  }
  return out.commit();
}

PlyStream::PlyStream(std::unique_ptr<Content> content) : content_(std::move(content)) {}
PlyStream::PlyStream(PlyStream&&) noexcept = default;
PlyStream::~PlyStream() = default;

Result<PlyStream> PlyStream::make(OutputFile out) {
  return guarded([&]() -> Result<PlyStream> { return PlyStream(std::make_unique<Content>(std::move(out))); });
}
Status PlyStream::append(const Mesh& piece, std::uint64_t patches) {
  return guarded([&] { return content_->append(piece, patches); });
}
const MeshTotals& PlyStream::totals() const { return content_->totals; }
Status PlyStream::commit() {
  return guarded([&] { return content_->commit(); });
}

}}  // namespace tessera::abi_0_1
