#pragma once
// Finds the vertices of a border in a mesh.

#include "tess/plan/certified_plan.h"

namespace tessera { inline namespace abi_0_1 {

/// The vertices of a border's points k = 0 .. rate in the direction of the ring, with both corners.
class RingVertices {
 public:
  RingVertices(const CertifiedPlan& plan, std::uint32_t border)
      : rate_(plan.division(border / 4).border[border % 4].rate()),
        start_(plan.ring_vertex(border, 0)),
        second_(plan.ring_vertex(border, 1)),
        end_(plan.ring_vertex(border, rate_)),
        step_(rate_ > 2 ? plan.ring_vertex(border, 2) - second_ : 0) {}

  int rate() const { return rate_; }
  std::size_t operator()(int k) const {
    return k == 0 ? start_ : k == rate_ ? end_ : second_ + static_cast<std::size_t>(k - 1) * step_;
  }

 private:
  int rate_;
  std::size_t start_, second_, end_, step_;  ///< the step modulo 2^64
};

}}  // namespace tessera::abi_0_1
