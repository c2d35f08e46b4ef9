#pragma once
// Four and Fours of the instruction set that this unit is compiled for: vectors of four floats, for kernels that read
// points by their coordinates. In an unnamed namespace, as lanes.h.

#include "kernel/isa/lanes.h"

#if defined(__wasm_simd128__)
#include "kernel/isa/four_floats_wasm128.h"
#elif defined(__aarch64__)
#include "kernel/isa/four_floats_neon64.h"
#else
#include "kernel/isa/four_floats_x86.h"
#endif
