// Stands for cache_bytes.cpp on platforms that do not tell.

#include "eval/cache_bytes.h"

namespace tessera { inline namespace abi_0_1 {

CacheBytes cache_bytes() { return {0, 0}; }

}}  // namespace tessera::abi_0_1
