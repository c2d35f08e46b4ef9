// Bounds, rates and hashes for certified plans. One unit an instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/chord_kernels.h"
#include "kernel/lanes.h"

namespace tessera::kernel::TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/index_vector.inl.h"
#include "kernel/chord_kernel.inl.h"
#include "kernel/chord_product.inl.h"
#include "kernel/rational_nets.inl.h"
#include "kernel/rational_chord.inl.h"
#include "kernel/rational_product.inl.h"
#include "kernel/rate_search.inl.h"
#include "kernel/border_hash.inl.h"

}  // namespace

extern const ChordKernels chord_kernels = {
    hash_borders<Lanes<float>>,
    match_borders<Lanes<float>>,
    bound_chords<Lanes<float>>,
    bound_rational_chords<Lanes<float>>,
    bound_products<Lanes<float>>,
    bound_rational_products<Lanes<float>>,
    share_of_products<Lanes<float>>,
    find_rates<Lanes<float>>,
};

}  // namespace tessera::kernel::TESSERA_ISA_NAMESPACE
