// The division of a patch depends on the patch, its neighbours and the options: not on other patches, their number or
// their order.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

/// A quarter of a cone or a cylinder with a wide or a narrow end.
BezierPatch quarter_cone(Random& random, Vec3 centre, double length) {
  const double w = std::sqrt(0.5), narrow = uniform(random, 0.2, 2), skew = random() % 2 ? 1 : uniform(random, 0.5, 2);
  std::vector<Vec3> points = {{1, 0, 0}, {narrow, 0, length},       {1, 1, 0}, {narrow, skew * narrow, length},
                              {0, 1, 0}, {0, skew * narrow, length}};
  for (Vec3& p : points) p = p + centre;
  return rational(2, 1, points, {1, 1, w, w, 1, 1});
}

/// A bicubic patch that bends little or much.
BezierPatch bent_patch(Random& random, Vec3 centre) {
  const double height = std::exp(uniform(random, -6, 1));
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      points.push_back(centre + Vec3{i / 3.0, j / 3.0, 0} + height * uniform_vector(random, -1, 1));
  return polynomial(3, 3, points);
}

/// One of the kinds of patches that have bounds of their own: polynomial, rational, sweeps, flat quadrilaterals.
BezierPatch any_patch(Random& random, Vec3 centre) {
  switch (random() % 6) {
    case 0:
      return bent_patch(random, centre);
    case 1:
      return random_polynomial(random, 3, 3, centre, std::exp(uniform(random, -5, 0)));
    case 2:
      return random_rational(random, 2, 1, 0.5, 2, centre, std::exp(uniform(random, -3, 0)));
    case 3:
      return quarter_cone(random, centre, std::exp(uniform(random, 0, 3)));
    case 4:
      return random_rational(random, 3, 3, 0.2, 5, centre, std::exp(uniform(random, -4, 0)));
    default:
      return polynomial(1, 1,
                        {centre, centre + Vec3{uniform(random, 1, 2), 0, random() % 2 ? 0 : 0.01},
                         centre + Vec3{0, 1, 0}, centre + Vec3{uniform(random, 1, 2), 1, 0}});
  }
}

/// Patches that touch none of the others, near enough to the origin for float vertices.
std::vector<BezierPatch> soup(std::uint64_t seed) {
  Random random(seed);
  std::vector<BezierPatch> patches;
  const int count = 5 + static_cast<int>(random() % 40);
  for (int k = 0; k < count; ++k) patches.push_back(any_patch(random, {4.0 * (k % 7) - 12, 4.0 * (k / 7) - 12, -5}));
  return patches;
}

Tessellation local_decisions_planned(const std::vector<BezierPatch>& patches, const TessellationOptions& options) {
  const PatchSet set = good(PatchSet::make(patches, {.origin = Vec3{}}));
  return good(Tessellation::make(set, options));
}

std::vector<BezierPatch> picked(const std::vector<BezierPatch>& patches, const std::vector<std::size_t>& which) {
  std::vector<BezierPatch> some;
  for (const std::size_t k : which) some.push_back(patches[k]);
  return some;
}

/// Counts the patches among `which` that are divided otherwise, or have another bound, without the rest of the set.
std::size_t changed(const std::vector<BezierPatch>& patches, const Tessellation& whole,
                    const std::vector<std::size_t>& which, const TessellationOptions& options) {
  const Tessellation part = local_decisions_planned(picked(patches, which), options);
  std::size_t count = 0;
  for (std::size_t k = 0; k < which.size(); ++k)
    count += !(proven_mesh_of(part).plan().patches().segments[k] ==
               proven_mesh_of(whole).plan().patches().segments[which[k]]) ||
             !(proven_mesh_of(part).plan().division(k) == proven_mesh_of(whole).plan().division(which[k])) ||
             part.bounds()[k] != whole.bounds()[which[k]];
  return count;
}

/// Removes each third patch, one after the other of three, takes every patch alone, and reverses the order.
std::size_t changed_by_others(const std::vector<BezierPatch>& patches, const TessellationOptions& options) {
  const Tessellation whole = local_decisions_planned(patches, options);
  std::vector<std::size_t> all(patches.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::size_t count = 0;
  for (std::size_t removed = 0; removed < 3; ++removed) {
    std::vector<std::size_t> kept;
    std::copy_if(all.begin(), all.end(), std::back_inserter(kept), [&](std::size_t k) { return k % 3 != removed; });
    count += changed(patches, whole, kept, options);
  }
  for (const std::size_t k : all) count += changed(patches, whole, {k}, options);
  return count + changed(patches, whole, {all.rbegin(), all.rend()}, options);
}

TEST(LocalDecisions, SegmentsDependOnNoPatchThatTouchesNone) {
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const TessellationOptions options{.tolerance = seed % 2 ? 1e-3 : 1e-2};
    count += changed_by_others(soup(seed), options);
  }
  EXPECT_EQ(count, 0u);
}

TEST(LocalDecisions, SegmentsOfAnglesAndPixelsDependOnNoneEither) {
  PixelTolerance pixels;
  pixels.view.eye = {10, -40, 20};
  std::size_t count = 0;
  for (std::uint64_t seed = 121; seed <= 140; ++seed) {
    count += changed_by_others(soup(seed), {.angle = 0.3});
    count += changed_by_others(soup(seed), {.tolerance = 1e-2, .pixels = pixels});
  }
  EXPECT_EQ(count, 0u);
}

}}  // namespace tessera::test
