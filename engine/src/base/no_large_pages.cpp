// Stands for large_pages.cpp on platforms without pages.

#include "base/large_pages.h"

namespace tessera { inline namespace abi_0_1 {

void want_large_pages(void*, std::size_t) noexcept {}

}}  // namespace tessera::abi_0_1
