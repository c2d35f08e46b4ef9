#pragma once
// Records of one size into a binary file, packed by all threads.

#include <cstddef>

#include "base/function_ref.h"
#include "io/output_file.h"

namespace tessera {

/// Writes `count` records of `bytes` each: pack(first, last, to) lays down the records [first, last) from `to` on, and is
/// called for pieces of them from any number of threads. Memory: 1 MiB. Errors: what `pack` throws, as a Status.
Status write_packed(OutputFile& out, std::size_t count, std::size_t bytes,
                    FunctionRef<void(std::size_t, std::size_t, char*)> pack);

}  // namespace tessera
