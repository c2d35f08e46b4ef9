#pragma once
// Edges of a face as lines in the parameters of its surface, sampled.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exact/spline_jets.h"
#include "io/step/step_inverse.h"
#include "io/step/step_topology.h"
#include "tessera/brep.h"

namespace tessera { inline namespace abi_0_1 {

/// A place of an edge: its parameter, and those of the surface.
struct TraceSample {
  double s = 0;
  ParameterPoint place;
};

/// One piece of a loop: an edge, or a straight line along a pole.
struct EdgeTrace {
  std::uint32_t edge = no_id;        ///< no_id: along a pole
  std::uint32_t vertex = no_id;      ///< of a pole
  bool reversed = false;             ///< whether the loop runs against the edge's curve
  std::vector<TraceSample> samples;  ///< in the loop's order; the places go on from piece to piece
  bool starts_at_pole = false, ends_at_pole = false;

  const ParameterPoint& first() const { return samples.front().place; }
  const ParameterPoint& last() const { return samples.back().place; }
};

/// Returns the parameter u (or v) that an edge has all along, up to a length; nothing if it has none.
std::optional<double> constant_parameter(const SurfaceInverse& inverse, const EdgeTrace& piece, bool along_u,
                                         double tolerance);

/// A loop of a face.
struct LoopTrace {
  bool is_outer = false;
  std::vector<EdgeTrace> pieces;
  ParameterPoint winding;  ///< how many times it goes around the surface along u and v
};

/// Follows edges on one surface.
class EdgeTracer {
 public:
  /// - `agrees`: whether loops run counter-clockwise in the surface's parameters, as they do about the face's normal.
  EdgeTracer(const SurfaceInverse& inverse, std::span<const BrepEdge> edges, bool agrees)
      : inverse_(inverse), edges_(edges), agrees_(agrees) {}

  /// Follows a loop, whose edges must have curves.
  ///
  /// - `reversed_curves`: of each edge, whether its curve runs from the file's end of it to its start.
  LoopTrace loop(const StepBound& bound, const std::vector<bool>& reversed_curves) const;

 private:
  EdgeTrace trace(std::uint32_t edge, bool reversed, const std::optional<ParameterPoint>& near) const;
  void follow(const FastCurve& curve, double to, std::vector<TraceSample>& samples, int depth) const;
  void settle_pole(const FastCurve& curve, EdgeTrace& trace, bool at_end) const;
  std::optional<EdgeTrace> along_pole(const EdgeTrace& before, const EdgeTrace& after, bool is_closing) const;
  bool is_pole(const ParameterPoint& place) const { return inverse_.is_pole_u(place) || inverse_.is_pole_v(place); }

  const SurfaceInverse& inverse_;
  std::span<const BrepEdge> edges_;
  bool agrees_;
};

}}  // namespace tessera::abi_0_1
