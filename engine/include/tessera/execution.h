#pragma once
// How calls run: instruction set, cancellation, progress, stores. Work runs in the caller's current TBB arena.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// An instruction set that kernels are compiled for.
enum class Isa : std::uint8_t { sse2, avx2, avx512, neon64, wasm128 };

/// Returns "sse2", "avx2" (with FMA), "avx512" (F, CD, DQ, BW, VL), "neon64" (AArch64) or "wasm128" (WebAssembly).
std::string_view name(Isa isa);

/// Returns the instruction sets that the library has and that processor and operating system support, slowest first.
std::span<const Isa> available_isas();

/// Returns the instruction set of options that leave it open: the one in the environment variable TESSERA_ISA if that
/// is not empty, otherwise the fastest available one. This call alone reads the variable, each time that it runs; plans
/// and scenes keep what it returned when they were made. Errors: isa_unavailable (TESSERA_ISA names one that is unknown
/// or missing). Threads: any number, while none changes the environment.
Result<Isa> default_isa();

/// Returns the instruction set with this name(). Errors: isa_unavailable (it is unknown or missing on this machine).
Result<Isa> parse_isa(std::string_view text);

/// How results of grids and meshes are written to memory. Scattered points, outputs written value by value, and meshes
/// on SSE2 always use plain stores.
enum class Stores : std::uint8_t {
  /// Streaming if the output is larger than a third of the last-level cache or than eight times a core's second-level
  /// cache, otherwise plain.
  automatic,
  plain,      ///< through the caches
  streaming,  ///< non-temporal, past the caches
};

/// Report on a call.
struct ExecutionReport {
  Isa isa = Isa::sse2;     ///< stated by the kernel that ran
  bool streaming = false;  ///< whether non-temporal stores were used
  std::size_t tasks = 0;   ///< pieces of work handed to threads
};

/// Options of long calls. All are optional.
struct Execution {
  const std::atomic<bool>* cancel = nullptr;  ///< polled between tasks; the call then returns StatusCode::cancelled
  /// Called with the share done, which rises and reaches 1 once. Calls come from any thread, one at a time, and seldom.
  std::function<void(double)> progress = {};
  Stores stores = Stores::automatic;  ///< how large outputs are written
  ExecutionReport* report = nullptr;  ///< filled if not null
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
