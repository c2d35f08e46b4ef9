// Finds which borders are one edge; compared with a comparison of all with all by their bits.

#include "tess/edges/shared_edges.h"

#include <bit>
#include <map>

#include "base/impl_access.h"
#include "kernel/table/kernel_table.h"
#include "support/edges_of_set.h"
#include "support/grids.h"
#include "support/points.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

using Bits = std::vector<std::uint32_t>;

std::size_t edges_of(const PatchSet& set) { return edges_of_set(set).count(); }

/// A border's numbers, in the direction that gives the smaller ones.
Bits bits_of(const PatchSet::Impl& set, std::size_t patch, Side side) {
  const PackedBorder border(set, patch, side);
  Bits forward, backward;
  for (int k = 0; k < border.count(); ++k)
    for (int c = 0; c < border.components(); ++c) {
      forward.push_back(std::bit_cast<std::uint32_t>(border.value(k, c)));
      backward.push_back(std::bit_cast<std::uint32_t>(border.value(border.count() - 1 - k, c)));
    }
  return std::min(forward, backward);
}

void expect_edges_by_bits(const PatchSet& set, const char* what) {
  const SharedEdges edges = edges_of_set(set);
  std::map<Bits, std::uint32_t> known;
  std::vector<bool> seen(edges.count(), false);
  for (std::size_t patch = 0; patch < set.patch_count(); ++patch)
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges.edge(patch, side);
      if (impl_of(set).collapsed[patch].has(side)) {
        EXPECT_EQ(edge, no_id);
        continue;
      }
      ASSERT_LT(edge, edges.count()) << what;
      seen[edge] = true;
      const auto [found, is_new] = known.emplace(bits_of(impl_of(set), patch, side), edge);
      ASSERT_EQ(found->second, edge) << what << ": patch " << patch << ", side " << static_cast<int>(side);
    }
  EXPECT_EQ(known.size(), edges.count()) << what;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), std::ptrdiff_t(edges.count())) << what;
}

std::vector<BezierPatch> with_weights(const std::vector<BezierPatch>& patches) {
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    const std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    std::vector<double> weights;  // symmetric, so that borders are shared whichever way they run
    for (int i = 0; i <= patch.degree_u(); ++i)
      for (int j = 0; j <= patch.degree_v(); ++j) weights.push_back((i % 3 == 0 ? 1 : 2) * (j % 3 == 0 ? 1 : 1.5));
    out.push_back(rational(patch.degree_u(), patch.degree_v(), points, weights));
  }
  return out;
}

TEST(SharedEdges, AreThoseWhoseBordersAreTheSameBits) {
  Random random(7);
  const std::vector<BezierPatch> field = wavy_field(9, 23);  // rows that do not end with blocks
  expect_edges_by_bits(set_of(field), "in rows");
  EXPECT_EQ(edges_of(set_of(field)), 9u * 24 + 10 * 23);
  expect_edges_by_bits(set_of(with_weights(field)), "rational");

  std::vector<BezierPatch> turned;
  for (const BezierPatch& patch : field) turned.push_back(reoriented(patch, static_cast<int>(random() % 8)));
  expect_edges_by_bits(set_of(turned), "every which way");
  for (std::size_t k = 0; k < field.size(); ++k) turned[k] = reoriented(field[k], k % 46 < 23 ? 0 : 6);
  expect_edges_by_bits(set_of(turned), "row against row");

  std::vector<BezierPatch> shuffled;
  for (const std::size_t k : shuffled_order(random, field.size())) shuffled.push_back(field[k]);
  expect_edges_by_bits(set_of(shuffled), "in any order");

  std::vector<BezierPatch> doubled = field;  // four borders an edge, and groups of blocks between each other's patches
  for (const BezierPatch& patch : with_weights(field)) doubled.push_back(patch);
  for (const BezierPatch& patch : mixed_patches(random, 3, 3)) doubled.push_back(patch);
  for (const BezierPatch& patch : field) doubled.push_back(patch);
  expect_edges_by_bits(set_of(doubled), "doubled and mixed");
}

TEST(SharedEdges, ABitApartIsAnotherEdge) {
  std::vector<BezierPatch> field = wavy_field(6, 20);
  const std::size_t whole = edges_of(set_of(field));
  // An inner control point of the border between patches 50 and 51, in one of them.
  std::vector<Vec3> points(field[50].points().begin(), field[50].points().end());
  points[13].x = std::nextafter(static_cast<float>(points[13].x), 1e9f);
  field[50] = polynomial(3, 3, points);
  const PatchSet set = set_of(field);
  expect_edges_by_bits(set, "one moved");
  EXPECT_GT(edges_of(set), whole);
}

TEST(SharedEdges, MatchedBordersDifferWhereABitDoesOnEveryInstructionSet) {
  Random random(9);
  constexpr std::size_t lanes = PatchSet::lanes, count = 4, components = 3;
  std::vector<float> own(count * components * lanes), others(own.size());
  for (float& x : own) x = static_cast<float>(uniform(random, -1, 1));
  std::array<std::int32_t, lanes> place;
  for (std::size_t lane = 0; lane < lanes; ++lane) place[lane] = static_cast<std::int32_t>((lane * 5 + 3) % lanes);
  for (const bool reversed : {false, true})
    for (std::size_t changed = 0; changed <= count * components; ++changed) {
      for (std::size_t k = 0; k < count; ++k)
        for (std::size_t c = 0; c < components; ++c)
          for (std::size_t lane = 0; lane < lanes; ++lane) {
            float x = own[(k * components + c) * lanes + lane];
            // In the odd lanes one number is off.
            if (lane % 2 == 1 && k * components + c == changed)
              x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) ^ 1u);
            others[((reversed ? count - 1 - k : k) * components + c) * lanes + static_cast<std::size_t>(place[lane])] =
                x;
          }
      const std::ptrdiff_t step = components * lanes;
      for (const Isa isa : available_isas()) {
        std::array<std::uint32_t, lanes> differing;
        kernel::kernels(isa).match_borders({.first = own.data(),
                                            .step = step,
                                            .count = count,
                                            .components = components,
                                            .others = others.data() + (reversed ? step * std::ptrdiff_t(count - 1) : 0),
                                            .place = place.data(),
                                            .other_step = reversed ? -step : step,
                                            .differing = differing.data()});
        for (std::size_t lane = 0; lane < lanes; ++lane)
          EXPECT_EQ(differing[lane] != 0, lane % 2 == 1 && changed < count * components)
              << name(isa) << ", lane " << lane;
      }
    }
}

}}  // namespace tessera::test
