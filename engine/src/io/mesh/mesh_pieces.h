#pragma once
// Meshes larger than memory: files that are written piece by piece. For the project's own tools.
//
// Threads: any number of calls at once on different objects or on const ones; records are packed in the caller's TBB
// arena.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/internal_export.h"
#include "io/file/output_file.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The sizes of a mesh, all pieces together, and the attributes that every piece has.
struct MeshTotals {
  std::uint64_t vertices = 0;     ///< of all pieces
  std::uint64_t triangles = 0;    ///< of all pieces, without those that quads stand for
  std::uint64_t quads = 0;        ///< of all pieces
  bool normals = false;           ///< Mesh::normals
  bool parameters = false;        ///< Mesh::parameters
  bool patches = false;           ///< a patch for each face
  bool double_positions = false;  ///< Mesh::model_positions; of its own accord only write_mesh() writes doubles

  /// Returns the totals of a mesh that is one piece.
  static MeshTotals of(const Mesh& mesh);
};

/// The place of a piece in its mesh: what all pieces before it have. The piece is a mesh whose indices count its own
/// vertices, and whose patches count from 0.
struct PiecePlace {
  std::uint64_t first_vertex = 0;    ///< vertices of the pieces before
  std::uint64_t first_triangle = 0;  ///< their triangles
  std::uint64_t first_quad = 0;      ///< their quads
  std::uint64_t first_patch = 0;     ///< their patches
};

/// Kinds of records of a .ply file, in the order of the file.
enum class MeshRecord : std::uint8_t { vertex, triangle, quad };

/// A range of bytes in a file.
struct ByteRange {
  std::uint64_t offset = 0;  ///< from the file's begin
  std::uint64_t bytes = 0;   ///< its length
};

/// Where each record of a .ply file stands, so that anybody can write any piece: ranks of MPI, threads, independent
/// jobs. The file has the bytes that write_mesh() gives the whole mesh.
class PlyLayout {
 public:
  /// Errors: invalid_argument (no vertices), unsupported (more than 2,147,483,647 vertices, which no .ply file can
  /// index: write pieces as .vtp).
  static Result<PlyLayout> make(const MeshTotals& totals);

  const MeshTotals& totals() const { return totals_; }  ///< as make() was given them
  /// The bytes before the first record.
  const std::string& header() const { return header_; }
  TESSERA_INTERNAL_EXPORT std::uint64_t file_bytes() const;  ///< of the whole file
  /// Bytes of one record of a kind.
  TESSERA_INTERNAL_EXPORT std::size_t record_bytes(MeshRecord kind) const;
  /// Where a piece's records of a kind stand in the file.
  TESSERA_INTERNAL_EXPORT ByteRange range(const Mesh& piece, const PiecePlace& place, MeshRecord kind) const;
  /// Checks that a piece has a valid mesh, the attributes of the totals, and a place within them. A piece without
  /// vertices is valid. Errors: count_mismatch, invalid_argument, non_finite as for write_mesh(); unsupported (patches
  /// above 4,294,967,295).
  TESSERA_INTERNAL_EXPORT Status check(const Mesh& piece, const PiecePlace& place) const;
  /// Writes the piece's records `first` to `last` - 1 of a kind to `to`, which has room for them. Requires a piece that
  /// check() accepts, and records that it has.
  TESSERA_INTERNAL_EXPORT void pack(const Mesh& piece, const PiecePlace& place, MeshRecord kind, std::size_t first,
                                    std::size_t last, char* to) const;

 private:
  explicit PlyLayout(const MeshTotals& totals);
  MeshTotals totals_;
  std::string header_;
};

/// Writes a .ply file of pieces in their order, before it is known how many come. The file has the bytes that
/// write_mesh() gives the whole mesh, and appears whole, at commit(), or not at all. Records wait in files without a
/// name beside it, which takes the room of the file twice. Memory: 3 MiB beside a piece.
class PlyStream {
 public:
  /// `out` is a file that nothing was written to. Errors: io_error (its folder), out_of_memory.
  static Result<PlyStream> make(OutputFile out);
  PlyStream(PlyStream&&) noexcept;
  PlyStream& operator=(PlyStream&&) = delete;
  ~PlyStream();

  /// Appends a piece, whose numbers count from 0, as does `patches`: the number of its patches. All pieces have the
  /// attributes of the first one that has faces. A piece without vertices changes nothing. Errors: those of
  /// PlyLayout::make() and PlyLayout::check(), io_error.
  Status append(const Mesh& piece, std::uint64_t patches);
  /// The sizes of all pieces so far.
  const MeshTotals& totals() const;
  /// Writes the file. Call it once, last. Errors: invalid_argument (no vertices), io_error, cancelled.
  Status commit();

 private:
  class Content;
  explicit PlyStream(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// @name Pieces of VTK's kind
/// An index sheet.pvtp and its pieces sheet_0000.vtp, sheet_0001.vtp and so on (PolyData, binary). ParaView and VTK
/// read the index as one mesh, of any size. Positions are in the model's coordinates. Point data: Normals, and the
/// parameters as TCoords; cell data: patch. @{

/// Returns the file of a piece, beside the index. Errors: none; throws std::bad_alloc if memory runs out. Memory: the
/// result.
std::filesystem::path vtp_piece_path(const std::filesystem::path& index, std::size_t piece);
/// Writes the file of piece number `number`, which appears whole or not at all. `totals` states the attributes of all
/// pieces. A piece without vertices is valid. `first_patch` is added to its patches. Errors: those of write_mesh();
/// count_mismatch (other attributes), unsupported (patches above 4,294,967,295).
Status write_vtp_piece(const Mesh& piece, const MeshTotals& totals, const std::filesystem::path& index,
                       std::size_t number, std::uint64_t first_patch = 0);
/// Writes the index of pieces 0 to `pieces` - 1. Write it last. Errors: invalid_argument (no pieces), io_error.
Status write_pvtp(const MeshTotals& totals, const std::filesystem::path& index, std::size_t pieces);

/// @}

}}  // namespace tessera::abi_0_1
