// Control nets, memory, and the machine's limits. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/isa/lanes.h"
#include "kernel/store/memory_kernels.h"
#include "kernel/net/net_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/net/net_kernel.inl.h"
#include "kernel/store/memory_kernels.inl.h"

}  // namespace

extern const NetKernels net_kernels = {
    pack_nets<float>, pack_nets<double>, bound_nets, bound_points, all_within, combine_rows,
};
extern const MemoryKernels memory_kernels = {
    fma_rate<Lanes<float>>,
    fma_rate<Lanes<double>>,
    fill_memory<Lanes<float>>,
    finish_streaming<Lanes<float>>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
