#include "base/aligned.h"

#include "base/large_pages.h"

namespace tessera { inline namespace abi_0_1 {

void* allocate_aligned(std::size_t bytes) {
  void* const memory = ::operator new(bytes, alignment_of(bytes));
  if (alignment_of(bytes) == std::align_val_t{large_page}) want_large_pages(memory, bytes / large_page * large_page);
  return memory;
}

}}  // namespace tessera::abi_0_1
