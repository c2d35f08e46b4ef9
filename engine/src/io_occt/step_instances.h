#pragma once
// Reads what a STEP file states of single instances of parts, beyond their names and rigid places.

#include <opencascade/XSControl_Reader.hxx>

#include "io_occt/cad_file.h"

namespace tessera { inline namespace abi_0_1 {

/// Collects the colours of solids, shells and faces, wherever they stand and at single instances. Colours of edges are
/// left out.
void collect_colours(const XSControl_Reader& reader, CadFile& file);

/// Collects the scales and mirrors of mapped items: OpenCASCADE places these rigidly.
void collect_moves(const XSControl_Reader& reader, CadFile& file);

}}  // namespace tessera::abi_0_1
