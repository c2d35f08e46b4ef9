#pragma once
// The code of one instruction set must be found under its own name alone. A function that the linker may merge with one of
// the same name in another unit (weak), or that others may call (global), would else bring AVX-512 into the baseline.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::house {

/// What marks a symbol of the units of one ISA, those of the targets tessera_kernel_ISA and tessera_kernel_ISA_mesh, as its own.
struct IsaUnit {
  std::string_view isa;            ///< tessera::kernel::isa_ISA::
  std::string_view architectures;  ///< those of xsimd that are of this ISA, as a regular expression
};

/// The unit whose object file has this path, if any.
std::optional<IsaUnit> isa_unit_of(std::string_view object_path);

/// `listing` is what `nm -C --defined-only` prints for the unit's object. Returns the functions that are not its own: neither
/// in its namespace nor templates over its xsimd architecture, or over another unit's.
std::vector<std::string> foreign_functions(const IsaUnit& unit, std::string_view listing);

}  // namespace tessera::house
