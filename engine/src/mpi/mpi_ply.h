#pragma once
// One .ply file that all ranks write. For the project's own tools.

#include <mpi.h>

#include <filesystem>

#include "io/mesh/mesh_pieces.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes this rank's piece of a .ply file by MPI's own file calls; rank 0 writes the header too. A meeting of all
/// ranks. The file must exist on a file system that all see. It is whole once all ranks have succeeded: let them agree
/// (Transport::agree()), and give it its name only then (OutputFile).
///
/// Errors, of this rank: those of PlyLayout::check(); io_error (MPI's own; a full disk). Memory: 8 MiB.
Status write_ply_piece(MPI_Comm communicator, const std::filesystem::path& file, const PlyLayout& layout,
                       const Mesh& piece, const PiecePlace& place);

}}  // namespace tessera::abi_0_1
