#pragma once
// TrimCurve: loops of NURBS curves in the parameters of the NuPatches that follow.

#include <vector>

#include "io/rib_lexer.h"
#include "tessera/model.h"

namespace tessera::inline abi_0_1 {

/// The nine arrays after TrimCurve: ncurves order knot min max n u v w, points as (u w, v w, w). Which loops are holes
/// follows from how they nest, not from the file: hole is false for all.
Result<std::vector<TrimLoop>> read_trim_loops(RibLexer& lexer);

}  // namespace tessera::inline abi_0_1
