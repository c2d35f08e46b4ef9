#pragma once
// Checks the number of hits of a ray beside borders, corners, creases and poles.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "support/ray_classes.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

/// A ray and six others beside it, 1e-6 of the size away.
inline std::array<Ray, 7> with_neighbours(const Ray& ray, double size) {
  const Vec3 along = normalized(ray.direction);
  const Vec3 x = normalized(cross(along, std::abs(along.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), y = cross(along, x);
  std::array<Ray, 7> out;
  out.fill(ray);
  for (std::size_t k = 0; k < 6; ++k) {
    const double angle = 0.4 + 1.0471975511965976 * static_cast<double>(k);
    out[k + 1].origin += 1e-6 * size * (std::cos(angle) * x + std::sin(angle) * y);
  }
  return out;
}

struct SeamTally {
  std::size_t rays = 0, decided = 0;  ///< the neighbours agree
  std::size_t wrong = 0;              ///< another count, without a flagged hit
  std::size_t flagged = 0;            ///< another count, and a flag says so
  std::size_t pairs = 0;              ///< two or more further hits, an even number, all of them certified
  std::size_t not_first = 0;          ///< the closest hit is not the first of all

  void add(const SeamTally& other) {
    rays += other.rays, decided += other.decided, wrong += other.wrong, flagged += other.flagged;
    not_first += other.not_first, pairs += other.pairs;
  }
};

/// Checks that a ray has as many hits as its neighbours, and that the first of them is the closest. On a body with
/// creases a ray may cross one that its neighbours miss: it then hits the surface twice more, to the last digits.
inline void check_count(const RayScene& scene, const Ray& ray, double size, bool smooth, SeamTally& tally) {
  ++tally.rays;
  HitLists lists;
  const std::array<Ray, 7> rays = with_neighbours(ray, size);
  if (!scene.all(rays, lists).ok()) std::abort();
  const auto hits = [&](std::size_t k) {
    return std::span(lists.hits).subspan(lists.first[k], lists.first[k + 1] - lists.first[k]);
  };
  const auto is_flagged = [&](std::size_t k) {
    return std::any_of(hits(k).begin(), hits(k).end(), [](const Hit& hit) { return hit.flags.uncertified; });
  };
  const Hit first = scene.closest(ray);
  const bool met = first.kind == HitKind::hit;
  tally.not_first +=
      met == hits(0).empty() || (met && std::abs(first.t - hits(0)[0].t) * length(ray.direction) > 1e-11 * size &&
                                 !first.flags.uncertified && !is_flagged(0));
  for (std::size_t k = 1; k < rays.size(); ++k) {
    if (hits(k).size() != hits(1).size() || is_flagged(k)) return;
  }
  ++tally.decided;
  const std::size_t here = hits(0).size(), beside = hits(1).size();
  if (here == beside) return;
  const bool all_exact =
      std::all_of(hits(0).begin(), hits(0).end(), [&](const Hit& hit) { return hit.residual <= 1e-14 * size; });
  if (!smooth && here > beside && (here - beside) % 2 == 0 && all_exact && !is_flagged(0)) {
    ++tally.pairs;
    return;
  }
  ++(is_flagged(0) ? tally.flagged : tally.wrong);
}

/// A ray that leaves a place, at a sine of 1e-3 or more to the surface there. It begins at the scene's own point of the
/// surface.
inline Ray leaving(const RayScene& scene, const SeamPlace& place, Random& random) {
  Ray out;
  out.origin = value_of(scene.resolve(static_cast<std::uint32_t>(place.patch), place.u, place.v)).position;
  do {
    const Vec3 tangent = normalized(cross(place.normal, rays::unit_vector(random)));
    const double sine = rays::power(random, 1e-3, 1) * (random() % 2 == 0 ? 1 : -1);
    out.direction = normalized(std::sqrt(1 - sine * sine) * tangent + sine * place.normal);
  } while (!std::isfinite(out.direction.x));
  out.spawn_offset = scene.spawn_offset();
  return out;
}

}  // namespace tessera::test
