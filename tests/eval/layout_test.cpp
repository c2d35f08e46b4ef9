// Every layout holds the same values in the places that evaluate.h names, for any size of grid.

#include <gtest/gtest.h>

#include <cstring>

#include "support/grids.h"

namespace tessera::test { namespace {

/// All outputs of a small mixed set, as triples.
template <class T>
struct Case {
  PatchSet set;
  GridPlan plan;
  GridBuffers<T> expected;

  Case(int nu, int nv, Isa isa) : set(make_set()), plan(make_plan(set, nu, nv, isa)), expected(plan) {
    EXPECT_TRUE(evaluate(set, plan, expected.views()).ok());
  }
  static PatchSet make_set() {
    Random random(31);
    PatchSetOptions options;
    options.blocks.double_bernstein = true;
    return set_of(mixed_patches(random, 3, 2), options);
  }
  static GridPlan make_plan(const PatchSet& set, int nu, int nv, Isa isa) {
    std::vector<double> u, v;
    for (int i = 0; i < nu; ++i) u.push_back((i + 0.5) / nu);
    for (int j = 0; j < nv; ++j) v.push_back((j + 0.25) / nv);
    return value_of(GridPlan::make(set, u, v, {.precision = precision_of<T>, .isa = isa}));
  }
  void expect_at(std::size_t record, const Vec3& position, const Vec3& normal) const {
    EXPECT_EQ(position, vector_at(expected.position, record)) << record;
    EXPECT_EQ(normal, vector_at(expected.normal, record)) << record;
  }
};

template <class T>
void check_layouts(int nu, int nv, Isa isa) {
  SCOPED_TRACE(testing::Message() << nu << "x" << nv << " " << name(isa));
  const Case<T> c(nu, nv, isa);
  const std::size_t count = c.plan.capacity();
  // Structure of arrays, misaligned by one value.
  std::vector<T> soa(6 * count + 1, T(-7));
  const auto array = [&](std::size_t k) { return std::span<T>(soa).subspan(1 + k * count, count); };
  const auto positions = View3<T>::soa({array(0), array(1), array(2)}),
             normals = View3<T>::soa({array(3), array(4), array(5)});
  ASSERT_TRUE(evaluate(c.set, c.plan, QuantityViews<T>{.position = positions, .normal = normals}).ok());
  // One record of normal and position; and one with a gap.
  std::vector<T> tight(6 * count + 1, T(-7)), gap(8 * count, T(-7));
  const std::span<T> off_by_one = std::span<T>(tight).subspan(1);
  const auto tight_normals = View3<T>::interleaved(off_by_one, 6, 0),
             tight_positions = View3<T>::interleaved(off_by_one, 6, 3);
  ASSERT_TRUE(evaluate(c.set, c.plan, QuantityViews<T>{.position = tight_positions, .normal = tight_normals}).ok());
  const auto gap_positions = View3<T>::interleaved(gap, 8, 1), gap_normals = View3<T>::interleaved(gap, 8, 5);
  ASSERT_TRUE(evaluate(c.set, c.plan, QuantityViews<T>{.position = gap_positions, .normal = gap_normals}).ok());
  for (std::size_t k = 0; k < count; ++k) {
    c.expect_at(k, read(positions, k), read(normals, k));
    c.expect_at(k, read(tight_positions, k), read(tight_normals, k));
    c.expect_at(k, read(gap_positions, k), read(gap_normals, k));
    EXPECT_EQ(gap[8 * k], T(-7));  // what lies between the fields is not touched
    EXPECT_EQ(gap[8 * k + 4], T(-7));
  }
  EXPECT_EQ(soa[0], T(-7));
  EXPECT_EQ(tight[0], T(-7));
}

TEST(Layout, ViewsOfAnySizeFloat) {
  for (const Isa isa : available_isas())
    for (const auto& [nu, nv] : {std::pair{1, 1}, {2, 3}, {5, 3}, {4, 16}, {17, 2}, {3, 100}, {33, 33}})
      check_layouts<float>(nu, nv, isa);
}
TEST(Layout, ViewsOfAnySizeDouble) {
  for (const Isa isa : available_isas())
    for (const auto& [nu, nv] : {std::pair{1, 1}, {2, 3}, {5, 3}, {4, 16}, {17, 2}, {3, 100}})
      check_layouts<double>(nu, nv, isa);
}

template <class T>
void check_blocks(Isa isa, Stores stores) {
  const Case<T> c(5, 7, isa);
  AlignedVector<T> position(c.plan.block_capacity()), normal(position.size()), du(position.size());
  Execution execution;
  execution.stores = stores;
  ASSERT_TRUE(
      evaluate(c.set, c.plan, QuantityBlocks<T>{.position = position, .du = du, .normal = normal}, execution).ok());
  const std::size_t samples = 35, lanes = PatchSet::lanes;
  for (std::size_t patch = 0; patch < c.set.patch_count(); ++patch) {
    const PatchSet::Slot slot = c.set.slot(patch);
    for (std::size_t s = 0; s < samples; ++s) {
      const std::size_t first = (slot.block * samples + s) * 3 * lanes + slot.lane;
      const auto at = [&](const auto& values) {
        return Vec3{values[first], values[first + lanes], values[first + 2 * lanes]};
      };
      c.expect_at(patch * samples + s, at(position), at(normal));
      EXPECT_EQ(at(du), vector_at(c.expected.du, patch * samples + s));
    }
  }
}

TEST(Layout, BlocksPlainAndStreamed) {
  for (const Isa isa : available_isas())
    for (const Stores stores : {Stores::plain, Stores::streaming}) {
      check_blocks<float>(isa, stores);
      check_blocks<double>(isa, stores);
    }
}

/// Each output alone equals the one together with the others.
TEST(Layout, AnySubsetOfOutputs) {
  for (const Isa isa : available_isas()) {
    const Case<float> c(5, 6, isa);
    for (int subset = 1; subset < 16; ++subset) {
      GridBuffers<float> out(c.plan);
      QuantityViews<float> views = out.views();
      GridBuffers<float> expected(c.plan);
      if (subset & 1)
        expected.position = c.expected.position;
      else
        views.position = {};
      if (subset & 2)
        expected.du = c.expected.du;
      else
        views.du = {};
      if (subset & 4)
        expected.dv = c.expected.dv;
      else
        views.dv = {};
      if (subset & 8)
        expected.normal = c.expected.normal;
      else
        views.normal = {};
      ASSERT_TRUE(evaluate(c.set, c.plan, views).ok());
      EXPECT_TRUE(out == expected) << "subset " << subset << " " << name(isa);
    }
  }
}

}}  // namespace tessera::test
