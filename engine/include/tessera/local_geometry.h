#pragma once
// Local geometry: fundamental forms, curvatures, principal directions; how far a net of isocurves is from orthogonal
// and conjugate. One point at a time, in double.
//
// Memory: measure_net() allocates for the call, the others nothing. Threads: any number of calls at once.

#include <array>
#include <cstdint>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A direction of principal curvature.
struct PrincipalDirection {
  double curvature = 0;                ///< curvature of the normal section in this direction
  Vec3 direction;                      ///< unit tangent
  std::array<double, 2> parameters{};  ///< (du, dv) with r_u du + r_v dv = direction
};

/// Local geometry at a point. Undefined figures are zero, never NaN. Signs follow the normal r_u x r_v / |r_u x r_v|: a
/// surface that bends towards it has positive curvatures.
struct LocalGeometry {
  UnitNormal normal;                 ///< unit, or zero
  bool defined = false;              ///< whether the forms and figures made of them are defined
  double e = 0, f = 0, g = 0;        ///< first form: r_u.r_u, r_u.r_v, r_v.r_v
  double l = 0, m = 0, n = 0;        ///< second form: r_uu.N, r_uv.N, r_vv.N
  double gaussian = 0, mean = 0;     ///< K = k1 k2, H = (k1 + k2) / 2
  PrincipalDirection first, second;  ///< k1 >= k2; first.direction x second.direction = N
  bool umbilic = false;              ///< k1 = k2 within tolerance: all tangents are principal, the directions arbitrary
};

/// Kind of a point by its principal curvatures.
enum class CurvatureKind : std::uint8_t {
  distinct,   ///< k1 > k2
  umbilic,    ///< k1 = k2 within tolerance: all tangents are principal, the directions arbitrary
  undefined,  ///< no forms and no curvatures; they are zero
};

/// Limits of undefined and umbilic points.
struct LocalGeometryOptions {
  double min_sine = 1e-10;          ///< smallest sine of the angle between r_u and r_v; undefined at or below it
  double umbilic_tolerance = 1e-9;  ///< (k1 - k2) / (|k1| + |k2|) at or below which a point is umbilic
};

/// Returns the local geometry of a jet. The shape operator is taken in an orthonormal basis of the tangent plane, where
/// it is symmetric: k1 and k2 suffer neither from H^2 - K nor from skew or unequal tangents. Undefined: parallel or
/// vanishing tangents, figures out of range. (Weingarten equations: do Carmo, Differential Geometry of Curves and
/// Surfaces, sec. 3.3.)
LocalGeometry local_geometry(const SurfaceJet& jet, const LocalGeometryOptions& options = {});

/// Returns the local geometry at (u,v) in [0,1]^2 of a patch. Where r_u x r_v vanishes, `normal` is the limit normal if
/// there is one, and the rest is undefined.
LocalGeometry local_geometry(const BezierPatch& patch, double u, double v, const LocalGeometryOptions& options = {});

/// Options of measure_net().
struct NetOptions {
  int samples = 17;          ///< points in each direction, equally spaced, ends included; 2 to 1,000
  double tolerance = 1e-12;  ///< for `orthogonal` and `conjugate`
};

/// How far the isocurves of a patch are from an orthogonal net (r_u . r_v = 0) and a conjugate one (r_uv . N = 0).
struct NetReport {
  double largest_cosine = 0;           ///< largest |cosine| of the angle between r_u and r_v over the samples
  double largest_mixed_curvature = 0;  ///< largest |r_uv . N| / (|r_u| |r_v|) over the samples
  int undefined_samples = 0;           ///< samples without a regular normal, left out of both
  double dot_bound = 0;                ///< proven: |r_u . r_v| is nowhere larger
  double volume_bound = 0;             ///< proven: |det(r_u, r_v, r_uv)| = |r_uv . N| |r_u x r_v| is nowhere larger
  /// Everywhere: the Bernstein coefficients of r_u . r_v are at most `tolerance` times the largest of r_u times the
  /// largest of r_v.
  bool orthogonal = false;
  /// Conjugate everywhere: likewise for det(r_u, r_v, r_uv), where r_uv counts for no less than the larger of r_u and
  /// r_v.
  bool conjugate = false;
};
/// Measures the net of isocurves. Bounds are largest Bernstein coefficients (rational patches: of numerators, over
/// powers of the smallest weight). Errors: invalid_argument (samples, tolerance).
Result<NetReport> measure_net(const BezierPatch& patch, const NetOptions& options = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
