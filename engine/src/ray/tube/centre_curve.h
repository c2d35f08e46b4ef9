#pragma once
// The curve in the middle of an edge's tubes, and its points near those of other faces.

#include <cstddef>
#include <span>
#include <vector>

#include "ray/tube/edge_tubes.h"

namespace tessera { inline namespace abi_0_1 {

/// Refers to the chords of a curve, in the order of the edge's parameters.
class CentreCurve {
 public:
  /// A point of the curve.
  struct Place {
    std::size_t chord;
    LoopPoint point;
    /// Returns a bound on the distance of another point, whose place is unsure too.
    double distance(const LoopPoint& other) const {
      return length(point.position - other.position) + point.unsure + other.unsure;
    }
  };

  /// `chords` must not be empty.
  CentreCurve(const EdgeCurves& curves, const EdgeCurve& curve, std::span<const TubeChord> chords);

  std::size_t chord_of(double s) const;
  /// Returns the point at a parameter of the edge.
  Place at(double s) const { return {chord_of(s), curves_.at(curve_, s)}; }
  /// Returns a point near another one, no farther from it than the one at the parameter s. It is the nearest one of the
  /// chord at which distances from chords stop to shrink, from s on.
  Place nearest(const LoopPoint& point, double s) const;

 private:
  const EdgeCurves& curves_;
  const EdgeCurve& curve_;
  std::span<const TubeChord> chords_;
  std::vector<double> ends_;  ///< the edge's parameters at the ends of chords
};

}}  // namespace tessera::abi_0_1
