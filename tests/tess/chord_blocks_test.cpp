// Compares chord bounds in float, sixteen patches at a time, with those in double, patch by patch.

#include "tess/bounds/chord_blocks.h"

#include <algorithm>
#include <bit>
#include <span>

#include "base/impl_access.h"
#include "kernel/table/kernel_table.h"
#include "support/synthetic_sets.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

std::vector<PatchSet> sets() {
  std::vector<PatchSet> all;
  all.push_back(set_of(wavy_field(5, 7)));
  all.push_back(set_of(closed_body()));
  all.push_back(set_of(mixed_patches(7, 60)));
  all.push_back(set_of(placed(closed_body(), 1e-30, {})));
  all.push_back(set_of(placed(closed_body(), 1e30, {})));
  all.push_back(set_of(placed(closed_body(), 1e33, {})));
  all.push_back(set_of(placed(mixed_patches(9, 20), 1e-3, {1e3, -2e3, 5e2})));
  all.push_back(set_of(sphere()));
  for (const int degree : {2, 3, 7}) {
    Random random(static_cast<std::uint64_t>(degree));
    std::vector<BezierPatch> patches;
    for (int k = 0; k < 40; ++k) patches.push_back(random_rational(random, degree, 1 + k % degree));
    all.push_back(set_of(patches));
  }
  return all;
}

ChordBlocks bounds_of(const PatchSet& set) {
  ChordBlocks blocks(impl_of(set));
  for (std::size_t block = 0; block < impl_of(set).lane_counts.size(); ++block) blocks.bound(impl_of(set), block);
  return blocks;
}

/// Whether a patch keeps the bounds of its homogeneous net; bounds from other sources have tests of their own.
bool is_homogeneous(const ChordBlocks& blocks, PatchSet::Slot slot) {
  const ChordBlocks::Source source = blocks.source(slot.block, slot.lane);
  return source == ChordBlocks::Source::packed || source == ChordBlocks::Source::alone;
}

TEST(ChordBlocks, HoldTheBoundsInDoubleAndLittleMore) {
  for (const PatchSet& set : sets()) {
    const ChordBlocks blocks = bounds_of(set);
    for (std::size_t k = 0; k < set.patch_count(); ++k) {
      if (!is_homogeneous(blocks, set.slot(k))) continue;
      const ChordBound exact(impl_of(set).patches[k]), found = blocks.chord(set.slot(k).block, set.slot(k).lane);
      double size = 0;
      for (const Vec3& p : impl_of(set).patches[k].points()) size = std::max(size, max_abs(p - set.origin()));
      const double m = impl_of(set).patches[k].degree_u(), n = impl_of(set).patches[k].degree_v();
      for (std::size_t piece = 0; piece < 9; ++piece) {
        const SecondDerivatives &a = exact.pieces()[piece], &b = found.pieces()[piece];
        const double most = 0x1p-24 * 2 * 1.7321 * (40 + 4 * (m + n)) * size;
        EXPECT_GE(b.uu, a.uu * (1 - 1e-9));
        EXPECT_GE(b.uv, a.uv * (1 - 1e-9));
        EXPECT_GE(b.vv, a.vv * (1 - 1e-9));
        if (impl_of(set).patches[k].is_rational()) {
          // Roots are up to 0.36% too large; a piece's place is off by a rounding over its weights, of 1/2 to 2 here.
          const double rounded = 40 * (m + 1) * (n + 1) * most;
          EXPECT_LE(b.uu, 1.004 * a.uu + rounded);
          EXPECT_LE(b.uv, 1.004 * a.uv + rounded);
          EXPECT_LE(b.vv, 1.004 * a.vv + rounded);
          continue;
        }
        EXPECT_LE(b.uu, a.uu * (1 + 1e-4) + m * m * most);
        EXPECT_LE(b.uv, a.uv * (1 + 1e-4) + m * n * most);
        EXPECT_LE(b.vv, a.vv * (1 + 1e-4) + n * n * most);
      }
    }
  }
}

TEST(ChordBlocks, HoldTheProductsOfQuartersInDoubleAndLittleMore) {
  for (const PatchSet& set : sets()) {
    const ChordBlocks blocks = bounds_of(set);
    for (std::size_t k = 0; k < set.patch_count(); ++k) {
      const BezierPatch& patch = impl_of(set).patches[k];
      if (!is_homogeneous(blocks, set.slot(k))) continue;
      ChordBlocks::Products products;
      products.find(blocks, impl_of(set), set.slot(k).block);
      const ChordBound exact(patch, true), found = blocks.chord(set.slot(k).block, set.slot(k).lane, &products);
      for (std::size_t piece = 5; piece < 9; ++piece) {
        const SecondDerivatives &a = exact.pieces()[piece], &b = found.pieces()[piece];
        const double found_products[] = {b.uu_vv, b.uu_uv, b.uv_vv}, exact_products[] = {a.uu_vv, a.uu_uv, a.uv_vv};
        const double sizes[] = {a.uu * a.vv, a.uu * a.uv, a.uv * a.vv},
                     spare[] = {b.uu * b.vv, b.uu * b.uv, b.uv * b.vv};
        for (int which = 0; which < 3; ++which) {
          if (sizes[which] == 0) continue;  // a degree of 1
          EXPECT_GE(found_products[which], exact_products[which] - 1e-9 * sizes[which]);
          if (std::max(patch.degree_u(), patch.degree_v()) > max_product_degree) continue;
          EXPECT_LE(found_products[which],
                    exact_products[which] + 1e-2 * spare[which] + (spare[which] - sizes[which]) * 40);
        }
      }
    }
  }
}

TEST(ChordBlocks, RatesKeepTheDistanceWithAboutTheFewestCells) {
  for (const PatchSet& set : sets()) {
    const ChordBlocks blocks = bounds_of(set);
    double cells = 0, fewest = 0;
    for (const double relative : {0.1, 1e-2, 1e-3, 1e-4}) {
      ChordBlocks::Lanes<double> distance;
      distance.fill(relative * set.box().diagonal());
      for (std::size_t block = 0; block < impl_of(set).lane_counts.size(); ++block) {
        const std::size_t count = impl_of(set).lane_counts[block];
        ChordBlocks::Products products;
        const ChordBlocks::Choice choice = blocks.cheapest(impl_of(set), block, count, distance, 4096, products);
        for (std::size_t lane = 0; lane < count; ++lane) {
          const bool is_sharp = bool(choice.sharpened >> lane & 1u);
          const ChordBound chord = blocks.chord(block, lane, is_sharp ? &products : nullptr);
          const auto best = chord.cheapest(distance[lane], 4096);
          ASSERT_EQ(best.has_value(), choice.rates[lane].u > 0);
          if (!best) continue;
          EXPECT_LE(choice.distance[lane], distance[lane]);
          EXPECT_LE(chord.distance(choice.rates[lane]), choice.distance[lane]);
          cells += double(choice.rates[lane].u) * choice.rates[lane].v;
          fewest += double(best->u) * best->v;
        }
      }
    }
    EXPECT_LE(cells, 1.025 * fewest);  // reached on random nets; equal on smooth surfaces
  }
}

/// The number of a set's rational patches whose bounds are in blocks.
std::size_t bounded_in_blocks(const PatchSet& set) {
  const ChordBlocks blocks = bounds_of(set);
  std::size_t count = 0;
  for (std::size_t k = 0; k < set.patch_count(); ++k) count += blocks.size(set.slot(k).block, set.slot(k).lane) ? 1 : 0;
  return count;
}

TEST(ChordBlocks, RationalPatchesAreBoundedInBlocksWhereRoundingIsSmall) {
  EXPECT_EQ(bounded_in_blocks(set_of(sphere())), 8u);
  // Four patches far smaller than the model, and one of high degree, are not.
  std::vector<BezierPatch> patches = sphere();
  const std::vector<BezierPatch> small = placed(sphere(), 1e-6, {0.3, 0.4, 0.2});
  patches.insert(patches.end(), small.begin(), small.begin() + 4);
  Random random(4);
  patches.push_back(random_rational(random, 8, 3));
  EXPECT_EQ(bounded_in_blocks(set_of(patches)), 8u);
}

TEST(ChordBlocks, RationalBoundsAreTheSameBitsOnEveryInstructionSet) {
  for (const PatchSet& set : sets()) {
    for (const BlockGroup& group : impl_of(set).groups) {
      if (!group.rational || std::max(group.degree_u, group.degree_v) > kernel::max_rational_degree) continue;
      std::vector<std::uint32_t> first;
      for (const Isa isa : available_isas()) {
        alignas(64) float pieces[27 * 16], products[27 * 16] = {}, unit[16], size[16];
        const float* net = impl_of(set).f32.bernstein.data() + group.first_value;
        kernel::kernels(isa).bound_rational_chords({net, group.degree_u, group.degree_v, pieces, unit, size});
        if (std::max(group.degree_u, group.degree_v) <= kernel::max_product_degree)
          kernel::kernels(isa).bound_rational_products(
              {net, group.degree_u, group.degree_v, pieces, unit, products, nullptr});
        std::vector<std::uint32_t> bits;
        for (const std::span<const float> values : {std::span<const float>(pieces), std::span<const float>(products),
                                                    std::span<const float>(unit), std::span<const float>(size)})
          for (const float x : values) bits.push_back(std::bit_cast<std::uint32_t>(x));
        if (first.empty()) first = bits;
        EXPECT_EQ(bits, first) << name(isa);
      }
    }
  }
}

TEST(ChordBlocks, TheSameBitsOnEveryInstructionSet) {
  for (const PatchSet& set : sets()) {
    const BlockGroup& group = impl_of(set).groups.front();
    if (group.rational) continue;
    std::vector<std::uint32_t> first;
    for (const Isa isa : available_isas()) {
      alignas(64) float pieces[27 * 16], unit[16], size[16], chord[16], distance[16];
      alignas(64) std::int32_t rate_u[16], rate_v[16];
      std::uint32_t hash[64];
      const float* net = impl_of(set).f32.bernstein.data() + group.first_value;
      kernel::kernels(isa).bound_chords({net, group.degree_u, group.degree_v, pieces, unit, size});
      std::fill(std::begin(distance), std::end(distance), 1e-3f);
      kernel::kernels(isa).find_rates({pieces, distance, 4096, rate_u, rate_v, chord});
      alignas(64) float products[27 * 16] = {}, share[16] = {}, sharp_chord[16] = {};
      alignas(64) std::int32_t sharp_u[16] = {}, sharp_v[16] = {};
      if (std::max(group.degree_u, group.degree_v) <= kernel::max_product_degree) {
        kernel::kernels(isa).bound_products({net, group.degree_u, group.degree_v, pieces, unit, products, nullptr});
        kernel::kernels(isa).share_of_products({net, group.degree_u, group.degree_v, pieces, unit, nullptr, share});
        kernel::kernels(isa).find_rates({pieces, distance, 4096, sharp_u, sharp_v, sharp_chord, products});
      }
      kernel::kernels(isa).hash_borders({net, group.degree_u, group.degree_v, false, hash});
      std::vector<std::uint32_t> bits(hash, hash + 64);
      for (const std::span<const float> values : {std::span<const float>(pieces), std::span<const float>(products),
                                                  std::span<const float>(share), std::span<const float>(sharp_chord)})
        for (const float x : values) bits.push_back(std::bit_cast<std::uint32_t>(x));
      for (int lane = 0; lane < 16; ++lane) {
        EXPECT_LE(std::int64_t{sharp_u[lane]} * sharp_v[lane], std::int64_t{rate_u[lane]} * rate_v[lane]);
        bits.push_back(static_cast<std::uint32_t>(sharp_u[lane]));
        bits.push_back(static_cast<std::uint32_t>(sharp_v[lane]));
      }
      for (int lane = 0; lane < 16; ++lane)
        for (const std::uint32_t x :
             {std::bit_cast<std::uint32_t>(unit[lane]), std::bit_cast<std::uint32_t>(chord[lane]),
              static_cast<std::uint32_t>(rate_u[lane]), static_cast<std::uint32_t>(rate_v[lane])})
          bits.push_back(x);
      if (first.empty()) first = bits;
      EXPECT_EQ(bits, first) << name(isa);
    }
  }
}

}}  // namespace tessera::test
