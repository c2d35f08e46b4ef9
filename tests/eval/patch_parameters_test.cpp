// Parameters of each patch's own: the bits of the same parameters for all patches, in every layout; and bad lists.

#include <gtest/gtest.h>

#include <limits>

#include "support/grids.h"

namespace tessera::test { namespace {

constexpr std::size_t count_u = 4, count_v = 5;

std::vector<double> random_parameters(Random& random, std::size_t count) {
  std::vector<double> t;
  std::uniform_int_distribution<int> edge(0, 3);
  for (std::size_t k = 0; k < count; ++k) {  // 0 and 1 often: edges may be collapsed
    const int e = edge(random);
    t.push_back(e == 0 ? 0 : e == 1 ? 1 : uniform(random, 0, 1));
  }
  return t;
}

PatchSet set_with_poles() {
  Random random(61);
  std::vector<BezierPatch> patches = mixed_patches(random, 4, 2);
  for (const BezierPatch& octant : sphere()) patches.push_back(octant);
  std::shuffle(patches.begin(), patches.end(), random);
  PatchSetOptions options;
  options.blocks.double_bernstein = true;
  return set_of(patches, options);
}

template <class T>
void check_own(const PatchSet& set, Isa isa) {
  SCOPED_TRACE(name(isa));
  Random random(62);
  const std::vector<double> u = random_parameters(random, set.patch_count() * count_u);
  const std::vector<double> v = random_parameters(random, set.patch_count() * count_v);
  const GridPlanOptions options{.precision = precision_of<T>, .isa = isa};
  const GridPlan plan = value_of(GridPlan::make(set, PatchParameters{u, v}, options));
  ASSERT_EQ(plan.count_u(), count_u);
  ASSERT_EQ(plan.count_v(), count_v);
  AllBuffers<T> own(plan);
  ASSERT_TRUE(evaluate(set, plan, own.views()).ok());
  AlignedVector<T> blocks(plan.block_capacity());
  ASSERT_TRUE(evaluate(set, plan, QuantityBlocks<T>{.position = blocks}, {.stores = Stores::streaming}).ok());
  const std::size_t samples = count_u * count_v;
  for (std::size_t patch = 0; patch < set.patch_count(); patch += 3) {
    const GridPlan shared = value_of(GridPlan::make(set, std::span(u).subspan(patch * count_u, count_u),
                                                    std::span(v).subspan(patch * count_v, count_v), options));
    AllBuffers<T> all(shared);
    ASSERT_TRUE(evaluate(set, shared, all.views()).ok());
    const auto part = [&](const auto& values, std::size_t width) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(patch * samples * width);
      return std::vector(first, first + static_cast<std::ptrdiff_t>(samples * width));
    };
    for (std::size_t k = 0; k < own.values.size(); ++k) {
      const std::size_t width = own.values[k].size() / plan.capacity();
      EXPECT_EQ(part(own.values[k], width), part(all.values[k], width)) << "patch " << patch << ", output " << k;
    }
    EXPECT_EQ(part(own.normal_kind, 1), part(all.normal_kind, 1)) << patch;
    EXPECT_EQ(part(own.curvature_kind, 1), part(all.curvature_kind, 1)) << patch;
    const PatchSet::Slot slot = set.slot(patch);
    for (std::size_t s = 0; s < samples; ++s)
      EXPECT_EQ(blocks[(slot.block * samples + s) * 3 * PatchSet::lanes + slot.lane],
                own.values[0][3 * (patch * samples + s)]);
  }
}

TEST(PatchParameters, AreThoseOfAllPatchesBitForBit) {
  const PatchSet set = set_with_poles();
  for (const Isa isa : available_isas()) {
    check_own<float>(set, isa);
    check_own<double>(set, isa);
  }
}

TEST(PatchParameters, Errors) {
  Random random(63);
  const PatchSet set = set_of({random_polynomial(random, 3, 3), random_polynomial(random, 2, 2)});
  const auto status = [&](std::vector<double> u, std::vector<double> v) {
    return GridPlan::make(set, PatchParameters{u, v}).status();
  };
  EXPECT_TRUE(status({0, 1}, {0, 1, 0.5, 0.25}).ok());
  EXPECT_EQ(status({0, 1, 0}, {0, 1}).code(), StatusCode::invalid_argument);
  EXPECT_NE(status({0, 1, 0}, {0, 1}).message().find('3'), std::string::npos);
  EXPECT_EQ(status({}, {0, 1}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(status({0, 1}, {0, 1.5}).index(), 1);
  EXPECT_EQ(status({0, std::numeric_limits<double>::quiet_NaN()}, {0, 1}).code(), StatusCode::non_finite);
}

}}  // namespace tessera::test
