#pragma once
// The machine's caches.

namespace tessera { inline namespace abi_0_1 {

/// Sizes in bytes; 0 or less where they are not known.
struct CacheBytes {
  long core;    ///< the second level, which a core has for itself
  long shared;  ///< the last level
};
CacheBytes cache_bytes();

}}  // namespace tessera::abi_0_1
