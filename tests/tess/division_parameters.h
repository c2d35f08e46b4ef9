#pragma once
// The parameters of a division's vertices, in the order in which a patch's vertices lie in a mesh.

#include "tess/cells/stitched_patch.h"

namespace tessera::test {

/// Calls visit(u, v) for each vertex, in order: inner points `[iu][iv]`, then the ring counter-clockwise from (0, 0).
template <class Visit>
void for_parameters(const Division& division, Visit visit) {
  const auto& [inner, border] = std::pair(division.inner, division.border);
  for (int iu = 1; iu < inner.u.rate(); ++iu)
    for (int iv = 1; iv < inner.v.rate(); ++iv) visit(inner.u.at(iu).value(), inner.v.at(iv).value());
  for (int k = 0; k < border[0].rate(); ++k) visit(border[0].at(k).value(), 0.0);
  for (int k = 0; k < border[1].rate(); ++k) visit(1.0, border[1].at(k).value());
  for (int k = border[2].rate(); k > 0; --k) visit(border[2].at(k).value(), 1.0);
  for (int k = border[3].rate(); k > 0; --k) visit(0.0, border[3].at(k).value());
}

}  // namespace tessera::test
