#pragma once
// Curves and surfaces of a STEP file (ISO 10303-42) as exact NURBS.
//
// Parameters are the entity's own, with angles in radians and lengths in the model's unit, as OpenCASCADE has them: a
// line and the straight direction of an extrusion are measured by their length, a cone's v along its generator, and a
// parabola's parameter is the distance from its axis. Splines keep the parameters of the file.

#include <cstdint>
#include <optional>
#include <vector>

#include "io/exact/spline_line.h"
#include "io/exact/swept_surface.h"
#include "io/step/step_entity.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The units and the dimension of a file's geometry.
struct StepUnits {
  double length = 1;  ///< the model's units in one of the file's; > 0
  double angle = 1;   ///< radians in one of the file's; > 0
  int dimension = 3;  ///< 2: curves in a surface's parameters, with z = 0
};

struct StepCurve {
  Curve curve;
  std::optional<Arcs> arcs;  ///< maps the entity's parameter, an angle, to the curve's; empty: they are equal
};

/// Converts the geometry of a file. Threads: any number of calls at once.
///
/// Errors of all calls name the instance and its line: parse_error (an attribute that is missing, or of the wrong type,
/// count or value; a reference to nothing or to the wrong kind; a chain of more than 32 instances, such as a cycle),
/// invalid_argument (a range that is empty, or too long), unsupported (kinds that have no exact form), and those of
/// Curve and BSplineSurface.
class StepGeometry {
 public:
  /// The index must outlive the object.
  explicit StepGeometry(const StepIndex& index, const StepUnits& units = {}) : index_(index), units_(units) {}

  Result<Vec3> point(std::uint64_t number) const;
  Result<Vec3> direction(std::uint64_t number) const;  ///< of unit length
  /// Returns the axes of AXIS2_PLACEMENT_3D, AXIS2_PLACEMENT_2D and AXIS1_PLACEMENT. Where the file has no direction,
  /// or two that are parallel, the axes are those of ISO 10303-42, 4.4.
  Result<Frame> placement(std::uint64_t number) const;
  /// Converts a curve over an interval of its parameter. Without one: all of the curve, if that is bounded. Trimmed
  /// curves have the parameter of the curve that they trim, negated if they run against it; an interval may go beyond
  /// the trims.
  Result<StepCurve> curve(std::uint64_t number, const std::optional<Interval>& range = {}) const;
  /// Converts a surface over a rectangle of its parameters. Without one: all of the surface, if that is bounded.
  Result<FaceSurface> surface(std::uint64_t number, const std::optional<Domain>& box = {}) const;

 private:
  static constexpr int max_depth = 32;  ///< of curves and surfaces that are made of others
  using Range = std::optional<Interval>;

  Result<std::vector<Vec3>> points(StepEntity& owner, std::size_t list) const;
  Result<Vec3> direction_or(StepEntity& owner, std::size_t at, const Vec3& otherwise) const;
  Result<Vec3> vector(std::uint64_t number) const;
  Result<SplineLine> line(std::uint64_t number, const Range& range, int depth) const;
  Result<SplineLine> straight(StepEntity& entity, const Range& range) const;
  Result<SplineLine> conic(StepEntity& entity, const Range& range) const;
  Result<SplineLine> spline(StepEntity& entity, const Range& range) const;
  Result<SplineLine> trimmed(StepEntity& entity, const Range& range, int depth) const;
  Result<double> trim(StepEntity& entity, std::size_t k, std::uint64_t basis, double scale) const;
  Result<double> inverted(StepEntity& basis, const Vec3& p) const;
  /// Returns the factor of the file's parameter of a curve to ours.
  Result<double> curve_scale(std::uint64_t number, int depth) const;
  Result<Domain> trim_scales(std::uint64_t number, int depth) const;
  Result<FaceSurface> face(std::uint64_t number, const std::optional<Domain>& box, int depth) const;
  Result<FaceSurface> elementary(StepEntity& entity, const std::optional<Domain>& box) const;
  Result<FaceSurface> swept(StepEntity& entity, const std::optional<Domain>& box, int depth) const;
  Result<FaceSurface> spline_face(StepEntity& entity, const std::optional<Domain>& box) const;
  Result<FaceSurface> trimmed_face(StepEntity& entity, const std::optional<Domain>& box, int depth) const;

  const StepIndex& index_;
  StepUnits units_;
};

}}  // namespace tessera::abi_0_1
