#include "base/large_pages.h"

#include <sys/mman.h>

namespace tessera { inline namespace abi_0_1 {

void want_large_pages(void* memory, std::size_t bytes) noexcept {
#ifdef MADV_HUGEPAGE
  (void)madvise(memory, bytes, MADV_HUGEPAGE);  // failure is harmless
#endif
}

}}  // namespace tessera::abi_0_1
