// After the first calls a repeated call allocates nothing, and every operation keeps to the memory that its header
// states.

#include <gtest/gtest.h>

#include "robustness/scene.h"
#include "support/allocations.h"

namespace tessera::test { namespace {

/// The first calls may allocate, and so may a call in which a thread takes part for the first time.
template <class Call>
void expect_no_allocation(const char* name, Call&& call) {
  for (int warm_up = 0; warm_up < 10; ++warm_up) ASSERT_TRUE(call().ok()) << name;
  std::size_t allocations = 0, calls = 0;
  for (; calls < 20; ++calls) {
    const std::size_t before = allocation_count();
    ASSERT_TRUE(call().ok()) << name;
    allocations += allocation_count() - before;
  }
  EXPECT_LE(allocations, 8u) << name << ": " << calls << " calls";
}

class WarmPath : public ::testing::Test {
 protected:
  PatchSet set_ = set_of(various_patches(20), with_points());
  std::vector<double> t_ = uniform_parameters(9);
};

TEST_F(WarmPath, Points) {
  Random random(6);
  const Samples<float> samples = random_samples<float>(random, set_.patch_count(), 20000);
  AllBuffers<float> out(samples.size());
  expect_no_allocation("points", [&] { return evaluate(set_, samples.views(), out.views()); });
  const Samples<double> doubles = random_samples<double>(random, set_.patch_count(), 20000);
  AllBuffers<double> fine(doubles.size());
  expect_no_allocation("points in double", [&] { return evaluate(set_, doubles.views(), fine.views()); });
  const SurfaceMap map = value_of(SurfaceMap::make(set_));
  const std::vector<double> half(samples.size(), 0.5);
  const SurfaceSamples on_surfaces{View1<const std::uint32_t>::interleaved(samples.patch),
                                   View1<const double>::interleaved(half), View1<const double>::interleaved(half)};
  expect_no_allocation("points of surfaces", [&] { return evaluate(set_, map, on_surfaces, out.views()); });
}

TEST_F(WarmPath, Updates) {
  const GridPlan plan = value_of(GridPlan::make(set_, t_, t_));
  GridUpdate update = value_of(GridUpdate::make(set_));
  GridBuffers<float> out(plan);
  std::vector<std::uint32_t> patches;
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < set_.patch_count(); k += 2) {
    patches.push_back(static_cast<std::uint32_t>(k));
    for (const Vec3& p : set_.patch(k).points()) points.push_back(p);
  }
  expect_no_allocation("grids that follow", [&] { return update.run(set_, plan, {patches, points}, out.views()); });
  for (const TessellationOptions& options :
       {TessellationOptions{.tolerance = 0.01}, TessellationOptions{.rates = UniformRates{}}}) {
    Tessellation mesh_plan = value_of(Tessellation::make(set_, options));
    Mesh mesh = value_of(mesh_plan.allocate());
    ASSERT_TRUE(mesh_plan.run(set_, mesh.views()).ok());
    expect_no_allocation("meshes that follow", [&] { return mesh_plan.update(set_, {patches, points}, mesh.views()); });
  }
}

TEST_F(WarmPath, Meshes) {
  const auto plan = value_of(Tessellation::make(set_, {.tolerance = 0.01}));
  Mesh mesh = value_of(plan.allocate());
  expect_no_allocation("certified meshes", [&] { return plan.run(set_, mesh.views()); });
}

#ifdef TESSERA_HAS_RAY
TEST_F(WarmPath, Rays) {
  const std::vector<Ray> rays = rays_at(set_, 5000);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> dark(rays.size());
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const RayScene scene = value_of(RayScene::make(set_, {.mode = mode}));
    expect_no_allocation("closest hits", [&] { return scene.closest(rays, hits); });
    expect_no_allocation("occlusion", [&] { return scene.occluded(rays, dark); });
  }
}

TEST_F(WarmPath, BatchesOfRays) {
  std::vector<float> origin, direction;
  for (const Ray& ray : rays_at(set_, 5000)) {
    for (const double x : {ray.origin.x, ray.origin.y, ray.origin.z}) origin.push_back(static_cast<float>(x));
    for (const double x : {ray.direction.x, ray.direction.y, ray.direction.z})
      direction.push_back(static_cast<float>(x));
  }
  RayViews<float> rays;
  rays.origin = View3<const float>::interleaved(origin), rays.direction = View3<const float>::interleaved(direction);
  std::vector<float> t(5000), normal(15000);
  std::vector<std::uint8_t> dark(5000);
  HitViews<float> hits;
  hits.t = View1<float>::soa({t}), hits.normal = View3<float>::interleaved(normal);
  const BatchOptions options{
      .filter = [](const HitCandidate& at) { return at.patch_u < 0.5 ? HitVerdict::reject : HitVerdict::accept; }};
  const RayScene scene = value_of(RayScene::make(set_));
  const std::vector<RayInstance> two{{&scene, Affine{}}, {&scene, Affine::translated({0, 0, 1})}};
  const RayScene instances = value_of(RayScene::make(two));
  for (const RayScene* of : {&scene, &instances}) {
    expect_no_allocation("closest hits in arrays", [&] { return closest(*of, rays, hits); });
    expect_no_allocation("closest hits with a filter", [&] { return closest(*of, rays, hits, options); });
    expect_no_allocation("occlusion in arrays", [&] { return occluded(*of, rays, View1<std::uint8_t>::soa({dark})); });
  }
}
#endif

}}  // namespace tessera::test
