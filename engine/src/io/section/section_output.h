#pragma once
// Writes sections into a file that is open already.

#include <filesystem>

#include "io/file/output_file.h"
#include "tessera/sections_file.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes to a file that was created for `path`, and leaves commit() to the caller, which reports failed writes.
/// Errors: as write_sections(), but for io_error.
Status write_sections(const Sections& sections, const std::filesystem::path& path, OutputFile& out,
                      const SectionsFileOptions& options);

void write_svg(const Sections& sections, OutputFile& out, const SectionsFileOptions& options);
void write_dxf(const Sections& sections, OutputFile& out);
void write_section_ply(const Sections& sections, OutputFile& out);

}}  // namespace tessera::abi_0_1
