#pragma once
// Instruction sets: which ones this machine has, and which one runs.

#include <cstdint>
#include <span>
#include <string_view>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera {

enum class Isa : std::uint8_t { sse2, avx2, avx512, neon64 };

std::string_view name(Isa isa);  ///< "sse2", "avx2" (with FMA), "avx512" (F, CD, DQ, BW, VL), "neon64" (AArch64)

/// The ones that the library was built with and that processor and operating system support, slowest first.
std::span<const Isa> available_isas();

/// The one used where an option leaves it open: the environment variable TESSERA_ISA if it is set and not empty,
/// the fastest available one otherwise. Errors: isa_unavailable if TESSERA_ISA names one that is unknown or missing.
Result<Isa> default_isa();

/// From a name as above. Errors: isa_unavailable if unknown or missing on this machine.
Result<Isa> parse_isa(std::string_view text);

}  // namespace tessera
#pragma GCC visibility pop
