#pragma once
// The writers of sections, one per format. Failed writes are reported by commit(), which is the caller's.

#include "io/file/output_file.h"
#include "tessera/sections_file.h"

namespace tessera { inline namespace abi_0_1 {

void write_svg(const Sections& sections, OutputFile& out, const SectionsFileOptions& options);
void write_dxf(const Sections& sections, OutputFile& out);
void write_section_ply(const Sections& sections, OutputFile& out);

}}  // namespace tessera::abi_0_1
