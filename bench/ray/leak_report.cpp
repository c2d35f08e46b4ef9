// Checks the promises of grid mode: counts rays from inside closed bodies that miss, and measures the distance of t
// from that of a ray caster that shares no code, with and without refinement. Exit status 1 if a random ray leaks or
// the refined median is above 1e-6.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "support/reference_rays.h"
#include "support/synthetic_sets.h"
#include "tessera/ray_scene.h"

namespace {

using namespace tessera;

constexpr std::size_t ray_count = 1'000'000, reference_count = 20'000;
constexpr int rates[] = {8, 32};
using Random = std::mt19937_64;

double uniform(Random& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Vec3 in_ball(Random& random, double radius) {
  for (;;) {
    const double x = uniform(random, -1, 1), y = uniform(random, -1, 1), z = uniform(random, -1, 1);
    const Vec3 v{x, y, z};
    if (dot(v, v) <= 1 && dot(v, v) > 1e-6) return radius * v;
  }
}

/// Rays from the ball of radius 0.3 about zero, which lies inside the bodies.
template <class MakeDirection>
std::vector<Ray> rays_from_inside(std::size_t count, std::uint64_t seed, MakeDirection make) {
  Random random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = in_ball(random, 0.3);
    ray.direction = make(random, ray.origin);
  }
  return rays;
}

std::vector<Hit> trace(const RayScene& scene, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  if (const Status status = scene.closest(rays, hits); !status.ok()) {
    std::fprintf(stderr, "%s\n", status.message().c_str());
    std::exit(1);
  }
  return hits;
}

std::size_t misses(const std::vector<Hit>& hits) {
  return static_cast<std::size_t>(
      std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.kind != HitKind::hit; }));
}

std::size_t unrefined(const std::vector<Hit>& hits) {
  return static_cast<std::size_t>(
      std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.flags.unrefined; }));
}

struct Distribution {
  double median = 0, largest = 0;
};

Distribution errors(const std::vector<Hit>& hits, const std::vector<Ray>& rays, const std::vector<double>& expected,
                    double size) {
  std::vector<double> all;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (hits[k].kind == HitKind::hit)
      all.push_back(std::abs(hits[k].t - expected[k]) * length(rays[k].direction) / size);
  }
  std::sort(all.begin(), all.end());
  return all.empty() ? Distribution{INFINITY, INFINITY} : Distribution{all[all.size() / 2], all.back()};
}

/// The rays of a body, and the expected hits.
struct Case {
  const std::vector<BezierPatch>& patches;
  PatchSet set;
  std::vector<Ray> rays;
  std::vector<double> expected;  ///< t of the first rays
};

bool report(const Case& body, int rate) {
  RaySceneOptions options;
  options.mode = RayMode::grid;
  options.rate = rate;
  const RayScene refined = test::value_of(RayScene::make(body.set, options));
  options.refine = false;
  const RayScene facets = test::value_of(RayScene::make(body.set, options));
  const auto vertex_rays = rays_from_inside(ray_count, 2, [&](Random& random, const Vec3& origin) {
    const BezierPatch& patch = body.patches[random() % body.patches.size()];
    const auto node = [&] { return static_cast<double>(random() % static_cast<unsigned>(rate + 1)) / rate; };
    const double u = node(), v = node();
    return de_casteljau(patch, u, v) - origin;
  });
  const std::vector<Hit> hits = trace(refined, body.rays), facet_hits = trace(facets, body.rays);
  const double size = body.set.box().diagonal();
  const Distribution exact = errors(hits, body.rays, body.expected, size);
  const Distribution coarse = errors(facet_hits, body.rays, body.expected, size);

  std::printf(
      "  %d x %d cells a patch: leaks: %zu of %zu random rays; %zu of %zu rays aimed at grid vertices; unrefined: "
      "%zu\n",
      rate, rate, misses(hits), hits.size(), misses(trace(refined, vertex_rays)), vertex_rays.size(), unrefined(hits));
  std::printf(
      "    |t - t_reference| / size over %zu rays: median %.2g, largest %.2g; facets: median %.2g, largest %.2g\n",
      body.expected.size(), exact.median, exact.largest, coarse.median, coarse.largest);
  return misses(hits) == 0 && exact.median <= 1e-6;
}

bool report(const char* name, const std::vector<BezierPatch>& patches) {
  Case body{patches, test::value_of(PatchSet::make(patches)), {}, {}};
  body.rays = rays_from_inside(ray_count, 1, [](Random& random, const Vec3&) { return in_ball(random, 1); });
  for (std::size_t k = 0; k < reference_count; ++k)
    body.expected.push_back(test::reference_closest(patches, body.rays[k]).t);
  std::printf("%s: %zu patches\n", name, patches.size());
  bool good = true;
  for (const int rate : rates) good = report(body, rate) && good;
  return good;
}

}  // namespace

int main() {
  const bool body = report("dented cube", test::closed_body());
  const bool ball = report("rational sphere", test::sphere());
  return body && ball ? 0 : 1;
}
