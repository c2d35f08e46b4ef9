// A .ply file of pieces whose number is not known before: records of each kind wait in a file of their own.

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "io/file/spool_file.h"
#include "io/mesh/mesh_pieces.h"
#include "io/mesh/packed_records.h"
#include "io/mesh/valid_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {

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
