#pragma once
// Large pages of memory.

#include <cstddef>

namespace tessera { inline namespace abi_0_1 {

/// Asks the system for large pages behind this memory: only a hint.
void want_large_pages(void* memory, std::size_t bytes) noexcept;

}}  // namespace tessera::abi_0_1
