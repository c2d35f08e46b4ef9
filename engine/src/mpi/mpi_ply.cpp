#include "mpi/mpi_ply.h"

#include <algorithm>
#include <string>
#include <vector>

#include "mpi/mpi_call.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t bytes_at_once = std::size_t{8} << 20;

/// Packs and writes a piece's records of a kind, some megabytes at a time.
Status write_records(MPI_File file, const PlyLayout& layout, const Mesh& piece, const PiecePlace& place,
                     MeshRecord kind, std::size_t count) {
  const std::size_t size = layout.record_bytes(kind), at_once = std::max<std::size_t>(1, bytes_at_once / size);
  const std::uint64_t begin = layout.range(piece, place, kind).offset;
  std::vector<char> bytes(std::min(count, at_once) * size);
  for (std::size_t first = 0; first < count; first += at_once) {
    const std::size_t last = std::min(count, first + at_once);
    layout.pack(piece, place, kind, first, last, bytes.data());
    const auto offset = static_cast<MPI_Offset>(begin + first * size);
    MPI_Status written;
    int got = 0;
    Status status = mpi_status(
        "MPI_File_write_at",
        MPI_File_write_at(file, offset, bytes.data(), static_cast<int>((last - first) * size), MPI_BYTE, &written));
    if (status.ok()) status = mpi_status("MPI_Get_count", MPI_Get_count(&written, MPI_BYTE, &got));
    if (!status.ok()) return status;
    if (static_cast<std::size_t>(got) != (last - first) * size)
      return Status(StatusCode::io_error, "MPI_File_write_at wrote " + std::to_string(got) + " bytes of " +
                                              std::to_string((last - first) * size) + ": the disk may be full");
  }
  return {};
}

Status write_piece(MPI_File file, const PlyLayout& layout, const Mesh& piece, const PiecePlace& place, bool leads) {
  if (Status status = layout.check(piece, place); !status.ok()) return status;
  if (leads) {
    const std::string& header = layout.header();
    const int size = static_cast<int>(header.size());
    const int code = MPI_File_write_at(file, 0, header.data(), size, MPI_BYTE, MPI_STATUS_IGNORE);
    if (Status status = mpi_status("MPI_File_write_at", code); !status.ok()) return status;
  }
  Status status = write_records(file, layout, piece, place, MeshRecord::vertex, piece.vertex_count());
  if (status.ok()) status = write_records(file, layout, piece, place, MeshRecord::triangle, piece.triangle_count());
  return status.ok() ? write_records(file, layout, piece, place, MeshRecord::quad, piece.quad_count()) : status;
}

}  // namespace

Status write_ply_piece(MPI_Comm communicator, const std::filesystem::path& file, const PlyLayout& layout,
                       const Mesh& piece, const PiecePlace& place) {
  return guarded([&]() -> Status {
    int rank = 0;
    if (Status status = mpi_status("MPI_Comm_rank", MPI_Comm_rank(communicator, &rank)); !status.ok()) return status;
    MPI_File handle = MPI_FILE_NULL;
    const int opened = MPI_File_open(communicator, file.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &handle);
    if (Status status = mpi_status("MPI_File_open", opened); !status.ok()) return status;
    const auto bytes = static_cast<MPI_Offset>(layout.file_bytes());
    Status status = mpi_status("MPI_File_set_size", MPI_File_set_size(handle, bytes));
    if (status.ok()) status = guarded([&] { return write_piece(handle, layout, piece, place, rank == 0); });
    const Status closed = mpi_status("MPI_File_close", MPI_File_close(&handle));
    return status.ok() ? closed : status;
  });
}

}}  // namespace tessera::abi_0_1
