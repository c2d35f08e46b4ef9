#include "ray/spawn_root.h"

#include <algorithm>
#include <cmath>

#include "ray/first_order.h"
#include "ray/nearest_root.h"

namespace tessera {
namespace {

constexpr double noise = 4e-15;  // of points on the scale of the scene, and of distances between them

struct Nearest {
  double u, v, distance;
  FirstOrder at;
};

FirstOrder scene_point(const BezierPatch& patch, const SceneFrame& frame, double u, double v) {
  const FirstOrder at = first_order(patch, u, v, frame.centre);
  return {frame.scale * at.position, frame.scale * at.du, frame.scale * at.dv};
}

/// The point of the patch nearest to p, from (u,v) on by Gauss and Newton's method in the square.
Nearest nearest_point(const BezierPatch& patch, const SceneFrame& frame, const Vec3& p, double u, double v) {
  constexpr int most_steps = 12;
  Nearest best{u, v, 0, scene_point(patch, frame, u, v)};
  best.distance = length(best.at.position - p);
  for (int step = 0; step < most_steps && best.distance > 0; ++step) {
    const Vec3 off = best.at.position - p;
    const double uu = dot(best.at.du, best.at.du), uv = dot(best.at.du, best.at.dv), vv = dot(best.at.dv, best.at.dv);
    const double damping = 1e-14 * (uu + vv), a = uu + damping, c = vv + damping, determinant = a * c - uv * uv;
    if (!(determinant > 0)) break;
    const double gu = dot(best.at.du, off), gv = dot(best.at.dv, off);
    const double to_u = std::clamp(best.u - (gu * c - gv * uv) / determinant, 0.0, 1.0);
    const double to_v = std::clamp(best.v - (gv * a - gu * uv) / determinant, 0.0, 1.0);
    const FirstOrder at = scene_point(patch, frame, to_u, to_v);
    const double distance = length(at.position - p);
    if (!(distance < best.distance)) break;
    best = {to_u, to_v, distance, at};
  }
  return best;
}

/// Bounds the second derivatives of w(u,v) (r(u,v) - p) on the patch, r in the scene, in the maximum norm of (u,v): by the
/// second differences of its coefficients (Farin, sec. 14.6).
double bend_bound(const BezierPatch& patch, const SceneFrame& frame, const Vec3& p) {
  const int m = patch.degree_u(), n = patch.degree_v();
  const auto at = [&](int i, int j) { return patch.weight(i, j) * (frame.to_scene(patch.point(i, j)) - p); };
  double uu = 0, uv = 0, vv = 0;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      if (i + 2 <= m) uu = std::max(uu, length(at(i + 2, j) - 2 * at(i + 1, j) + at(i, j)));
      if (j + 2 <= n) vv = std::max(vv, length(at(i, j + 2) - 2 * at(i, j + 1) + at(i, j)));
      if (i < m && j < n) uv = std::max(uv, length(at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)));
    }
  }
  return m * (m - 1) * uu + 2 * m * n * uv + n * (n - 1) * vv;
}

double least_weight(const BezierPatch& patch) {
  return patch.is_rational() ? *std::min_element(patch.weights().begin(), patch.weights().end()) : 1;
}

/// |J^-1| in the maximum norm of (u,v), for vectors across the ray by their lengths; infinite where J is singular.
double inverse_norm(const FirstOrder& at, const RayLine& line) {
  const double xu = dot(line.across[0], at.du), xv = dot(line.across[0], at.dv);
  const double yu = dot(line.across[1], at.du), yv = dot(line.across[1], at.dv);
  return std::sqrt(std::max(xu * xu + yu * yu, xv * xv + yv * yv)) / std::abs(xu * yv - xv * yu);
}

/// How far along the ray a root at a degenerate point may lie that is the origin's, by the normal there.
bool is_near_along(const BezierPatch& patch, const RayLine& line, const LeafRoot& root, double offset) {
  const UnitNormal normal = unit_normal(patch, root.u, root.v);
  const double sine = std::abs(dot(normal.direction, line.direction));
  return std::abs(root.s - line.s_of_origin()) <= std::min(1e-6, 8 * offset / std::max(sine, 1e-12));
}

}  // namespace

OriginRoot judge_origin(const BezierPatch& patch, const SceneFrame& frame, const RayLine& line, const LeafRoot& root) {
  constexpr double clearly = 1e3, touching = 1e-5;
  const double offset = line.spawn + noise, ahead = std::abs(root.s - line.s_of_origin());
  if (root.has_point) {
    // The tangent plane there passes the origin by so much.
    const Vec3 normal = cross(root.du, root.dv);
    const double area = dot(normal, normal), sine = std::abs(dot(normal, line.direction));
    if (sine * sine * ahead * ahead > clearly * clearly * offset * offset * area) return OriginRoot::other;
  }
  const Vec3 origin = line.start + line.s_of_origin() * line.direction;
  const Nearest to = nearest_point(patch, frame, origin, root.u, root.v);
  if (!(to.distance <= 2 * offset)) return OriginRoot::other;

  const double inverse = inverse_norm(to.at, line), bend = bend_bound(patch, frame, origin) / least_weight(patch);
  const double eta = inverse * (to.distance + noise);
  const auto away = [&](double u, double v) { return std::max(std::abs(u - to.u), std::abs(v - to.v)); };
  if (!(inverse * bend * eta <= 0.5)) {
    const double one = std::sqrt(8 * (offset + root.residual) / bend);
    return away(root.u, root.v) <= one || (!root.certified && ahead <= touching) ||
                   is_near_along(patch, line, root, offset + root.residual)
               ? OriginRoot::indistinct
               : OriginRoot::other;
  }
  const double alone = 1 / (inverse * bend);
  const auto is_origin = [&](double u, double v, double residual) {
    return away(u, v) <= std::min(alone, 2 * eta + 4 * inverse * (residual + noise));
  };
  if (root.certified) return is_origin(root.u, root.v, root.residual) ? OriginRoot::same : OriginRoot::other;

  // Of a part that is within the tolerance of the ray: the root that it belongs to, if it is one's.
  const LeafRoot near = nearest_to_ray(patch, frame, line, root.patch, root.u, root.v);
  if (near.residual > 4 * noise)
    return away(root.u, root.v) <= alone || ahead <= touching ? OriginRoot::indistinct : OriginRoot::other;
  if (!is_origin(near.u, near.v, near.residual)) return OriginRoot::other;
  const double part = std::max(root.radius_u, root.radius_v);
  return part <= alone / 8 || away(root.u, root.v) + part <= alone ? OriginRoot::indistinct : OriginRoot::same;
}

}  // namespace tessera
