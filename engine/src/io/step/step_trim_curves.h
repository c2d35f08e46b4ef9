#pragma once
// Curves of edges in the parameters of their face.

#include <array>

#include "exact/face_box.h"
#include "exact/swept_surface.h"
#include "io/step/step_trace.h"
#include "tessera/brep.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes the curves of one face.
///
/// - On planes: exact.
/// - Along one parameter: straight, with the relation to the edge's parameter that Coedge::parameter states, exact for
///   lines and circles.
/// - Others: polynomials of degree 7 by the edge's own parameter, within `tolerance` of the nearest points of the
///   surface, as sampled.
class TrimCurveMaker {
 public:
  /// References must outlive the object.
  TrimCurveMaker(const SurfaceInverse& inverse, const Reparametrization& parameters, const FaceBox& box,
                 double tolerance)
      : inverse_(inverse), parameters_(parameters), box_(box), tolerance_(tolerance) {}

  /// Appends the curve of a piece, and its coedge, to a loop. `edge`: the piece's; not used along poles. Errors: those
  /// of Curve.
  Status append(const EdgeTrace& piece, const BrepEdge* edge, TrimLoop& loop);
  /// Whether a curve reached the limit of its points before it was near enough.
  bool is_rough() const { return is_rough_; }

 private:
  Result<Curve> curve_of(const EdgeTrace& piece, const BrepEdge* edge, Coedge& coedge);
  ParameterPoint ours(const ParameterPoint& theirs) const;
  double our(bool along_u, double theirs) const;
  const ParameterPoint* sampled(const EdgeTrace& piece, double s, double rounding) const;
  ParameterPoint near(const EdgeTrace& piece, double s) const;
  bool is_constant(const EdgeTrace& piece, bool along_u, double& value) const;
  bool is_linear(const EdgeTrace& piece, bool along_u) const;
  Result<Curve> on_plane(const EdgeTrace& piece, const Curve& edge, const Frame& frame) const;
  Result<Curve> straight(const EdgeTrace& piece, const Curve& edge, bool along_u, double constant,
                         Coedge& coedge) const;
  Result<Curve> fitted(const EdgeTrace& piece, const Curve& edge, const double* constant_u, const double* constant_v);
  Result<Curve> kept_inside(const Curve& curve) const;
  std::vector<double> crossings(const EdgeTrace& piece, const Curve& edge, bool along_u) const;

  const SurfaceInverse& inverse_;
  const Reparametrization& parameters_;
  const FaceBox& box_;
  double tolerance_;
  bool is_rough_ = false;
};

}}  // namespace tessera::abi_0_1
