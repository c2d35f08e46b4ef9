// Which instruction sets this machine has, and which one a call uses.

#include <array>
#include <cstdlib>
#include <string>

#include "kernel/kernel_table.h"
#include "tessera/isa.h"

namespace tessera {
namespace {

struct Available {
  std::array<Isa, 3> isas{};
  std::size_t count = 0;
};

/// The compiler's own test asks the processor and the operating system (XGETBV); xsimd's asks the processor alone.
Available detect() {
  __builtin_cpu_init();
  Available found;
  found.isas[found.count++] = Isa::sse2;
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (avx2) found.isas[found.count++] = Isa::avx2;
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl")) {
    found.isas[found.count++] = Isa::avx512;
  }
  return found;
}

std::string available_names() {
  std::string names;
  for (const Isa isa : available_isas()) {
    if (!names.empty()) names += ", ";
    names += name(isa);
  }
  return names;
}

}  // namespace

std::string_view name(Isa isa) {
  switch (isa) {
    case Isa::sse2: return "sse2";
    case Isa::avx2: return "avx2";
    case Isa::avx512: return "avx512";
  }
  return "unknown";
}

std::span<const Isa> available_isas() {
  static const Available found = detect();
  return {found.isas.data(), found.count};
}

Result<Isa> parse_isa(std::string_view text) {
  for (const Isa isa : available_isas())
    if (text == name(isa)) return isa;
  for (const Isa isa : {Isa::sse2, Isa::avx2, Isa::avx512}) {
    if (text == name(isa))
      return Status(StatusCode::isa_unavailable,
                    "this machine lacks the instruction set \"" + std::string(text) + "\"; it has " + available_names());
  }
  return Status(StatusCode::isa_unavailable,
                "unknown instruction set \"" + std::string(text) + "\"; this machine has " + available_names());
}

Result<Isa> default_isa() {
  const char* forced = std::getenv("TESSERA_ISA");
  if (forced == nullptr || *forced == '\0') return available_isas().back();
  Result<Isa> isa = parse_isa(forced);
  if (!isa) return Status(isa.status().code(), "TESSERA_ISA: " + isa.status().message());
  return isa;
}

namespace kernel {

const KernelTable& kernels(Isa isa) {
  switch (isa) {
    case Isa::avx512: return avx512_kernels();
    case Isa::avx2: return avx2_kernels();
    case Isa::sse2: break;
  }
  return sse2_kernels();
}

const KernelTable& default_kernels() {
  const Result<Isa> isa = default_isa();
  return kernels(isa ? *isa : Isa::sse2);
}

}  // namespace kernel
}  // namespace tessera
