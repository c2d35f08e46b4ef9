// Detects which instruction sets of x86-64 this machine has.

#include <array>

#include "kernel/table/kernel_table.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {
namespace isa_sse2 {
constexpr Isa this_isa = Isa::sse2;
#include "kernel/table/isa_tables.inl.h"
}  // namespace isa_sse2
namespace isa_avx2 {
constexpr Isa this_isa = Isa::avx2;
#include "kernel/table/isa_tables.inl.h"
}  // namespace isa_avx2
namespace isa_avx512 {
constexpr Isa this_isa = Isa::avx512;
#include "kernel/table/isa_tables.inl.h"
}  // namespace isa_avx512

namespace {

struct Machine {
  std::array<const KernelTable*, 3> tables{};
  std::size_t count = 0;
};

/// Uses the compiler's test, which asks the processor and the operating system (XGETBV); xsimd's asks the processor
/// only.
Machine detect() {
  __builtin_cpu_init();
  Machine found;
  found.tables[found.count++] = &isa_sse2::table();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2) found.tables[found.count++] = &isa_avx2::table();
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    found.tables[found.count++] = &isa_avx512::table();
  return found;
}

}  // namespace

std::span<const KernelTable* const> machine_kernels() {
  static const Machine found = detect();
  return {found.tables.data(), found.count};
}

}}}  // namespace tessera::abi_0_1::kernel
