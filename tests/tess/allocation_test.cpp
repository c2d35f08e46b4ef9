// After warm-up a repeated tessellation allocates nothing; plans are small.

#include <algorithm>
#include <limits>

#include "support/allocations.h"
#include "support/synthetic_sets.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

TEST(TessellationAllocation, NoneAfterTheFirstRuns) {
  const PatchSet set = set_of(mixed_patches(1, 400));
  const Tessellation plan = good(Tessellation::make(set, {.rates = UniformRates{6, 5}}));
  Mesh mesh = good(plan.allocate());
  const MeshViews views = mesh.views();
  double done = 0;
  Execution execution;
  execution.progress = [&](double share) { done = share; };
  for (int warm_up = 0; warm_up < 20; ++warm_up) ASSERT_TRUE(plan.run(set, views, execution).ok());
  const std::size_t before = allocation_count();
  EXPECT_GT(before, 0u);  // the count works
  for (int repeat = 0; repeat < 10; ++repeat) ASSERT_TRUE(plan.run(set, views, execution).ok());
  EXPECT_EQ(allocation_count(), before);
  EXPECT_EQ(done, 1);
}

/// The most bytes per patch that `make` holds at a time, besides the memory before.
template <class Make>
double bytes_per_patch(const PatchSet& set, Make make) {
  const std::size_t before = restart_peak();
  make();
  return static_cast<double>(peak_bytes() - before) / static_cast<double>(set.patch_count());
}

TEST(TessellationMemory, PlansTakeLessThanAKilobyteAPatch) {
  const PatchSet set = set_of(wavy_field(60, 50));
  const auto plan = [&](const TessellationOptions& options) { return good(Tessellation::make(set, options)); };
  const View view{.eye = {30, -40, 30}, .target = {30, 25, 0}};
  TessellationOptions options{.tolerance = 0.01};
  EXPECT_LE(bytes_per_patch(set, [&] { (void)plan(options); }), 1024);
  PatchSet edited = set_of(wavy_field(60, 50));
  const std::vector<Vec3> points(edited.patch(7).points().begin(), edited.patch(7).points().end());
  const std::uint32_t patch = 7;
  Mesh mesh = good(plan(options).allocate());
  EXPECT_LE(bytes_per_patch(edited,
                            [&] {
                              Tessellation followed = good(Tessellation::make(edited, options));
                              (void)good(followed.update(edited, {std::span(&patch, 1), points}, mesh.views()));
                            }),
            1024);
  options.joining.weld = 1e-4;
  options.joining.share_vertices = true;
  EXPECT_LE(bytes_per_patch(set, [&] { (void)plan(options); }), 1024);
  EXPECT_LE(bytes_per_patch(set, [&] { (void)plan({.tolerance = 0.01, .angle = 0.1}); }), 1024);
  EXPECT_LE(bytes_per_patch(set, [&] { (void)plan({.pixels = PixelTolerance{1, view}}); }), 1024);
}

TEST(TessellationMemory, GradedSegmentsTakeSixtyFourBytesEach) {
  const PatchSet set = set_of(wavy_field(30, 20));
  for (const double angle : {0.05, 0.02}) {
    std::size_t segments = 0;
    const auto count = [&] {
      const Tessellation plan = good(Tessellation::make(set, {.angle = angle}));
      for (const Division& division : proven_mesh_of(plan).plan().patches().divisions)
        segments += division.ring_count() + static_cast<std::size_t>(division.inner.u.rate() + division.inner.v.rate());
    };
    const double bytes = bytes_per_patch(set, count);
    EXPECT_LE(bytes, 1024 + 64 * static_cast<double>(segments) / 600);
  }
}

TEST(TessellationMemory, PlansOfOneFaceAreSmallBesideOthers) {
  const PatchSet set = set_of({closed_body().front()});
  const auto plan = [&] { return good(Tessellation::make(set, {.tolerance = 0.01})); };
  (void)plan();
  std::vector<Tessellation> many;
  many.reserve(100);
  double least = std::numeric_limits<double>::infinity();  // the scheduler's own memory may add a few bytes
  for (int attempt = 0; attempt < 3; ++attempt) {
    many.clear();
    least = std::min(least, bytes_per_patch(set, [&] {
                       while (many.size() < 100) many.push_back(plan());
                     }));
  }
  EXPECT_LE(least, 100 * 1048 + 8192);  // and the temporary memory of making one
}

TEST(TessellationMemory, MeshesAreWrittenWithNextToNothingBeside) {
  const PatchSet set = set_of(wavy_field(60, 50));
  for (const bool share : {false, true}) {
    const auto plan = good(Tessellation::make(set, {.tolerance = 0.01, .joining = {.share_vertices = share}}));
    Mesh mesh = good(plan.allocate());
    const MeshViews views = mesh.views();
    EXPECT_LE(bytes_per_patch(set, [&] { ASSERT_TRUE(plan.run(set, views).ok()); }), 10);
  }
}

}}  // namespace tessera::test
