#pragma once
// Checks that the code of one instruction set has only names of its own. Otherwise a function that the linker may merge
// with one of the same name in another unit (weak), or that others may call (global), would bring AVX-512 into the
// baseline.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::house {

/// The marks of a symbol of one ISA's units, those of the targets tessera_kernel_ISA and tessera_kernel_ISA_mesh.
struct IsaUnit {
  std::string_view isa;            ///< tessera::kernel::isa_ISA::
  std::string_view architectures;  ///< the architectures of xsimd for this ISA, as a regular expression
};

/// The unit whose object file has this path, if any.
std::optional<IsaUnit> isa_unit_of(std::string_view object_path);

/// `listing` is the output of `nm -C --defined-only` for the unit's object. Returns the functions that are not the
/// unit's own: neither in its namespace nor templates over its xsimd architecture, or over another unit's.
std::vector<std::string> foreign_functions(const IsaUnit& unit, std::string_view listing);

}  // namespace tessera::house
