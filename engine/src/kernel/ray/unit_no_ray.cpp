// Stands for unit_ray.cpp in builds without tessera::ray, where nothing calls its kernels.

#include "kernel/isa/lanes.h"
#include "kernel/ray/ray_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {

extern const RayKernels ray_kernels{};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
