#pragma once
// Records of one size into a binary file, packed by all threads.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/function_ref.h"
#include "io/file/output_file.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Takes bytes one after the other. Returns false once no more are wanted.
using PackedSink = FunctionRef<bool(std::string_view)>;

/// Writes `count` records of `bytes` each. pack(first, last, to) stores the records [first, last) from `to` on, and is
/// called for pieces of them from any number of threads. Memory: 2 MiB. Errors: what `pack` throws, as a Status.
Status write_packed(PackedSink write, std::size_t count, std::size_t bytes,
                    FunctionRef<void(std::size_t, std::size_t, char*)> pack);
/// Writes to a file.
Status write_packed(OutputFile& out, std::size_t count, std::size_t bytes,
                    FunctionRef<void(std::size_t, std::size_t, char*)> pack);

/// Stores three floats at `to`, one by one: to fill an array and copy it takes half as long again, because the copy
/// reads before the stores are done.
inline void put_floats(const Vec3& v, char* to) {
  const float x = static_cast<float>(v.x), y = static_cast<float>(v.y), z = static_cast<float>(v.z);
  std::memcpy(to, &x, sizeof x);
  std::memcpy(to + 4, &y, sizeof y);
  std::memcpy(to + 8, &z, sizeof z);
}

}}  // namespace tessera::abi_0_1
