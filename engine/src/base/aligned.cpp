#include "base/aligned.h"

#include <sys/mman.h>

namespace tessera { inline namespace abi_0_1 {

void* allocate_aligned(std::size_t bytes) {
  void* const memory = ::operator new(bytes, alignment_of(bytes));
#ifdef MADV_HUGEPAGE
  if (alignment_of(bytes) == std::align_val_t{large_page})
    (void)madvise(memory, bytes / large_page * large_page, MADV_HUGEPAGE);  // only a hint: failure is harmless
#endif
  return memory;
}

}}  // namespace tessera::abi_0_1
