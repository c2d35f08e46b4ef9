// Bounds of patches of any degree, and of rational ones, for certified plans: a unit beside unit_chord.cpp, compiled
// for less code. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/chord/any_chord_kernels.h"
#include "kernel/isa/lanes.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/chord/rational_chord.inl.h"
#include "kernel/chord/rational_product.inl.h"
#include "kernel/chord/exact_chord.inl.h"

}  // namespace

extern const AnyChordKernels any_chord_kernels = {
    bound_chords<Lanes<float>, 0>,   bound_rational_chords<Lanes<float>>,   bound_exact_chords<Lanes<double>>,
    bound_products<Lanes<float>, 0>, bound_rational_products<Lanes<float>>, share_of_products<Lanes<float>, 0>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
