#pragma once
// Lanes<float> and Lanes<double> of the instruction set that this unit is compiled for, in TESSERA_ISA_NAMESPACE, a
// namespace of that ISA. They are in an unnamed namespace there, since no inline function may be merged with one of
// another unit.

#if defined(__AVX512F__)
#include "kernel/isa/lanes_avx512.h"
#elif defined(__AVX2__)
#include "kernel/isa/lanes_avx2.h"
#elif defined(__wasm_simd128__)
#include "kernel/isa/lanes_wasm128.h"
#elif defined(__aarch64__)
#include "kernel/isa/lanes_neon64.h"
#else
#include "kernel/isa/lanes_sse2.h"
#endif

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE { namespace {

inline constexpr int max_order = 16;  // coefficients of the highest degree

}}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
