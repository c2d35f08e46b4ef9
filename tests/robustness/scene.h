#pragma once
// All work of the library with a set, once, with the results in memory for comparison.

#include <cstring>
#include <vector>

#include "support/grids.h"
#include "support/points.h"
#include "tessera/tessellation.h"
#ifdef TESSERA_HAS_RAY
#include "tessera/ray_scene.h"
#ifdef TESSERA_THREAD_SANITIZER
#include <tbb/task_arena.h>

#include <mutex>
#endif
#endif

namespace tessera::test {

/// The bits of results, one after the other.
class Bits {
 public:
  template <class T>
  void add(const std::vector<T>& values) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes_.data() + at, values.data(), values.size() * sizeof(T));
  }
  template <class T>
  void add(const AllBuffers<T>& buffers) {
    for (const auto& values : buffers.values) add(values);
    add(buffers.normal_kind);
    add(buffers.curvature_kind);
  }
  void add(const Mesh& mesh) {
    add(mesh.positions);
    add(mesh.normals);
    add(mesh.parameters);
    add(mesh.patches);
    add(mesh.indices);
  }
#ifdef TESSERA_HAS_RAY
  void add(const Hit& h) {
    add(std::vector{h.t, h.u, h.v, h.patch_u, h.patch_v, h.residual, h.position.x, h.position.y, h.position.z,
                    h.normal.x, h.normal.y, h.normal.z});
    add(std::vector<std::uint32_t>{h.surface, h.patch, static_cast<std::uint32_t>(h.kind), h.flags.unrefined,
                                   h.flags.degenerate_normal, h.flags.uncertified, h.flags.incomplete});
  }
#endif
  bool operator==(const Bits&) const = default;
  std::size_t size() const { return bytes_.size(); }

 private:
  std::vector<unsigned char> bytes_;
};

/// A field of bicubic patches, poles and rational ones among them.
inline std::vector<BezierPatch> various_patches(int size) {
  std::vector<BezierPatch> patches = wavy_field(size, size);
  const std::vector<BezierPatch> balls = placed(sphere(), 0.4, {0.5, 0.5, 2});
  patches.insert(patches.end(), balls.begin(), balls.end());
  return patches;
}

inline void evaluate_into(Bits& bits, const PatchSet& set) {
  const std::vector<double> t = uniform_parameters(7);
  const GridPlan singles = value_of(GridPlan::make(set, t, t));
  AllBuffers<float> grid(singles);
  EXPECT_TRUE(evaluate(set, singles, grid.views()).ok());
  bits.add(grid);
  const GridPlan doubles = value_of(GridPlan::make(set, t, t, {.precision = Precision::double_precision}));
  AllBuffers<double> fine(doubles);
  EXPECT_TRUE(evaluate(set, doubles, fine.views()).ok());
  bits.add(fine);
  Random random(7);
  bits.add(all_outputs(set, random_samples<float>(random, set.patch_count(), 3000)));
}

inline void tessellate_into(Bits& bits, const PatchSet& set) {
  const Tessellation uniform = value_of(Tessellation::make(set, {.rates = UniformRates{}}));
  Mesh mesh = value_of(uniform.allocate());
  EXPECT_TRUE(uniform.run(set, mesh.views()).ok());
  bits.add(mesh);
  const auto plan = value_of(Tessellation::make(set, {.tolerance = 2e-3, .angle = 0.3, .joining = {.weld = 1e-6}}));
  mesh = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
  bits.add(mesh);
  bits.add(std::vector<float>(plan.bounds().begin(), plan.bounds().end()));
}

/// New control points for every third patch, and back.
inline void edit_into(Bits& bits, PatchSet& set) {
  Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 2e-3}));
  Mesh mesh = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
  std::vector<std::uint32_t> patches;
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < set.patch_count(); k += 3) {
    patches.push_back(static_cast<std::uint32_t>(k));
    for (const Vec3& p : set.patch(k).points()) points.push_back(p + Vec3{0, 0, 0.01});
  }
  EXPECT_FALSE(value_of(plan.update(set, {patches, points}, mesh.views())).topology);
  bits.add(mesh);
  bits.add(std::vector<float>(plan.bounds().begin(), plan.bounds().end()));
}

#ifdef TESSERA_HAS_RAY
inline std::vector<Ray> rays_at(const PatchSet& set, std::size_t count, std::uint64_t seed = 3) {
  Random random(seed);
  const Box3 box = set.box();
  std::vector<Ray> rays;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 origin = box.centre() + box.diagonal() * uniform_vector(random, -1, 1);
    rays.push_back(
        {.origin = origin, .direction = box.centre() + 0.4 * box.diagonal() * uniform_vector(random, -1, 1) - origin});
  }
  return rays;
}

/// Makes or refits a scene. Embree is not instrumented: the thread sanitizer sees neither its locks nor the end of the
/// tasks that build its trees. Under that sanitizer, therefore, only one thread at a time does this work; the work of
/// rays is then checked.
template <class Build>
auto built(Build&& build) {
#ifdef TESSERA_THREAD_SANITIZER
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  tbb::task_arena one(1);
  return one.execute(build);
#else
  return build();
#endif
}

inline void cast_into(Bits& bits, const PatchSet& set) {
  const std::vector<Ray> rays = rays_at(set, 3000);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> dark(rays.size());
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const RayScene scene = value_of(built([&] { return RayScene::make(set, {.mode = mode}); }));
    EXPECT_TRUE(scene.closest(rays, hits).ok());
    EXPECT_TRUE(scene.occluded(rays, dark).ok());
    for (const Hit& hit : hits) bits.add(hit);
    bits.add(dark);
    HitLists lists;
    if (mode == RayMode::grid) continue;
    EXPECT_TRUE(scene.all(rays, lists).ok());
    for (const Hit& hit : lists.hits) bits.add(hit);
    bits.add(lists.first);
  }
}
#else
inline void cast_into(Bits&, const PatchSet&) {}
#endif

/// Runs everything above on a set of its own.
inline Bits everything(int size = 8) {
  Bits bits;
  PatchSet set = set_of(various_patches(size), with_points());
  evaluate_into(bits, set);
  tessellate_into(bits, set);
  cast_into(bits, set);
  edit_into(bits, set);
  return bits;
}

}  // namespace tessera::test
