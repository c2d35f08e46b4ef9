#pragma once
// The last stage: meshes become files.

#include <cstdint>
#include <string>

#include "io/file/output_file.h"
#include "stages/mesh.h"
#include "tessera/io.h"

namespace tessera::cli {

struct WriteOptions {
  std::string output;
  std::string format;  ///< of standard output, without the dot
  MeshWriteOptions mesh = {};
};

/// The options of tessera tessellate: those of its stages.
struct TessellateOptions {
  LoadOptions load;
  PackOptions pack;
  MeshOptions mesh;
  WriteOptions write;
  std::uint64_t piece_bytes = 0;  ///< memory of a piece; 0: the model is meshed as a whole
};

/// Throws UsageError if the file of a job cannot hold what an option requests.
void check_formats(const Plan& plan, const MeshOptions& options);

/// Writes a file with the extension of `path`, which then appears. Errors: io_error, cancelled.
Status write_meshes(const Meshed& made, const std::string& path, const WriteOptions& options, OutputFile& out,
                    Timings& timings);

}  // namespace tessera::cli
