#pragma once
// TrimCurve: loops of NURBS curves in the parameters of the NuPatches that follow.

#include <vector>

#include "io/rib/rib_lexer.h"
#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads the nine arrays after TrimCurve: ncurves order knot min max n u v w, points as (u w, v w, w). `hole` is false
/// for all loops: the nesting decides which are holes, not the file.
Result<std::vector<TrimLoop>> read_trim_loops(RibLexer& lexer);

}}  // namespace tessera::abi_0_1
