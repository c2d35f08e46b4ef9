#pragma once
// The table of the kernels of one instruction set: plain function pointers over raw memory. Callers validate; kernels
// assume. Each family's header describes its inputs; a family has one unit per instruction set.

#include <optional>
#include <span>

#include "base/internal_export.h"
#include "kernel/chord/chord_kernels.h"
#include "kernel/grid/flat_kernels.h"
#include "kernel/grid/grid_kernels.h"
#include "kernel/grid/line_kernels.h"
#include "kernel/mesh/mesh_kernels.h"
#include "kernel/net/net_kernels.h"
#include "kernel/point/point_kernels.h"
#include "kernel/ray/ray_kernels.h"
#include "kernel/store/memory_kernels.h"
#include "tessera/execution.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

struct KernelTable : GridKernels,
                     DoubleGridKernels,
                     FlatKernels,
                     LineKernels,
                     NetKernels,
                     PointKernels,
                     ChordKernels,
                     MeshKernels,
                     RayKernels,
                     MemoryKernels {
  Isa isa;
};

/// Returns the kernels of every ISA that processor and operating system support, slowest first; at least one.
std::span<const KernelTable* const> machine_kernels();

/// Returns the kernels of default_isa(), or the baseline's if TESSERA_ISA names none. For kernels that compute the same
/// bits on all.
const KernelTable& default_kernels();

/// Returns the kernels of an ISA, which must be one that available_isas() lists.
const KernelTable& kernels(Isa isa);

}}}  // namespace tessera::abi_0_1::kernel

namespace tessera { inline namespace abi_0_1 {

/// Returns the instruction set of a call: the wanted one, or default_isa(). Errors: isa_unavailable.
TESSERA_INTERNAL_EXPORT Result<Isa> usable_isa(std::optional<Isa> wanted);

/// Returns the kernels of rays, for the library of rays: the namespace `kernel` stays inside the core.
TESSERA_INTERNAL_EXPORT const kernel::RayKernels& ray_kernels(Isa isa);

}}  // namespace tessera::abi_0_1
