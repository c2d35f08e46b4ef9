// Every AArch64 machine has NEON.

#include "kernel/kernel_table.h"

namespace tessera::kernel {

std::span<const KernelTable* const> machine_kernels() {
  static const KernelTable* const only = &neon64_kernels();
  return {&only, 1};
}

}  // namespace tessera::kernel
