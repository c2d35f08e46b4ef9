#include "eval/cache_bytes.h"

#include <unistd.h>

namespace tessera { inline namespace abi_0_1 {

CacheBytes cache_bytes() { return {sysconf(_SC_LEVEL2_CACHE_SIZE), sysconf(_SC_LEVEL3_CACHE_SIZE)}; }

}}  // namespace tessera::abi_0_1
