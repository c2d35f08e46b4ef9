#pragma once
// Compares an exact ray scene with the proofs of the reference.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "support/interval_rays.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

struct ProofTally {
  std::size_t rays = 0;
  std::size_t hits = 0;          ///< proven
  std::size_t misses = 0;        ///< proven
  std::size_t undecidable = 0;   ///< neither proven
  std::size_t missed = 0;        ///< a proven hit, and the scene has none, or a later one
  std::size_t false_hits = 0;    ///< the point is not on patch and ray to the tolerance, or outside of [tnear, tfar]
  std::size_t touching = 0;      ///< proven misses that the scene met within its tolerance
  std::size_t contradicted = 0;  ///< rays for which occluded() and closest() disagree
  std::size_t incomplete = 0;
  std::size_t wrong_patch = 0;  ///< inside a patch that the ray provably misses, where a hit on another is proven
  std::vector<double> t_errors, u_errors;  ///< of hits whose proven t is narrow; t in shares of the size

  void add(const ProofTally& other) {
    rays += other.rays, hits += other.hits, misses += other.misses, undecidable += other.undecidable;
    missed += other.missed, false_hits += other.false_hits, touching += other.touching;
    contradicted += other.contradicted, incomplete += other.incomplete, wrong_patch += other.wrong_patch;
    t_errors.insert(t_errors.end(), other.t_errors.begin(), other.t_errors.end());
    u_errors.insert(u_errors.end(), other.u_errors.begin(), other.u_errors.end());
  }
};

/// The distance of a point from a ray's line, in quadruple-like steps that a far origin doesn't hurt.
inline double distance_from_line(const Vec3& p, const Ray& ray) {
  using Long = long double;
  const Long x = static_cast<Long>(p.x) - ray.origin.x, y = static_cast<Long>(p.y) - ray.origin.y,
             z = static_cast<Long>(p.z) - ray.origin.z;
  const Long dx = ray.direction.x, dy = ray.direction.y, dz = ray.direction.z;
  const Long a = y * dz - z * dy, b = z * dx - x * dz, c = x * dy - y * dx;
  return static_cast<double>(std::sqrt(a * a + b * b + c * c) / std::sqrt(dx * dx + dy * dy + dz * dz));
}

/// Whether a hit lies on its ray within the tolerance. The point is that of the patch by another evaluator.
inline bool is_on_ray(std::span<const BezierPatch> patches, const Ray& ray, const Hit& hit, double tolerance) {
  const Vec3 p = de_casteljau(patches[hit.patch], hit.patch_u, hit.patch_v);
  const double reach = std::max({max_abs(p), max_abs(ray.origin), max_abs(p - ray.origin)});
  const double rounding = 64 * 0x1p-53 * max_abs(p) + 0x1p-58 * reach;
  return distance_from_line(p, ray) <= tolerance + rounding && hit.t >= ray.tnear && hit.t <= ray.tfar;
}

/// Whether a hit lies inside a patch that the ray provably misses.
inline bool is_on_wrong_patch(const Verdict& verdict, const Hit& hit, double tolerance, double size) {
  const auto on_hit_patch = [&](const Verdict::Root& root) { return root.patch == hit.patch; };
  // Like t in check_ray(), parameters along the ray within the tolerance differ by up to its square root.
  const double near_border = hit.flags.uncertified ? 4 * std::sqrt(tolerance / size) : 1e-9;
  const double aside_u = std::min(hit.patch_u, 1 - hit.patch_u), aside_v = std::min(hit.patch_v, 1 - hit.patch_v);
  // Next to a pole parameters that differ by 1e-7 are one place: there the distance from the border counts.
  const double off_border = std::min(aside_u * length(hit.du), aside_v * length(hit.dv));
  const bool on_border = std::min(aside_u, aside_v) < near_border || off_border < 64 * 0x1p-53 * size;
  return !on_border && std::none_of(verdict.hits.begin(), verdict.hits.end(), on_hit_patch) &&
         std::none_of(verdict.undecided.begin(), verdict.undecided.end(), on_hit_patch);
}

/// Checks one ray. `tolerance`: the scene's; `size`: the model's.
inline void check_ray(std::span<const BezierPatch> patches, const RayScene& scene, const Ray& ray, double tolerance,
                      double size, ProofTally& tally) {
  const Verdict verdict = reference_verdict(patches, ray);
  const Hit hit = scene.closest(ray);
  const bool met = hit.kind == HitKind::hit;
  const double speed = length(ray.direction);
  ++tally.rays;
  tally.contradicted += (scene.occluded(ray) == HitKind::hit) != met;
  tally.incomplete += hit.flags.incomplete;
  tally.false_hits += met && !is_on_ray(patches, ray, hit, tolerance);
  tally.undecidable += !verdict.hit() && !verdict.miss();
  if (verdict.miss()) {
    ++tally.misses;
    tally.touching += met;
  }
  if (!verdict.hit()) return;
  ++tally.hits;
  tally.wrong_patch += met && is_on_wrong_patch(verdict, hit, tolerance, size);
  const Verdict::Root& first = verdict.first();
  // Within the tolerance of a tangent the surface is hit earlier or later by up to its square root. Elsewhere t is
  // known as precisely as the surface's height over the ray, to a rounding of the coordinates, and the slope determine
  // it.
  const SurfaceJet jet = evaluate_jet(patches[first.patch], first.u.middle(), first.v.middle());
  const double sine = std::abs(dot(normalized(cross(jet.du, jet.dv)), ray.direction)) / speed;
  const double strict = std::max(1e-9, 16 * 0x1p-53 / sine) * size / speed;  // NaN without a normal: 1e-9
  const double loose = 4 * std::sqrt(tolerance * size) / speed;
  if (!met || hit.t > first.t.hi + (hit.flags.uncertified ? loose : strict)) {
    ++tally.missed;
    return;
  }
  if (first.t.width() * speed > 1e-9 * size || hit.patch != first.patch ||
      std::abs(hit.patch_u - first.u.middle()) > 1e-3 || std::abs(hit.patch_v - first.v.middle()) > 1e-3)
    return;
  tally.t_errors.push_back(std::abs(hit.t - first.t.middle()) * speed / size);
  tally.u_errors.push_back(
      std::max(std::abs(hit.patch_u - first.u.middle()), std::abs(hit.patch_v - first.v.middle())));
}

}  // namespace tessera::test
