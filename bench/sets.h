#pragma once
// The sets that benchmarks run over, built when first asked for.

#include <string_view>

#include "tessera/patch_set.h"

namespace tessera::bench {

/// "teapot": the 32 patches of tools/models/teapot.bpt. "bicubic1000", "bicubic20000": wavy fields of 40 x 25 and of
/// 200 x 100 bicubic patches, the larger one in doubles as well. "rational20000": its control points with weights.
/// Ends the program with a message if the model cannot be read.
const PatchSet& set_named(std::string_view name);

}  // namespace tessera::bench
