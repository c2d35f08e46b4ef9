// Head-room: an animated surface keeps its triangles, within the tolerance that is proven in each frame.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/synthetic_sets.h"
#include "tess/followed_mesh.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

constexpr int frames = 60;

struct Played {
  int kept = 0;  ///< frames with the topology of the one before
  std::size_t triangles = 0;
  double largest_bound = 0;
};

/// Plays a wave over a field whose height is a twentieth of the field's size.
Played play(const TessellationOptions& options) {
  const std::vector<BezierPatch> patches = wavy_field(8, 8);
  Animated field(patches, options);
  Played played{.triangles = field.mesh.triangle_count()};
  const double height = 0.05 * field.set.box().diagonal();
  for (int frame = 1; frame <= frames; ++frame) {
    const double now = std::sin(2 * std::numbers::pi * frame / frames);
    Edits edits;
    for (std::uint32_t k = 0; k < patches.size(); ++k) {
      edits.patch.push_back(k);
      for (const Vec3& p : patches[k].points())
        edits.points.push_back({p.x, p.y, p.z + height * now * std::sin(0.8 * p.x) * std::cos(0.7 * p.y)});
    }
    played.kept += !field.run(edits).topology;
    played.largest_bound = std::max(played.largest_bound, field.plan.bound());
  }
  return played;
}

TEST(Headroom, AnAnimationKeepsItsTopologyInNineOfTenFrames) {
  for (TessellationOptions options : {TessellationOptions{.tolerance = 0.002}, {.tolerance = 0.002, .angle = 0.15}}) {
    const Played without = play(options);
    options.headroom = 0.5, options.spare = 1;
    const Played with = play(options);
    EXPECT_LT(without.kept, frames / 5);
    EXPECT_GE(with.kept, frames * 9 / 10);
    EXPECT_LE(with.largest_bound, 0.002);
    EXPECT_LE(with.triangles, 2.3 * static_cast<double>(without.triangles));
  }
}

TEST(Headroom, NewPlansKeepAPartOfTheTolerance) {
  const PatchSet set = set_of(wavy_field(6, 6));
  for (const double headroom : {0.0, 0.3, 0.9}) {
    const Tessellation plan = good(Tessellation::make(set, {.tolerance = 0.01, .headroom = headroom}));
    EXPECT_LE(plan.bound(), (1 - headroom) * 0.01 + 1e-5) << headroom;  // rounding is no part of it
    EXPECT_EQ(plan.tolerance(), 0.01);
  }
}

TEST(Headroom, MustBeAPartOfATolerance) {
  const PatchSet set = set_of(wavy_field(1, 1));
  for (const double headroom : {-0.1, 0.95, 1.0, std::nan("")})
    EXPECT_EQ(Tessellation::make(set, {.tolerance = 0.01, .headroom = headroom}).status().code(),
              StatusCode::invalid_argument);
  EXPECT_EQ(Tessellation::make(set, {.budget = 100, .headroom = 0.5}).status().code(), StatusCode::invalid_argument);
}

}}  // namespace tessera::test
