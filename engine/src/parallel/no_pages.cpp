// For systems that have no call for it.

#include "parallel/system_pages.h"

namespace tessera { inline namespace abi_0_1 {

void fetch_pages(std::span<std::byte>) {}

}}  // namespace tessera::abi_0_1
