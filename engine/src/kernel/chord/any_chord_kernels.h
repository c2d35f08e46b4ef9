#pragma once
// The kernels that unit_chord_any.cpp provides to unit_chord.cpp of the same instruction set.

#include "kernel/chord/chord_kernels.h"
#include "kernel/isa/lanes.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {

struct AnyChordKernels {
  void (*bound_chords)(const ChordJob&);
  void (*bound_rational_chords)(const ChordJob&);
  void (*bound_exact_chords)(const ExactChordJob&);
  void (*bound_products)(const ChordProductJob&);
  void (*bound_rational_products)(const ChordProductJob&);
  void (*share_of_products)(const ChordProductJob&);
};
extern const AnyChordKernels any_chord_kernels;

}}}}  // namespace tessera::abi_0_1::kernel::TESSERA_ISA_NAMESPACE
