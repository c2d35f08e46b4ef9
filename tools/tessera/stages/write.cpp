#include "stages/write.h"

#include <algorithm>
#include <iterator>

#include "io/format/output_formats.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

/// The formats without quads and without positions in double.
constexpr const char* simple_formats[] = {".stl", ".glb", ".gltf"};

void check_format(const Plan& plan, const char* option, const std::string& held, const std::string& wanted) {
  for (const Job& job : plan.jobs) {
    const std::string extension = lower_extension(job.output);
    if (std::find(std::begin(simple_formats), std::end(simple_formats), extension) != std::end(simple_formats))
      throw UsageError(option, extension + " can hold only " + held + "; .obj and .ply can hold " + wanted);
  }
}

}  // namespace

void check_formats(const Plan& plan, const MeshOptions& options) {
  if (options.quads) check_format(plan, "--quads", "triangles", "quads");
  if (options.certified.precision == Precision::double_precision)
    check_format(plan, "--precision", "positions in float", "positions in double");
}

Status write_meshes(const Meshed& made, const std::string& path, const WriteOptions& options, OutputFile& out,
                    Timings& timings) {
  const auto phase = timings.phase("write");
  const Status status = made.by_shapes ? write_assembly(made.assembly, path, out, options.mesh)
                                       : write_mesh(made.mesh, path, out, options.mesh);
  return status.ok() ? out.commit() : status;
}

}  // namespace tessera::cli
