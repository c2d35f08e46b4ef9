#pragma once
// How calls run: the instruction set, cancellation, progress, stores. Work runs in the caller's current TBB arena.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

enum class Isa : std::uint8_t { sse2, avx2, avx512, neon64 };

std::string_view name(Isa isa);  ///< "sse2", "avx2" (with FMA), "avx512" (F, CD, DQ, BW, VL), "neon64" (AArch64)

/// The ones that the library was built with and that processor and operating system support, slowest first.
std::span<const Isa> available_isas();

/// The one used where an option leaves it open: the environment variable TESSERA_ISA if it is set and not empty,
/// the fastest available one otherwise. Errors: isa_unavailable if TESSERA_ISA names one that is unknown or missing.
Result<Isa> default_isa();

/// From a name as above. Errors: isa_unavailable if unknown or missing on this machine.
Result<Isa> parse_isa(std::string_view text);

/// How results of grids and meshes are written to memory; scattered points, what goes value by value, and meshes on
/// SSE2 by plain stores always.
enum class Stores : std::uint8_t {
  /// Streaming where the output is larger than a third of the last-level cache or eight times a core's second-level
  /// cache, plain otherwise.
  automatic,
  plain,
  streaming,  ///< non-temporal, past the caches
};

/// What a call did.
struct ExecutionReport {
  Isa isa = Isa::sse2;     ///< as stated by the kernel that ran
  bool streaming = false;  ///< whether non-temporal stores were used
  std::size_t tasks = 0;   ///< pieces of work handed to threads
};

/// Options of long calls. Everything is optional.
struct Execution {
  const std::atomic<bool>* cancel = nullptr;  ///< seen between tasks; the call then returns StatusCode::cancelled
  /// Called with the share done, which rises to 1 once, from any thread, one call at a time, seldom.
  std::function<void(double)> progress = {};
  Stores stores = Stores::automatic;  ///< how large outputs are written
  ExecutionReport* report = nullptr;  ///< filled if not null
};

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
