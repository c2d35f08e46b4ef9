#pragma once
// Which files can be written: checked before the work whose result they will hold.

#include <filesystem>
#include <string>

#include "io/output_file.h"
#include "tessera/io.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The extension of `path`, in small letters.
std::string lower_extension(const std::filesystem::path& path);

/// Checks that the extension of `path` names a format that write_mesh writes. Errors: unsupported, with a list of these
/// formats.
Status check_mesh_format(const std::filesystem::path& path);

/// Writes the mesh into the file that was created for `path`. The caller then commits the file, which also reports a
/// failed write. Errors: unsupported, and those of a mesh that no file can hold.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path, OutputFile& out);

/// Checks that the extension of `path` names a format that write_model writes. Errors: unsupported, with a list of
/// these.
Status check_model_format(const std::filesystem::path& path);
Result<WrittenModel> write_model(const Model& model, const std::filesystem::path& path, const FitOptions& fit,
                                 OutputFile& out);

}  // namespace tessera::inline abi_0_1
