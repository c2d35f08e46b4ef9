#pragma once
// Rays and hits in arrays, for the tests of batches.

#include <array>
#include <string>
#include <vector>

#include "ray_support.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

/// Rays and hits of T as structures of arrays.
template <class T>
struct Arrays {
  std::array<std::vector<T>, 3> origin, direction;
  std::vector<T> tnear, tfar, spawn_offset;

  explicit Arrays(const std::vector<Ray>& rays) {
    for (const Ray& ray : rays) {
      const Vec3 &o = ray.origin, &d = ray.direction;
      add(origin, o), add(direction, d);
      tnear.push_back(static_cast<T>(ray.tnear)), tfar.push_back(static_cast<T>(ray.tfar));
      spawn_offset.push_back(static_cast<T>(ray.spawn_offset));
    }
  }
  RayViews<T> views() const {
    RayViews<T> out;
    out.origin = View3<const T>::soa({origin[0], origin[1], origin[2]});
    out.direction = View3<const T>::soa({direction[0], direction[1], direction[2]});
    out.tnear = View1<const T>::soa({tnear}), out.tfar = View1<const T>::soa({tfar});
    out.spawn_offset = View1<const T>::soa({spawn_offset});
    return out;
  }
  /// These numbers in double.
  std::vector<Ray> rays() const {
    std::vector<Ray> out(tnear.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k].origin = {origin[0][k], origin[1][k], origin[2][k]};
      out[k].direction = {direction[0][k], direction[1][k], direction[2][k]};
      out[k].tnear = tnear[k], out[k].tfar = tfar[k], out[k].spawn_offset = spawn_offset[k];
    }
    return out;
  }

 private:
  static void add(std::array<std::vector<T>, 3>& to, const Vec3& v) {
    to[0].push_back(static_cast<T>(v.x)), to[1].push_back(static_cast<T>(v.y)), to[2].push_back(static_cast<T>(v.z));
  }
};

/// Room for every output, as structures of arrays.
template <class T>
struct Outputs {
  explicit Outputs(std::size_t rays)
      : kind(rays, HitKind{9}), flags(rays), numbers(6, std::vector<T>(rays, T(-77))), indices(3) {
    for (auto& index : indices) index.assign(rays, 77);
    for (auto& vector : vectors) vector.assign(3 * rays, T(-77));
  }
  HitViews<T> views() {
    HitViews<T> out;
    out.kind = View1<HitKind>::soa({kind}), out.flags = View1<HitFlags>::soa({flags});
    std::size_t k = 0;
    for (View1<T>* view : {&out.t, &out.u, &out.v, &out.patch_u, &out.patch_v, &out.residual})
      *view = View1<T>::soa({numbers[k++]});
    k = 0;
    for (View1<std::uint32_t>* view : {&out.patch, &out.surface, &out.instance})
      *view = View1<std::uint32_t>::soa({indices[k++]});
    k = 0;
    for (View3<T>* view : {&out.position, &out.normal, &out.du, &out.dv}) *view = View3<T>::interleaved(vectors[k++]);
    return out;
  }
  std::vector<HitKind> kind;
  std::vector<HitFlags> flags;
  std::vector<std::vector<T>> numbers;
  std::vector<std::vector<std::uint32_t>> indices;
  std::array<std::vector<T>, 4> vectors;
};

inline bool same_flags(HitFlags a, HitFlags b) {
  return a.unrefined == b.unrefined && a.degenerate_normal == b.degenerate_normal && a.uncertified == b.uncertified &&
         a.incomplete == b.incomplete && a.tangential == b.tangential && a.within_tolerance == b.within_tolerance;
}

/// Compares every output bit for bit.
template <class T>
void expect_hit(const Outputs<T>& out, std::size_t k, const Hit& hit) {
  SCOPED_TRACE("ray " + std::to_string(k));
  ASSERT_EQ(out.kind[k], hit.kind);
  const bool met = hit.kind == HitKind::hit;
  const std::array numbers{hit.t, hit.u, hit.v, hit.patch_u, hit.patch_v, hit.residual};
  for (std::size_t j = 0; j < numbers.size(); ++j) EXPECT_EQ(out.numbers[j][k], static_cast<T>(numbers[j])) << j;
  const std::array indices{hit.patch, hit.surface, hit.instance};
  for (std::size_t j = 0; j < indices.size(); ++j)
    EXPECT_EQ(out.indices[j][k], met ? indices[j] : HitViews<T>::no_hit) << j;
  const std::array vectors{hit.position, hit.normal, hit.du, hit.dv};
  for (std::size_t j = 0; j < vectors.size(); ++j) {
    const std::array components{vectors[j].x, vectors[j].y, vectors[j].z};
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(out.vectors[j][3 * k + c], static_cast<T>(components[c])) << j << ", " << c;
  }
  EXPECT_TRUE(same_flags(out.flags[k], hit.flags));
}

template <class T>
Outputs<T> all_outputs(const RayScene& scene, const auto& rays, const BatchOptions& options = {}) {
  Outputs<T> out(rays.direction.size);
  const Status status = closest(scene, rays, out.views(), options);
  EXPECT_TRUE(status.ok()) << status.message();
  return out;
}

/// A camera's picture of a torus in rows, and rays from anywhere.
inline std::vector<Ray> picture(std::size_t side) {
  std::vector<Ray> rays;
  const Vec3 eye{1.4, -1.7, 1.2};
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const double half = 0.5 * static_cast<double>(side), across = static_cast<double>(x) / half - 1,
                   above = static_cast<double>(y) / half - 1;
      rays.push_back(ray(eye, Vec3{1.1 * across, 0.9 * across, 0.8 * above} - eye));
    }
  }
  return rays;
}

inline std::vector<Ray> mixed_rays(const Box3& box) {
  std::vector<Ray> rays = picture(48);
  for (const Ray& ray : rays_through(box, 1500, 91)) rays.push_back(ray);
  for (std::size_t k = 0; k < rays.size(); k += 7) rays[k].tnear = 0.5, rays[k].tfar = 2.5;
  for (std::size_t k = 3; k < rays.size(); k += 97) rays[k].direction = {};
  return rays;
}

}  // namespace tessera::test
