#pragma once
// The sets that benchmarks run over, built when first asked for.

#include <string_view>

#include "tessera/patch_set.h"

namespace tessera::bench {

/// "teapot": the 32 patches of tools/models/teapot.bpt. "bicubic20000": a wavy field of 200 x 100 bicubic patches.
/// Ends the program with a message if the model cannot be read.
const PatchSet& set_named(std::string_view name);

}  // namespace tessera::bench
