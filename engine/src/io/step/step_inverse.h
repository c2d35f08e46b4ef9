#pragma once
// Parameters of points on the surface of a face of a STEP file.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "exact/face_box.h"
#include "io/step/step_geometry.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// A surface whose points have parameters to be found: those of StepGeometry, except that profiles of sweeps and
/// splines have the parameters of their NURBS. Angles may be any number; surfaces that close are periodic.
class SurfaceInverse {
 public:
  virtual ~SurfaceInverse() = default;
  /// Makes the inverse of a surface.
  ///
  /// - `extent`: the box of points of interest.
  /// - `borders`: curves of the face's edges, for which the surface may choose its axis.
  /// - `tolerance`: points that are nearer to each other are one.
  ///
  /// Errors: those of StepGeometry::surface().
  static Result<std::unique_ptr<SurfaceInverse>> make(const StepGeometry& geometry, std::uint64_t surface,
                                                      const Box3& extent, double tolerance,
                                                      std::span<const Curve* const> borders = {});

  /// Returns how far the surface is from the file's, where it had to be fitted.
  double fit_error() const { return fit_error_; }

  /// Makes the inverse of a plane.
  static std::unique_ptr<SurfaceInverse> of_plane(const Frame& frame, double tolerance);

  /// Returns the parameters of the point of the surface that is nearest to p and to the parameters `near`. Where one
  /// parameter is undefined, as at a pole, it is that of `near`.
  virtual ParameterPoint at(const Vec3& p, const ParameterPoint& near) const = 0;
  /// Returns the parameters of the point that is nearest to p.
  virtual ParameterPoint find(const Vec3& p) const { return at(p, {}); }
  virtual Vec3 point(const ParameterPoint& place) const = 0;
  /// Returns the lengths of the derivatives by u and v, as |du| and |dv|.
  virtual ParameterPoint speeds(const ParameterPoint& place) const = 0;
  /// Makes the part of the surface over a rectangle, of at most one period.
  virtual Result<FaceSurface> surface(const Domain& box) const = 0;
  /// Returns the frame of a plane, whose parameters are its first two coordinates.
  virtual const Frame* plane() const { return nullptr; }
  /// Knots of the surface along u and v, and none where it has none.
  virtual std::array<std::vector<double>, 2> knots() const { return {}; }

  /// Returns v of the apex of a cone.
  virtual std::optional<double> apex() const { return {}; }

  const Domain& whole() const { return whole_; }            ///< infinite where it has no end
  const ParameterPoint& period() const { return period_; }  ///< 0: not periodic
  /// Whether surface() takes any range of a period: u and v are angles.
  bool turns_u() const { return turns_u_; }
  bool turns_v() const { return turns_v_; }
  /// Whether the line of all u (or v) through a place is shorter than the tolerance, so that u (or v) is undefined.
  bool is_pole_u(const ParameterPoint& place) const;
  bool is_pole_v(const ParameterPoint& place) const;

 protected:
  Domain whole_;
  ParameterPoint period_;
  bool turns_u_ = false, turns_v_ = false;
  double tolerance_ = 0, fit_error_ = 0;

 private:
  static Result<std::unique_ptr<SurfaceInverse>> make_replica(const StepGeometry& geometry, const StepReplica& replica,
                                                              const Box3& extent, double tolerance);
  static Result<std::unique_ptr<SurfaceInverse>> make_offset(const StepGeometry& geometry, const StepOffset& offset,
                                                             const Box3& extent, double tolerance);
};

}}  // namespace tessera::abi_0_1
