// Any bytes as a .rib file: read or refused, never a crash, a leak or memory beyond the file's measure.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tessera/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto model = tessera::parse_rib({reinterpret_cast<const char*>(bytes), size}, "fuzz");
  if (model.ok() && model->surfaces.empty()) __builtin_trap();
  return 0;
}
