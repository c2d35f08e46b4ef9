#pragma once
// Curves of a STEP file (ISO 10303-42) as exact NURBS.
//
// Parameters are the entity's own, with angles in radians and lengths in the model's unit, as OpenCASCADE has them: a
// line is measured by its length, and a parabola's parameter is the distance from its axis. Splines keep the parameters
// of the file. Within an arc of a hyperbola, the parameter is another one.

#include <array>
#include <cstdint>
#include <optional>

#include "exact/spline_line.h"
#include "io/step/step_points.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

struct StepCurve {
  Curve curve;
  std::optional<Arcs> arcs;  ///< maps the entity's parameter, an angle, to the curve's; empty: they are equal
};

/// The curve of an edge.
struct StepEdgeCurve {
  Curve curve;
  bool reversed = false;  ///< whether it runs from the edge's end to its start
};

/// Tells whether a curve is a curve on surfaces: SURFACE_CURVE, SEAM_CURVE, INTERSECTION_CURVE.
bool is_step_wrapper(const StepEntity& entity);
/// Returns the curve that a trimmed curve or a curve on surfaces is a part of.
std::uint64_t inner_step_curve(StepEntity& entity);

/// Converts curves of a file. Threads: any number of calls at once.
///
/// Errors: those of StepPoints; invalid_argument (a range that is empty, or too long), unsupported (kinds that have no
/// exact form), and those of Curve.
class StepCurves : public StepPoints {
 public:
  using StepPoints::StepPoints;

  /// Converts a curve over an interval of its parameter. Without one: all of the curve, if that is bounded. Trimmed
  /// curves have the parameter of the curve that they trim, negated if they run against it; an interval may go beyond
  /// the trims.
  Result<StepCurve> curve(std::uint64_t number, const std::optional<Interval>& range = {}) const;
  /// Converts the part of a curve between two points near it, the ends of an edge. Equal points: all of a closed curve.
  ///
  /// - `agrees`: whether the edge runs along the curve. It decides between the two parts of a closed curve; on other
  ///   curves the order of the points does.
  /// - `tolerance`: points of one place differ by at most so much; > 0.
  Result<StepEdgeCurve> edge_curve(std::uint64_t number, const std::array<Vec3, 2>& ends, bool agrees,
                                   double tolerance) const;

 protected:
  using Range = std::optional<Interval>;

  Result<SplineLine> line(std::uint64_t number, const Range& range, int depth) const;
  /// Returns the factor of the file's parameter of a curve to ours.
  Result<double> curve_scale(std::uint64_t number, int depth) const;
  /// Returns the range of a profile that a sweep needs, which is empty where the profile has ends.
  ///
  /// - `axis`: about which it turns, or nullptr.
  /// - `direction`: along which it moves, if there is no axis.
  Result<Interval> profile_range(std::uint64_t number, const Frame* axis, const Vec3& direction,
                                 const Box3& extent) const;

 private:
  Result<SplineLine> straight(StepEntity& entity, const Range& range) const;
  Result<SplineLine> conic(StepEntity& entity, const Range& range) const;
  Result<SplineLine> spline(StepEntity& entity, const Range& range) const;
  Result<SplineLine> trimmed(StepEntity& entity, const Range& range, int depth) const;
  Result<double> trim(StepEntity& entity, std::size_t k, std::uint64_t basis, double scale) const;
  Result<double> inverted(StepEntity& basis, const Vec3& p) const;
  Result<StepEdgeCurve> edge_of(StepEntity& entity, const std::array<Vec3, 2>& ends, bool agrees,
                                double tolerance) const;
  Result<StepEdgeCurve> open_edge(StepEntity& entity, const std::array<Vec3, 2>& ends) const;
  Result<StepEdgeCurve> round_edge(StepEntity& entity, std::array<Vec3, 2> ends, bool agrees, double tolerance) const;
  Result<StepEdgeCurve> spline_edge(StepEntity& entity, std::array<Vec3, 2> ends, bool agrees, double tolerance) const;
  Result<Vec3> growing_direction(StepEntity& curve) const;
};

}}  // namespace tessera::abi_0_1
