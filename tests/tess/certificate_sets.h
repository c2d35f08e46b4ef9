#pragma once
// Patches that are difficult for bounds: all kinds, and shapes that mislead sampling.

#include <cmath>
#include <string>
#include <vector>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"

namespace tessera::test {

struct CertificateSet {
  std::string name;
  std::vector<BezierPatch> patches;
  bool bicubic = false;  ///< a plain one, on which bounds should be tight
};

template <class Make>
std::vector<BezierPatch> repeated(int count, std::uint64_t seed, Make make) {
  Random random(seed);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < count; ++k) patches.push_back(make(random));
  return patches;
}

/// The control points of a gently bent bicubic patch, moved by `change(i, j, point)`.
template <class Change>
BezierPatch bent(Random& random, Change change) {
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      points.push_back(change(i, j, Vec3{i / 3.0, j / 3.0, 0} + 0.2 * uniform_vector(random, -1, 1)));
  return polynomial(3, 3, points);
}

inline std::vector<CertificateSet> certificate_sets() {
  std::vector<CertificateSet> sets;
  sets.push_back({"waves", wavy_field(8, 8), true});
  sets.push_back(
      {"bicubic, bent", repeated(40, 1, [](Random& r) { return bent(r, [](int, int, Vec3 p) { return p; }); }), true});
  sets.push_back({"bicubic, wild", repeated(20, 2, [](Random& r) { return random_polynomial(r, 3, 3); }), true});
  sets.push_back({"sphere, rational", sphere()});
  sets.push_back(
      {"rational, weights 1/2 to 2", repeated(20, 3, [](Random& r) { return random_rational(r, 3, 3, 0.5, 2); })});
  sets.push_back({"rational, weights 1/30 to 30",
                  repeated(5, 4, [](Random& r) { return random_rational(r, 2, 3, 1 / 30.0, 30); })});
  sets.push_back({"degrees 9 x 7", repeated(5, 5, [](Random& r) { return random_polynomial(r, 9, 7); })});
  sets.push_back({"degrees 15 x 15", repeated(2, 6, [](Random& r) { return random_polynomial(r, 15, 15); })});
  sets.push_back(
      {"S-shaped", repeated(10, 7, [](Random& r) {
         return bent(r, [](int i, int, Vec3 p) { return p + Vec3{0, 0, i == 1 ? 0.5 : i == 2 ? -0.5 : 0.0}; });
       })});
  sets.push_back(
      {"cusped", repeated(10, 8, [](Random& r) {  // along u the inner points change places
         return bent(r, [](int i, int, Vec3 p) { return i == 1 ? p + Vec3{1, 0, 0} : i == 2 ? p - Vec3{1, 0, 0} : p; });
       })});
  sets.push_back({"needles", repeated(10, 9, [](Random& r) {
                    return bent(r, [](int, int, Vec3 p) { return Vec3{1000 * p.x, p.y, p.z}; });
                  })});
  sets.push_back({"poles", repeated(10, 10, [](Random& r) {
                    return bent(r, [](int i, int, Vec3 p) { return i == 0 ? Vec3{0, 0.5, 0} : p; });
                  })});
  sets.push_back({"size 1e6, at 1e7", placed(closed_body(), 1e6, {1e7, -1e7, 5e6})});
  sets.push_back({"size 1e-6", placed(closed_body(), 1e-6, {})});
  return sets;
}

}  // namespace tessera::test
