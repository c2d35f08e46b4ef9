// Bounds, rates and hashes for certified plans. One unit per instruction set: see cmake/TesseraIsaFlags.cmake.

#include "kernel/chord/any_chord_kernels.h"
#include "kernel/chord/chord_kernels.h"
#include "kernel/isa/lanes.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {
namespace {

#include "kernel/chord/chord_product.inl.h"
#include "kernel/chord/rate_search.inl.h"
#include "kernel/chord/border_hash.inl.h"

/// Bicubic patches have loops of their own.
template <class Job>
bool is_bicubic(const Job& job) {
  return job.degree_u == 3 && job.degree_v == 3;
}
void bound_chords_of_block(const ChordJob& job) {
  is_bicubic(job) ? bound_chords<Lanes<float>, 3>(job) : any_chord_kernels.bound_chords(job);
}
void bound_rational_chords_of_block(const ChordJob& job) { any_chord_kernels.bound_rational_chords(job); }
void bound_exact_chords_of_block(const ExactChordJob& job) { any_chord_kernels.bound_exact_chords(job); }
void bound_products_of_block(const ChordProductJob& job) {
  is_bicubic(job) ? bound_products<Lanes<float>, 3>(job) : any_chord_kernels.bound_products(job);
}
void bound_rational_products_of_block(const ChordProductJob& job) { any_chord_kernels.bound_rational_products(job); }
void share_of_products_of_block(const ChordProductJob& job) {
  is_bicubic(job) ? share_of_products<Lanes<float>, 3>(job) : any_chord_kernels.share_of_products(job);
}

}  // namespace

extern const ChordKernels chord_kernels = {
    hash_borders<Lanes<float>>,       match_borders<Lanes<float>>, bound_chords_of_block,
    bound_rational_chords_of_block,   bound_exact_chords_of_block, bound_products_of_block,
    bound_rational_products_of_block, share_of_products_of_block,  find_rates<Lanes<float>>,
};

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
