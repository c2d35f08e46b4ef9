#pragma once
// Writes into a file that is open already: for tools that open their output before they compute its content.

#include <filesystem>

#include "io/file/output_file.h"
#include "tessera/io.h"
#include "tessera/sections_file.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes the mesh to a file that was created for `path`, and leaves commit() to the caller, which reports failed
/// writes. Errors: unsupported, and those of a mesh that no file can hold.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path, OutputFile& out,
                  const MeshWriteOptions& options = {});
/// Writes the assembly to a file that was created for `path`, and leaves commit() to the caller. Errors: as
/// write_assembly(), but for io_error.
Status write_assembly(const MeshAssembly& assembly, const std::filesystem::path& path, OutputFile& out,
                      const MeshWriteOptions& options = {});
/// Writes the model to a file that was created for `path`, and leaves commit() to the caller, which reports failed
/// writes. Errors: as write_model(), but for io_error.
Result<WrittenModel> write_model(const Model& model, const std::filesystem::path& path, const FitOptions& fit,
                                 OutputFile& out);
/// Writes sections to a file that was created for `path`, and leaves commit() to the caller, which reports failed
/// writes. Errors: as write_sections(), but for io_error.
Status write_sections(const Sections& sections, const std::filesystem::path& path, OutputFile& out,
                      const SectionsFileOptions& options);

}}  // namespace tessera::abi_0_1
