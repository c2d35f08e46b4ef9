#pragma once
// Models larger than memory: read in runs, meshed one after the other, and written piece by piece.

#include <cstddef>
#include <string>
#include <vector>

#include "batch/jobs.h"
#include "stages/write.h"

namespace tessera::cli {

/// Adds --in-pieces; call it after all other options of the command.
void add_in_pieces(Command& command, TessellateOptions& options);
/// Throws UsageError if --in-pieces is there, and a job's files cannot be read or written in pieces.
void check_pieces(const TessellateOptions& options, const Plan& plan);
/// Whether a path names an index of pieces.
bool is_index(const std::string& path);

/// The facts of a mesh that was written in pieces.
struct InPieces {
  Meshed made;  ///< without a mesh
  std::size_t pieces = 0, surfaces = 0, trimmed = 0;
  std::vector<std::string> warnings;
};
/// Reads the only file of a job, and writes its mesh. Errors name the file.
Result<InPieces> mesh_in_pieces(const Job& job, const TessellateOptions& options, Timings& timings);
/// Returns their report.
Report report_of(const Job& job, const InPieces& result, MeshOptions options);

}  // namespace tessera::cli
