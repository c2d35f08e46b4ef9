// The kernel tables of WebAssembly: a module with SIMD loads only where SIMD exists.

#include "kernel/table/kernel_table.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {
namespace isa_wasm128 {
constexpr Isa this_isa = Isa::wasm128;
#include "kernel/table/isa_tables.inl.h"
}  // namespace isa_wasm128

std::span<const KernelTable* const> machine_kernels() {
  static const KernelTable* const only = &isa_wasm128::table();
  return {&only, 1};
}

}}}  // namespace tessera::abi_0_1::kernel
