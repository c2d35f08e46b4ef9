#include <sys/mman.h>

#include "parallel/system_pages.h"

namespace tessera { inline namespace abi_0_1 {

void fetch_pages(std::span<std::byte> memory) {
#ifdef MADV_POPULATE_WRITE
  constexpr int populate = MADV_POPULATE_WRITE;
#else
  constexpr int populate = 23;  // since Linux 5.14, in headers since glibc 2.35
#endif
  ::madvise(memory.data(), memory.size(), populate);  // older systems refuse
}

}}  // namespace tessera::abi_0_1
