#pragma once
// Rays that are difficult for a ray caster, by classes: silhouettes, seams, corners, poles, cusps, planes that contain
// the ray, scales, far origins, weights.

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "support/torus.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

/// A set of patches and rays at it.
struct RayClass {
  std::string name;
  std::vector<BezierPatch> patches;
  std::function<Ray(Random&)> draw;
  bool closed = false;  ///< a body without a border, and every ray begins inside or aims at it from inside
};

namespace rays {

inline Vec3 unit_vector(Random& random) {
  for (;;) {
    const Vec3 v = uniform_vector(random, -1, 1);
    if (dot(v, v) <= 1 && dot(v, v) > 1e-4) return normalized(v);
  }
}
inline Ray from_to(const Vec3& origin, const Vec3& direction) {
  Ray ray;
  ray.origin = origin, ray.direction = direction;
  return ray;
}
inline double power(Random& random, double lowest, double highest) {
  return std::pow(10.0, uniform(random, std::log10(lowest), std::log10(highest)));
}
inline const BezierPatch& any_of(const std::vector<BezierPatch>& patches, Random& random) {
  return patches[random() % patches.size()];
}
inline Vec3 any_tangent(const SurfaceJet& jet, Random& random) {
  const double angle = uniform(random, -3.15, 3.15);
  return normalized(std::cos(angle) * normalized(jet.du) + std::sin(angle) * normalized(jet.dv));
}
inline double size_of(const std::vector<BezierPatch>& patches) {
  Box3 box;
  for (const BezierPatch& patch : patches) box.extend(patch.hull_box());
  return box.diagonal();
}

/// A ray from outside to a random point of a patch.
inline Ray at_surface(const std::vector<BezierPatch>& patches, Random& random, double distance) {
  const BezierPatch& patch = any_of(patches, random);
  const Vec3 target = de_casteljau(patch, uniform(random, 0, 1), uniform(random, 0, 1));
  const Vec3 origin = target + distance * unit_vector(random);
  return from_to(origin, uniform(random, 0.3, 3) * (target - origin));
}

/// A ray along a tangent, moved off the surface by 1e-2 to 1e-9 of the size, or not at all.
inline Ray at_silhouette(const std::vector<BezierPatch>& patches, Random& random, double size) {
  const SurfaceJet jet =
      evaluate_jet(any_of(patches, random), uniform(random, 0.02, 0.98), uniform(random, 0.02, 0.98));
  const Vec3 normal = normalized(cross(jet.du, jet.dv)), tangent = any_tangent(jet, random);
  const double off = random() % 16 == 0 ? 0 : power(random, 1e-9, 1e-2) * (random() % 2 == 0 ? 1 : -1);
  return from_to(jet.position + off * size * normal - uniform(random, 0.5, 2) * size * tangent, tangent);
}

/// A ray at borders, corners and isocurves where patches are cut inside the engine, at angles from steep to grazing,
/// near or exactly.
inline Ray at_seam(const std::vector<BezierPatch>& patches, Random& random, double size) {
  const auto line = [&] { return static_cast<double>(random() % 5) / 4; };
  const double u = random() % 2 == 0 ? line() : uniform(random, 0, 1),
               v = random() % 3 == 0 ? uniform(random, 0, 1) : line();
  const SurfaceJet jet = evaluate_jet(any_of(patches, random), u, v);
  const Vec3 normal = normalized(cross(jet.du, jet.dv)), tangent = any_tangent(jet, random);
  const double tilt = power(random, 1e-6, 1) * (random() % 2 == 0 ? 1 : -1);
  const Vec3 direction = normalized(tangent + tilt * normal);
  return from_to(jet.position - uniform(random, 0.5, 2) * size * direction, direction);
}

}  // namespace rays

/// A point beside a border of a patch.
struct SeamPlace {
  std::size_t patch = 0;
  double u = 0, v = 0;  ///< `distance` inside of one edge, or of two at a corner
  Vec3 position, normal;
};

/// A place at a random border, or in one draw of four at a corner. `distance` is in parameters.
inline SeamPlace beside_seam(std::span<const BezierPatch> patches, Random& random, double distance) {
  SeamPlace place;
  place.patch = random() % patches.size();
  const auto at_end = [&] { return random() % 2 == 0 ? distance : 1 - distance; };
  place.u = uniform(random, 0, 1), place.v = uniform(random, 0, 1);
  const auto which = random() % 4;
  if (which != 1) place.u = at_end();
  if (which == 0 || which == 1) place.v = at_end();
  const SurfaceJet jet = evaluate_jet(patches[place.patch], place.u, place.v);
  place.position = jet.position;
  const Vec3 normal = cross(jet.du, jet.dv);
  place.normal = length(normal) > 0 ? normalized(normal) : rays::unit_vector(random);
  return place;
}

/// A ray through the place, from outside, at a sine of 0.01 or more to the surface there.
inline Ray through(const SeamPlace& place, Random& random, double size) {
  for (;;) {
    const Vec3 direction = rays::unit_vector(random);
    if (std::abs(dot(direction, place.normal)) < 0.01) continue;
    return rays::from_to(place.position - uniform(random, 1, 2) * size * direction,
                         uniform(random, 0.5, 2) * direction);
  }
}

/// A bicubic patch whose edge u = 0 has shrunk to `width` of its length.
inline BezierPatch shrunk_edge(double width) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 3; ++i) {
    for (int j = 0; j <= 3; ++j) {
      const double along = (j / 3.0 - 0.5) * (i == 0 ? width : i / 3.0);
      points.push_back({i / 3.0, along, 0.3 * std::sin(2.0 * i) + 0.2 * along * along});
    }
  }
  return polynomial(3, 3, points);
}

/// A bicubic patch with three control points in one corner and a fold.
inline BezierPatch cusp() {
  Random random(5);
  std::vector<Vec3> points = random_points(random, 3, 3);
  points[1] = points[4] = points[5] = points[0];
  return polynomial(3, 3, points);
}

/// A patch in the plane z = 0.25.
inline BezierPatch planar_patch() {
  Random random(6);
  std::vector<Vec3> points;
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j)
      points.push_back({i + 0.3 * uniform(random, -1, 1), j + 0.3 * uniform(random, -1, 1), 0.25});
  }
  return polynomial(2, 2, points);
}

inline std::vector<RayClass> ray_classes() {
  using namespace rays;
  std::vector<RayClass> out;
  const auto add = [&](std::string name, std::vector<BezierPatch> patches, auto draw) {
    const double size = size_of(patches);
    out.push_back(
        {std::move(name), patches, [patches, size, draw](Random& random) { return draw(patches, random, size); }});
  };
  using Set = std::vector<BezierPatch>;
  const auto aimed = [](const Set& set, Random& random, double size) { return at_surface(set, random, size); };
  const auto grazing = [](const Set& set, Random& random, double size) { return at_silhouette(set, random, size); };
  const auto seams = [](const Set& set, Random& random, double size) { return at_seam(set, random, size); };
  add("random, bicubic body", closed_body(), [](const Set&, Random& random, double size) {
    return from_to(size * uniform_vector(random, -1, 1), unit_vector(random));
  });
  add("aimed, bicubic body", closed_body(), aimed);
  add("aimed, rational sphere", sphere(), aimed);
  add("silhouettes, bicubic body", closed_body(), grazing);
  add("silhouettes, rational sphere", sphere(), grazing);
  add("seams and corners, bicubic body", closed_body(), seams);
  add("seams and corners, rational sphere", sphere(), seams);
  const auto beside = [](const Set& set, Random& random, double size) {
    return through(beside_seam(set, random, power(random, 1e-14, 1e-8)), random, size);
  };
  const auto near_borders = [](const Set& set, Random& random, double size) {
    return through(beside_seam(set, random, power(random, 1e-10, 0.5)), random, size);
  };
  const Set torus = Torus(6).patches(false), heavy_torus = Torus(5).patches(true);
  add("seams and corners, B-spline torus", torus, seams);
  add("silhouettes, B-spline torus", torus, grazing);
  add("seams and corners, rational cubic torus", heavy_torus, seams);
  add("poles, rational sphere", sphere(), [](const Set&, Random& random, double) {
    const double off = random() % 4 == 0 ? 0 : power(random, 1e-12, 1e-1);
    const Vec3 target = Vec3{0, 0, random() % 2 == 0 ? 1.0 : -1.0} + off * unit_vector(random);
    const Vec3 direction = unit_vector(random);
    return from_to(target - 2.0 * direction, direction);
  });
  Set shrunk;
  for (const double width : {1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 0.0})
    shrunk.push_back(placed({shrunk_edge(width)}, 1, {0, 0, static_cast<double>(shrunk.size())})[0]);
  add("collapsed sides, 1e-1 to 0", shrunk, [](const Set& set, Random& random, double) {
    const SurfaceJet jet = evaluate_jet(any_of(set, random), power(random, 1e-9, 1), uniform(random, 0, 1));
    const Vec3 direction = unit_vector(random);
    return from_to(jet.position - 2.0 * direction, direction);
  });
  add("cusp", {cusp()}, [](const Set& set, Random& random, double size) {
    const SurfaceJet jet = evaluate_jet(set[0], power(random, 1e-6, 1), power(random, 1e-6, 1));
    const Vec3 direction = unit_vector(random);
    return from_to(jet.position - size * direction, direction);
  });
  add("plane and ray nearly in it", {planar_patch()}, [](const Set& set, Random& random, double) {
    const Vec3 target = de_casteljau(set[0], uniform(random, 0, 1), uniform(random, 0, 1));
    const double angle = uniform(random, 0, 6.3), tilt = random() % 8 == 0 ? 0 : power(random, 1e-12, 1e-1);
    const Vec3 direction{std::cos(angle), std::sin(angle), random() % 2 == 0 ? tilt : -tilt};
    return from_to(target - 4.0 * direction, direction);
  });
  for (const double scale : {1e-6, 1e6}) {
    add(scale < 1 ? "size 3e-6, seams" : "size 3e6, seams", placed(closed_body(), scale, {}), seams);
    add(scale < 1 ? "size 3e-6, silhouettes" : "size 3e6, silhouettes", placed(closed_body(), scale, {}), grazing);
  }
  add("body at 1e4 sizes from zero", placed(closed_body(), 1, {3e4, -2e4, 1e4}), aimed);
  add("origins 1e2 to 1e7 sizes away", closed_body(), [](const Set& set, Random& random, double size) {
    return at_surface(set, random, size * power(random, 1e2, 1e7));
  });
  Set heavy;
  Random random(7);
  for (int k = 0; k < 4; ++k) heavy.push_back(random_rational(random, 2 + k % 2, 2, 1e-3, 1e3, {2.5 * k, 0, 0}));
  add("weights 1e-3 to 1e3", heavy, aimed);
  add("1e-14 to 1e-8 beside seams, bicubic body", closed_body(), beside);
  add("1e-14 to 1e-8 beside seams, rational sphere", sphere(), beside);
  add("1e-14 to 1e-8 beside seams, B-spline torus", torus, beside);
  add("1e-14 to 1e-8 beside seams, rational cubic torus", heavy_torus, beside);
  Set heavier;
  for (int k = 0; k < 6; ++k) heavier.push_back(random_rational(random, 1 + k % 3, 1 + k / 2, 1, 1e6, {2.5 * k, 0, 0}));
  add("weights 1 to 1e6, beside borders", heavier, near_borders);
  Set degrees;
  for (const auto& [m, n] : {std::pair{1, 1}, {1, 4}, {5, 2}, {7, 7}}) {
    const double at = 2.5 * static_cast<double>(degrees.size());
    degrees.push_back(random_polynomial(random, m, n, {at, 0, 0}));
  }
  add("degrees 1x1, 1x4, 5x2, 7x7", degrees, aimed);
  add("the same patch twice", {closed_body()[0], closed_body()[0]}, aimed);
  return out;
}

/// A ray from inside of the tube of a torus of B-spline patches, a little below where patches or pieces of them meet
/// and nearly along the surface there: it must not escape.
inline Ray skimming_seam(const std::vector<BezierPatch>& torus, Random& random) {
  const auto line = [&] { return static_cast<double>(random() % 5) / 4; };
  const double along = uniform(random, 0, 1), across = random() % 3 == 0 ? line() : static_cast<double>(random() % 2);
  const bool by_u = random() % 2 == 0;
  const SurfaceJet jet = evaluate_jet(rays::any_of(torus, random), by_u ? across : along, by_u ? along : across);
  const Vec3 ring = normalized({jet.position.x, jet.position.y, 0});
  Vec3 normal = normalized(cross(jet.du, jet.dv));
  if (dot(normal, jet.position - ring) < 0) normal = -normal;
  const Vec3 tangent = random() % 2 == 0 ? normalized(cross(normal, rays::unit_vector(random)))
                                         : normalized(random() % 2 == 0 ? jet.du : jet.dv);
  const double depth = rays::power(random, 1e-9, 1e-2), tilt = rays::power(random, 1e-7, 1e-1);
  const Vec3 direction = normalized(tangent + (random() % 2 == 0 ? tilt : -tilt) * normal);
  return rays::from_to(jet.position - depth * normal, random() % 2 == 0 ? direction : -direction);
}

/// A ray inside a closed, nearly convex body about zero, at a seam and grazing: the chord between two near points of a
/// border, from its middle.
inline std::pair<bool, Ray> chord_of_seam(const std::vector<BezierPatch>& patches, Random& random) {
  const BezierPatch& patch = rays::any_of(patches, random);
  const auto cut = static_cast<double>(random() % 5) / 4;
  const bool by_u = random() % 2 == 0;
  const auto at = [&](double along) { return de_casteljau(patch, by_u ? cut : along, by_u ? along : cut); };
  const double span = rays::power(random, 1e-4, 0.5), from = uniform(random, 0, 1 - span), to = from + span;
  const Vec3 a = at(from), b = at(to), middle = 0.5 * (a + b), arc = at(0.5 * (from + to));
  if (!(length(arc) > length(middle) * (1 + 1e-10)) || !(length(b - a) > 1e-9)) return {false, {}};
  return {true, rays::from_to(middle, b - a)};
}

}  // namespace tessera::test
