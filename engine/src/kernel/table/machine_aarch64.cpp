// The kernel tables of AArch64, where every machine has NEON.

#include "kernel/table/kernel_table.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {
namespace isa_neon64 {
constexpr Isa this_isa = Isa::neon64;
#include "kernel/table/isa_tables.inl.h"
}  // namespace isa_neon64

std::span<const KernelTable* const> machine_kernels() {
  static const KernelTable* const only = &isa_neon64::table();
  return {&only, 1};
}

}}}  // namespace tessera::abi_0_1::kernel
