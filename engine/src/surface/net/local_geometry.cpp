#include "tessera/local_geometry.h"

#include <cmath>

// With r_u = a e1 and r_v = b e1 + c e2 in an orthonormal basis e1, e2 of the tangent plane, the second form in it is S
// = J^-T II J^-1, J = [[a, b], [0, c]] (do Carmo, Differential Geometry of Curves and Surfaces, sec. 3.3).

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The basis with r_u = a e1, r_v = b e1 + c e2.
struct TangentBasis {
  Vec3 e1, e2, normal;
  double a = 0, b = 0, c = 0;
};

bool tangent_basis(const SurfaceJet& jet, double min_sine, TangentBasis& basis) {
  const Vec3 u = normalized(jet.du), v = normalized(jet.dv);
  const Vec3 across = cross(u, v);
  if (!(length(across) > min_sine)) return false;
  basis.normal = normalized(across);
  basis.e1 = u;
  basis.e2 = normalized(cross(basis.normal, u));
  basis.a = dot(jet.du, basis.e1);
  basis.b = dot(jet.dv, basis.e1);
  basis.c = dot(jet.dv, basis.e2);
  return basis.a > 0 && basis.c > 0;
}

PrincipalDirection principal(const TangentBasis& basis, double curvature, double cosine, double sine) {
  const double dv = sine / basis.c;
  return {curvature, cosine * basis.e1 + sine * basis.e2, {(cosine - basis.b * dv) / basis.a, dv}};
}

void add_curvatures(const TangentBasis& t, double umbilic_tolerance, LocalGeometry& result) {
  const double skew = t.b / t.a;
  const double s11 = result.l / t.a / t.a;
  const double s12 = (result.m - skew * result.l) / t.a / t.c;
  const double s22 = (result.n - 2 * (skew * result.m) + skew * (skew * result.l)) / t.c / t.c;
  const double half_difference = 0.5 * (s11 - s22), radius = std::hypot(half_difference, s12);
  result.mean = 0.5 * (s11 + s22);
  result.gaussian = s11 * s22 - s12 * s12;
  const double k1 = result.mean + radius, k2 = result.mean - radius;
  result.umbilic = !(k1 - k2 > umbilic_tolerance * (std::abs(k1) + std::abs(k2)));
  const double angle = result.umbilic ? 0 : 0.5 * std::atan2(s12, half_difference);
  const double cosine = std::cos(angle), sine = std::sin(angle);
  result.first = principal(t, k1, cosine, sine);
  result.second = principal(t, k2, -sine, cosine);
}

bool all_finite(const LocalGeometry& g) {
  for (const double x : {g.e, g.f, g.g, g.l, g.m, g.n, g.gaussian, g.mean, g.first.curvature, g.second.curvature,
                         g.first.parameters[0], g.first.parameters[1], g.second.parameters[0], g.second.parameters[1]})
    if (!std::isfinite(x)) return false;
  return is_finite(g.first.direction) && is_finite(g.second.direction);
}

}  // namespace

LocalGeometry local_geometry(const SurfaceJet& jet, const LocalGeometryOptions& options) {
  for (const Vec3& d : {jet.du, jet.dv, jet.duu, jet.duv, jet.dvv})
    if (!is_finite(d)) return {};
  TangentBasis basis;
  if (!tangent_basis(jet, options.min_sine, basis)) return {};
  LocalGeometry result;
  result.normal = {basis.normal, NormalKind::regular};
  result.defined = true;
  result.e = dot(jet.du, jet.du);
  result.f = dot(jet.du, jet.dv);
  result.g = dot(jet.dv, jet.dv);
  result.l = dot(jet.duu, basis.normal);
  result.m = dot(jet.duv, basis.normal);
  result.n = dot(jet.dvv, basis.normal);
  add_curvatures(basis, options.umbilic_tolerance, result);
  if (all_finite(result)) return result;
  LocalGeometry normal_alone;
  normal_alone.normal = result.normal;
  return normal_alone;
}

LocalGeometry local_geometry(const BezierPatch& patch, double u, double v, const LocalGeometryOptions& options) {
  if (!std::isfinite(u) || !std::isfinite(v)) return {};
  const UnitNormal normal = unit_normal(patch, u, v);
  LocalGeometry result;
  if (normal.kind == NormalKind::regular) result = local_geometry(evaluate_jet(patch, u, v), options);
  result.normal = normal;
  return result;
}

}}  // namespace tessera::abi_0_1
