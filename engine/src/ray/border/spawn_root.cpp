#include "ray/border/spawn_root.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ray/border/nearest_root.h"
#include "ray/border/root_fan.h"
#include "ray/line/first_order.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double noise = 4e-15;  // rounding of points at the scale of the scene, and of distances between them

struct Nearest {
  double u, v, distance;
  FirstOrder at;
};

FirstOrder scene_point(const BezierPatch& patch, const SceneFrame& frame, double u, double v) {
  const FirstOrder at = first_order(patch, u, v, frame.centre);
  return {frame.scale * at.position, frame.scale * at.du, frame.scale * at.dv};
}

/// Moves from (u,v) by the Gauss-Newton method in the square.
Nearest nearest_from(const BezierPatch& patch, const SceneFrame& frame, const Vec3& p, double u, double v) {
  constexpr int max_steps = 12;
  Nearest best{u, v, 0, scene_point(patch, frame, u, v)};
  best.distance = length(best.at.position - p);
  for (int step = 0; step < max_steps && best.distance > 0; ++step) {
    const Vec3 off = best.at.position - p;
    const double uu = dot(best.at.du, best.at.du), uv = dot(best.at.du, best.at.dv), vv = dot(best.at.dv, best.at.dv);
    // Damps each by itself, since beside a pole one is far smaller; at the pole it is 0.
    const double damped = 1 + 1e-14, least = 1e-40 * (uu + vv);
    const double a = damped * uu + least, c = damped * vv + least, determinant = a * c - uv * uv;
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

/// Returns whether one parameter moves the point much less than the other, as beside a pole.
bool is_squeezed(const FirstOrder& at) {
  const double u = length(at.du), v = length(at.dv);
  return std::min(u, v) < 1e-3 * std::max(u, v);
}

/// Returns the point of the patch nearest to p, near (u,v). Beside a pole all angles are near, and the method ends at a
/// wrong one if it begins far from p's angle, so it is started from several.
Nearest nearest_point(const BezierPatch& patch, const SceneFrame& frame, const Vec3& p, double u, double v,
                      double enough) {
  Nearest best = nearest_from(patch, frame, p, u, v);
  if (best.distance <= enough || !is_squeezed(best.at)) return best;
  const bool along_u = length(best.at.du) < length(best.at.dv);
  for (const double start : {0.125, 0.375, 0.625, 0.875}) {
    const Nearest to = nearest_from(patch, frame, p, along_u ? start : u, along_u ? v : start);
    if (to.distance < best.distance) best = to;
  }
  return best;
}

/// Bounds the second derivatives of w(u,v) (r(u,v) - p) on the patch, r in the scene, in the maximum norm of (u,v), by
/// the second differences of its coefficients (Farin, sec. 14.6).
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

double min_weight(const BezierPatch& patch) {
  return patch.is_rational() ? *std::min_element(patch.weights().begin(), patch.weights().end()) : 1;
}

/// Returns |J^-1| in the maximum norm of (u,v), for vectors across the ray by their lengths; infinite if J is singular.
double inverse_norm(const FirstOrder& at, const RayLine& line) {
  const double xu = dot(line.across[0], at.du), xv = dot(line.across[0], at.dv);
  const double yu = dot(line.across[1], at.du), yv = dot(line.across[1], at.dv);
  return std::sqrt(std::max(xu * xu + yu * yu, xv * xv + yv * yv)) / std::abs(xu * yv - xv * yu);
}

double distance_from(const RayLine& line, const Vec3& p) {
  const double x = dot(line.across[0], p - line.start), y = dot(line.across[1], p - line.start);
  return std::sqrt(x * x + y * y);
}

/// Returns whether a root at a degenerate point is near enough along the ray to be the origin's, by the normal there.
bool is_near_along(const BezierPatch& patch, const RayLine& line, const LeafRoot& root, double offset) {
  const UnitNormal normal = unit_normal(patch, root.u, root.v);
  const double sine = std::abs(dot(normal.direction, line.direction));
  return std::abs(root.s - line.s_of_origin()) <= std::min(1e-6, 8 * offset / std::max(sine, 1e-12));
}

OriginRoot decide_on_patch(const BezierPatch& patch, const SceneFrame& frame, const RayLine& line,
                           const LeafRoot& root) {
  constexpr double clearly = 1e3, touching = 1e-5;
  const double offset = line.spawn + noise, ahead = std::abs(root.s - line.s_of_origin());
  if (root.has_point) {
    // The tangent plane there passes the origin at this distance.
    const Vec3 normal = cross(root.du, root.dv);
    const double area = dot(normal, normal), sine = std::abs(dot(normal, line.direction));
    if (sine * sine * ahead * ahead > clearly * clearly * offset * offset * area) return OriginRoot::other;
  }
  const Vec3 origin = line.start + line.s_of_origin() * line.direction;
  const Nearest to = nearest_point(patch, frame, origin, root.u, root.v, 2 * offset);
  if (!(to.distance <= 2 * offset)) return OriginRoot::other;

  const double inverse = inverse_norm(to.at, line), bend = bend_bound(patch, frame, origin) / min_weight(patch);
  const double eta = inverse * (to.distance + noise);
  const auto away = [&](double u, double v) { return std::max(std::abs(u - to.u), std::abs(v - to.v)); };
  if (!(inverse * bend * eta <= 0.5)) {
    const double one = std::sqrt(8 * (offset + root.residual) / bend);
    return away(root.u, root.v) <= one || (!root.certified && ahead <= touching) ||
                   is_near_along(patch, line, root, offset + root.residual)
               ? OriginRoot::indistinct
               : OriginRoot::other;
  }
  if (is_squeezed(to.at) && is_near_along(patch, line, root, offset + root.residual)) return OriginRoot::indistinct;
  const double alone = 1 / (inverse * bend);
  const auto is_origin = [&](double u, double v, double residual) {
    return away(u, v) <= std::min(alone, 2 * eta + 4 * inverse * (residual + noise));
  };
  if (root.certified) return is_origin(root.u, root.v, root.residual) ? OriginRoot::same : OriginRoot::other;

  // For a part within the tolerance of the ray: the root to which it belongs, if it belongs to one.
  const LeafRoot near = nearest_to_ray(patch, frame, line, root.patch, root.u, root.v);
  if (near.residual > 4 * noise)
    return away(root.u, root.v) <= alone || ahead <= touching ? OriginRoot::indistinct : OriginRoot::other;
  if (!is_origin(near.u, near.v, near.residual)) return OriginRoot::other;
  const double part = std::max(root.part_u, root.part_v);
  return part <= alone / 8 || away(root.u, root.v) + part <= alone ? OriginRoot::indistinct : OriginRoot::same;
}

/// Returns the pole beside an uncertified point, in the point's place, since such a point may belong to any of the
/// patches around the pole.
std::optional<LeafRoot> pole_beside(const SetView& set, const SceneFrame& frame, const LeafRoot& root) {
  constexpr double close = 1e-2;  // in parameters
  if (root.certified || !is_squeezed(scene_point(set.patch(root.patch), frame, root.u, root.v))) return std::nullopt;
  for (int edge = 0; edge < 4; ++edge) {
    const double across = edge < 2 ? root.u : root.v;
    if (std::abs(across - edge % 2) > close || !is_collapsed(set, root.patch, edge)) continue;
    LeafRoot pole = root;
    (edge < 2 ? pole.u : pole.v) = edge % 2;
    return pole;
  }
  return std::nullopt;
}

/// Returns the root itself or, for a part, its point nearest to the ray. If the patch has no root, and a neighbour's is
/// near, that point lies on their border.
LeafRoot place_on_border(const BezierPatch& patch, const SceneFrame& frame, const RayLine& line, const LeafRoot& root) {
  return root.from == no_part ? root : nearest_to_ray(patch, frame, line, root.patch, root.u, root.v);
}

}  // namespace

OriginRoot decide_origin(const SetView& set, const Adjacency* borders, const SceneFrame& frame, const RayLine& line,
                         const LeafRoot& root) {
  constexpr double beside = 1e-3;  // along the ray: no root further away is the origin's
  const OriginRoot here = decide_on_patch(set.patch(root.patch), frame, line, root);
  if (here != OriginRoot::other || borders == nullptr || std::abs(root.s - line.s_of_origin()) > beside) return here;
  const std::optional<LeafRoot> pole = pole_beside(set, frame, root);
  const LeafRoot on_border = pole ? *pole : place_on_border(set.patch(root.patch), frame, line, root);
  const RootFan fan(set, *borders, on_border, on_border.residual + on_border.noise + 2 * (line.spawn + noise));
  for (LeafRoot place : fan.beyond()) {
    const BezierPatch& patch = set.patch(place.patch);
    if (!pole) {
      place.certified = true;
      place.residual = distance_from(line, scene_point(patch, frame, place.u, place.v).position);
    }
    const OriginRoot there = decide_on_patch(patch, frame, line, place);
    if (there != OriginRoot::other) return there;
  }
  return OriginRoot::other;
}

}}  // namespace tessera::abi_0_1
