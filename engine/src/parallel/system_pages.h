#pragma once
// Memory as the system hands it out, in pages that come when they are first written.

#include <cstddef>
#include <span>

namespace tessera { inline namespace abi_0_1 {

/// Fetches the pages of memory that will be written; does nothing where the system cannot. `memory` consists of whole
/// pages of 4096 bytes, and keeps what it holds.
void fetch_pages(std::span<std::byte> memory);

}}  // namespace tessera::abi_0_1
