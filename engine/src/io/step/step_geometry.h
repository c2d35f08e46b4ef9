#pragma once
// Surfaces of a STEP file (ISO 10303-42) as exact NURBS.
//
// Parameters are the entity's own, with angles in radians and lengths in the model's unit, as OpenCASCADE has them: the
// straight direction of an extrusion is measured by its length, and a cone's v along its generator. Splines keep the
// parameters of the file.

#include <cstdint>
#include <optional>

#include "exact/swept_surface.h"
#include "io/step/step_curves.h"

namespace tessera { inline namespace abi_0_1 {

enum class StepElementaryKind : std::uint8_t { plane, cylinder, cone, sphere, torus };

/// A plane, cylinder, cone, sphere or torus.
struct StepElementary {
  StepElementaryKind kind = StepElementaryKind::plane;
  Frame frame;
  double radius = 0;      ///< a torus's is that of the circle of its centres
  double minor = 0;       ///< of a torus
  double half_angle = 0;  ///< of a cone
  Domain whole;           ///< all parameters; infinite where the surface has no end
};

/// Makes the surface over a rectangle of its parameters; angles span at most a full turn. Errors: those of
/// BSplineSurface.
Result<FaceSurface> elementary_surface(const StepElementary& of, const Domain& box);

/// A surface of revolution, about z of the frame, or of extrusion.
struct StepSweep {
  bool is_turned = false;
  SplineLine profile;  ///< of a revolution: in the frame's coordinates
  Frame frame;         ///< of a revolution
  Vec3 direction;      ///< of an extrusion; of unit length
};

/// A surface at a distance from another, along its normal.
struct StepOffset {
  std::uint64_t basis = 0;  ///< instance of the other surface
  double distance = 0;      ///< in the model's unit
};

/// A copy of a surface at another place.
struct StepReplica {
  std::uint64_t parent = 0;  ///< instance of the surface
  Affine map;                ///< of space; scales evenly
};

/// Converts the geometry of a file. Threads: any number of calls at once. Errors: those of StepCurves and
/// BSplineSurface.
class StepGeometry : public StepCurves {
 public:
  using StepCurves::StepCurves;

  /// Returns the instance of a surface without rectangles that trim it.
  std::uint64_t bare_surface(std::uint64_t number) const;
  /// Reads a plane, cylinder, cone, sphere or torus; nothing for other kinds.
  Result<std::optional<StepElementary>> elementary(std::uint64_t number) const;
  /// Reads a circle that is extruded along its axis, or a line that is revolved, as the cylinder or the cone that they
  /// are; nothing for other surfaces, nor where the parameters would differ.
  Result<std::optional<StepElementary>> elementary_sweep(std::uint64_t number, const Box3& extent) const;
  /// Reads a surface of revolution or of extrusion; nothing for other kinds.
  ///
  /// - `extent`: the box of points of interest, which bounds profiles without ends.
  Result<std::optional<StepSweep>> sweep(std::uint64_t number, const Box3& extent) const;
  /// Reads a copy of a surface; nothing for other kinds.
  Result<std::optional<StepReplica>> replica(std::uint64_t number) const;
  /// Reads an offset surface; nothing for other kinds.
  Result<std::optional<StepOffset>> offset(std::uint64_t number) const;
  /// Converts a surface over a rectangle of its parameters. Without one: all of the surface, if that is bounded.
  Result<FaceSurface> surface(std::uint64_t number, const std::optional<Domain>& box = {}) const;

 private:
  Result<Domain> trim_scales(std::uint64_t number, int depth) const;
  Result<FaceSurface> face(std::uint64_t number, const std::optional<Domain>& box, int depth) const;
  Result<StepElementary> elementary(StepEntity& entity) const;
  Result<std::optional<StepElementary>> extruded_circle(std::uint64_t number) const;
  Result<FaceSurface> elementary(StepEntity& entity, const std::optional<Domain>& box) const;
  Result<FaceSurface> swept(StepEntity& entity, const std::optional<Domain>& box, int depth) const;
  Result<FaceSurface> spline_face(StepEntity& entity, const std::optional<Domain>& box) const;
  Result<FaceSurface> trimmed_face(StepEntity& entity, const std::optional<Domain>& box, int depth) const;
};

}}  // namespace tessera::abi_0_1
