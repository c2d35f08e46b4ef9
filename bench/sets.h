#pragma once
// The sets that benchmarks run over, built when first asked for.

#include <string_view>

#include "tessera/patch_set.h"

namespace tessera::bench {

/// "teapot": the 32 patches of tools/models/teapot.bpt. "bicubicN": a wavy field of N bicubic patches, 25 (from N = 20000
/// on 100) a row; 20000 and 100000 in doubles as well. "rational20000", "rational100000": their control points with
/// weights. Ends the program with a message if the model cannot be read.
const PatchSet& set_named(std::string_view name);

}  // namespace tessera::bench
