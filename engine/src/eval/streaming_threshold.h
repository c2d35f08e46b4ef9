#pragma once
// The output size above which stores bypass the caches.

#include <algorithm>
#include <cstddef>

#include "eval/cache_bytes.h"

namespace tessera { inline namespace abi_0_1 {

/// Bytes beyond which streaming stores win: a third of the last-level cache, or eight times a core's second-level one
/// where that is less. A last-level cache that many cores share is not one call's to fill: with 480 MB of it beside 2
/// MB a core, plain stores are 15% faster up to 28 MB, half as fast at 32 MB, and a sixth as fast at 200 MB.
inline std::size_t streaming_threshold() {
  static const std::size_t bytes = [] {
    const auto [own, shared] = cache_bytes();
    const std::size_t by_own = own > 0 ? static_cast<std::size_t>(own) * 8 : std::size_t{8} << 20;
    return shared > 0 ? std::min(by_own, static_cast<std::size_t>(shared) / 3) : by_own;
  }();
  return bytes;
}

}}  // namespace tessera::abi_0_1
