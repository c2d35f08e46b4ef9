#pragma once
// Child processes of a process that has computed.

namespace tessera { inline namespace abi_0_1 {

/// Whether this process was forked after the first call of this function: the threads of the work then are its
/// parent's. Threads: any.
bool is_forked();

}}  // namespace tessera::abi_0_1
