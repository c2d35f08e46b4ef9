#pragma once
// Which files can be written, known before the work is done whose result they shall hold.

#include <filesystem>
#include <string>

#include "io/output_file.h"
#include "tessera/io.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// The extension of `path`, in small letters.
std::string lower_extension(const std::filesystem::path& path);

/// Whether the extension of `path` names a format that write_mesh writes. Errors: unsupported, with a list of those.
Status check_mesh_format(const std::filesystem::path& path);

/// write_mesh into the file that was created for `path`: what is left to do is to commit it, which also says whether a
/// write has failed. Errors: unsupported, and those of a mesh that no file can hold.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path, OutputFile& out);

/// The same for write_model.
Status check_model_format(const std::filesystem::path& path);
Result<WrittenModel> write_model(const Model& model, const std::filesystem::path& path, const FitOptions& fit,
                                 OutputFile& out);

}  // namespace tessera::inline abi_0_1
