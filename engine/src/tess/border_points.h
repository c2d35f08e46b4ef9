#pragma once
// The points of border curves: the same bits in every patch that has the border, whichever way it runs there.

#include <map>
#include <utility>

#include "base/aligned.h"
#include "block/patch_set_impl.h"
#include "tess/shared_edges.h"
#include "tessera/views.h"

namespace tessera {

/// Tables of symmetric_weights() for the degrees and rates that are in use.
class BorderWeights {
 public:
  void add(int degree, int rate);
  const float* of(int degree, int rate) const { return tables_.at({degree, rate}).data(); }  ///< once added

 private:
  std::map<std::pair<int, int>, AlignedVector<float>> tables_;
};

/// Writes the points at k / rate, k = 0 .. rate - 1, of a border that runs as the ring does: counter-clockwise around the
/// patch's parameters. Positions are relative to the set's origin; `out` begins at the first. A corner is its control
/// point, and so is every point of a collapsed border. The sum pairs the control points i and n - i by separate
/// multiplications and additions, as border_kernel.inl.h does, so that the other way gives the same bits.
void write_border(const PatchSet::Impl& set, std::size_t patch, Side side, int rate, const BorderWeights& weights,
                  const View3<float>& out, std::size_t first);

}  // namespace tessera
