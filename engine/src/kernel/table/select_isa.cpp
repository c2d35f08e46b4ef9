// Chooses the instruction set of a call among those that this machine has.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "kernel/table/kernel_table.h"
#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::array<Isa, 5> all_isas{Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon64, Isa::wasm128};

struct Available {
  std::array<Isa, all_isas.size()> isas{};
  std::size_t count = 0;
};

Available list_available() {
  Available found;
  for (const kernel::KernelTable* table : kernel::machine_kernels()) found.isas[found.count++] = table->isa;
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

bool is_available(Isa isa) {
  const std::span<const Isa> available = available_isas();
  return std::find(available.begin(), available.end(), isa) != available.end();
}

Status missing(Isa isa) {
  return Status(StatusCode::isa_unavailable, "this machine lacks the instruction set \"" + std::string(name(isa)) +
                                                 "\"; it has " + available_names());
}

}  // namespace

std::string_view name(Isa isa) {
  switch (isa) {
    case Isa::sse2:
      return "sse2";
    case Isa::avx2:
      return "avx2";
    case Isa::avx512:
      return "avx512";
    case Isa::neon64:
      return "neon64";
    case Isa::wasm128:
      return "wasm128";
  }
  return "unknown";
}

std::span<const Isa> available_isas() {
  static const Available found = list_available();
  return {found.isas.data(), found.count};
}

Result<Isa> parse_isa(std::string_view text) {
  for (const Isa isa : all_isas)
    if (text == name(isa)) return is_available(isa) ? Result<Isa>(isa) : missing(isa);
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

Result<Isa> usable_isa(std::optional<Isa> wanted) {
  if (!wanted) return default_isa();
  return is_available(*wanted) ? Result<Isa>(*wanted) : parse_isa(name(*wanted));
}

namespace kernel {

const KernelTable& kernels(Isa isa) {
  for (const KernelTable* table : machine_kernels())
    if (table->isa == isa) return *table;
  return *machine_kernels().front();
}

const KernelTable& default_kernels() {
  const Result<Isa> isa = default_isa();
  return isa ? kernels(*isa) : *machine_kernels().front();
}

}  // namespace kernel

const kernel::RayKernels& ray_kernels(Isa isa) { return kernel::kernels(isa); }

}}  // namespace tessera::abi_0_1
