#pragma once
// The sets for benchmarks, built on first use.

#include <string_view>

#include "tessera/patch_set.h"

namespace tessera::bench {

/// "teapot": the 32 patches of tools/models/teapot.bpt. "bicubicN": a wavy field of N bicubic patches in rows of 25
/// (100 from N = 20000 on); 20000 and 100000 also in doubles. "rational20000", "rational100000": their control points
/// with weights. Ends the program with a message if the model cannot be read.
const PatchSet& set_named(std::string_view name);

}  // namespace tessera::bench
