#include "torus_rays.h"

namespace tessera::bench {
namespace {

double uniform(std::mt19937_64& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Vec3 in_ball(std::mt19937_64& random) {
  for (;;) {
    const double x = uniform(random, -1, 1), y = uniform(random, -1, 1), z = uniform(random, -1, 1);
    if (x * x + y * y + z * z <= 1 && x * x + y * y + z * z > 1e-4) return {x, y, z};
  }
}

Ray from_to(const Vec3& origin, const Vec3& direction) {
  Ray ray;
  ray.origin = origin, ray.direction = direction;
  return ray;
}

/// Rays from one eye in rows of pixels, four fifths of them at the torus.
std::vector<Ray> coherent_rays() {
  const Vec3 eye{1.3, -1.6, 1.5}, back = normalized(eye), right = normalized(cross({0, 0, 1}, back)),
                                  up = cross(back, right);
  std::vector<Ray> rays;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const double across = (x + 0.5) / 256 - 0.5, above = 0.5 - (y + 0.5) / 256;
      rays.push_back(from_to(eye, normalized(-back + 1.1 * across * right + 1.0 * above * up)));
    }
  }
  return rays;
}

std::vector<Ray> incoherent_rays() {
  std::mt19937_64 random(7);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < ray_count; ++k) {
    const Vec3 origin = 1.7 * normalized(in_ball(random)), to = in_ball(random);
    rays.push_back(from_to(origin, normalized(Vec3{1.3 * to.x, 1.3 * to.y, 0.5 * to.z} - origin)));
  }
  return rays;
}

/// Rays past a point of the surface along a tangent, 3e-5 to 1e-2 of the size above or below.
std::vector<Ray> grazing_rays(const std::vector<BezierPatch>& patches) {
  std::mt19937_64 random(8);
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < ray_count; ++k) {
    const SurfaceJet at =
        evaluate_jet(patches[random() % patches.size()], uniform(random, 0, 1), uniform(random, 0, 1));
    const Vec3 normal = normalized(cross(at.du, at.dv)), tangent = normalized(cross(normal, in_ball(random)));
    const double off = std::pow(10, uniform(random, -4, -1.5)) * (random() % 2 == 0 ? 1 : -1);
    rays.push_back(from_to(at.position + off * normal - 1.5 * tangent, tangent));
  }
  return rays;
}

PatchSet make_set(const std::vector<BezierPatch>& patches) {
  PatchSetOptions options;
  options.origin = Vec3{};  // gives triangles and rays the same coordinates
  return test::value_of(PatchSet::make(patches, options));
}

}  // namespace

TorusRays::TorusRays(std::size_t side, bool rational)
    : torus(side), patches(torus.patches(rational)), set(make_set(patches)), is_rational(rational) {
  rays["coherent"] = coherent_rays();
  rays["incoherent"] = incoherent_rays();
  rays["grazing"] = grazing_rays(patches);
}

}  // namespace tessera::bench
