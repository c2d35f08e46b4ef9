// Bounds that are found in double: exact numerators of rational patches, scaled sweeps, flat quadrilaterals.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "base/impl_access.h"
#include "kernel/table/kernel_table.h"
#include "support/reference.h"
#include "support/synthetic_sets.h"
#include "tess/bounds/chord_blocks.h"
#include "tess/bounds/flat_quad.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"

namespace tessera::test { namespace {

constexpr std::size_t lanes = PatchSet::lanes;

struct Found {
  alignas(64) std::array<double, lanes> deviation;
  alignas(64) std::array<double, 27 * lanes> pieces;
  double bound(std::size_t piece, std::size_t kind, std::size_t lane) const {
    return pieces[(piece * 3 + kind) * lanes + lane];
  }
};

/// Up to 16 patches of the same degrees, by the kernel of an instruction set.
Found found(const std::vector<BezierPatch>& patches, Isa isa) {
  const int m = patches[0].degree_u(), n = patches[0].degree_v();
  const AlignedVector<double> net = [&] {
    AlignedVector<double> values(static_cast<std::size_t>((m + 1) * (n + 1) * 4) * lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const BezierPatch& patch = patches[lane % patches.size()];
      double heaviest = 0;
      for (int k = 0; k < (m + 1) * (n + 1); ++k) heaviest = std::max(heaviest, patch.weight(k / (n + 1), k % (n + 1)));
      const Vec3 centre = patch.hull_box().centre();
      for (int k = 0; k < (m + 1) * (n + 1); ++k) {
        const double w = patch.weight(k / (n + 1), k % (n + 1)) / heaviest;
        const Vec3 p = w * (patch.point(k / (n + 1), k % (n + 1)) - centre);
        const double numbers[] = {p.x, p.y, p.z, w};
        for (std::size_t c = 0; c < 4; ++c) values[(static_cast<std::size_t>(k) * 4 + c) * lanes + lane] = numbers[c];
      }
    }
    return values;
  }();
  Found of;
  kernel::kernels(isa).bound_exact_chords({.net = net.data(),
                                           .degree_u = m,
                                           .degree_v = n,
                                           .any_patch = true,
                                           .deviation = of.deviation.data(),
                                           .pieces = of.pieces.data()});
  return of;
}

double size(RealVec3 a) { return static_cast<double>(std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z)); }

constexpr double piece_box[9][4] = {{0, 1, 0, 1},   {0, .5, 0, 1},  {.5, 1, 0, 1},  {0, 1, 0, .5}, {0, 1, .5, 1},
                                    {0, .5, 0, .5}, {0, .5, .5, 1}, {.5, 1, 0, .5}, {.5, 1, .5, 1}};

/// The largest |r_uu|, |r_uv|, |r_vv| found over a piece.
std::array<double, 3> sampled(const BezierPatch& patch, std::size_t piece, int steps) {
  std::array<double, 3> most{};
  const auto& box = piece_box[piece];
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j) {
      const double u = box[0] + (box[1] - box[0]) * i / steps, v = box[2] + (box[3] - box[2]) * j / steps;
      const RealJet jet = reference_jet(patch, u, v);
      most[0] = std::max(most[0], size(jet.duu));
      most[1] = std::max(most[1], size(jet.duv));
      most[2] = std::max(most[2], size(jet.dvv));
    }
  return most;
}

TEST(ExactChords, HoldTheSecondDerivativesAndLittleMore) {
  Random random(1);
  for (const double spread : {2.0, 10.0, 1000.0})
    for (int m = 1; m <= 3; ++m)
      for (int n = 1; n <= 3; ++n) {
        std::vector<BezierPatch> patches;
        for (std::size_t k = 0; k < lanes; ++k)
          patches.push_back(random_rational(random, m, n, 1 / spread, spread, 100 * uniform_vector(random, -1, 1)));
        for (const Isa isa : available_isas()) {
          const Found of = found(patches, isa);
          double over = 0;
          for (std::size_t lane = 0; lane < lanes; ++lane)
            for (std::size_t piece = 0; piece < 9; ++piece) {
              const auto most = sampled(patches[lane], piece, 5);
              for (std::size_t kind = 0; kind < 3; ++kind) {
                ASSERT_GE(of.bound(piece, kind, lane), most[kind]) << m << n << spread << " piece " << piece << kind;
                if (piece >= 5 && most[kind] > 0) over += of.bound(piece, kind, lane) / most[kind] / (4 * 3 * lanes);
              }
            }
          if (spread == 2) {
            EXPECT_LT(over, 1.3) << m << n;
          }
        }
      }
}

TEST(ExactChords, AreTheSameBytesOnEveryInstructionSet) {
  Random random(2);
  for (const int degree : {1, 2, 3, 5}) {
    std::vector<BezierPatch> patches;
    for (std::size_t k = 0; k < lanes; ++k) patches.push_back(random_rational(random, degree, 3, 0.5, 2));
    const Found first = found(patches, available_isas()[0]);
    for (const Isa isa : available_isas()) {
      const Found other = found(patches, isa);
      EXPECT_EQ(std::memcmp(first.pieces.data(), other.pieces.data(), sizeof first.pieces), 0);
      EXPECT_EQ(std::memcmp(first.deviation.data(), other.deviation.data(), sizeof first.deviation), 0);
    }
  }
}

/// A patch 1000 long in a block with 15 round ones: bounds of the homogeneous patch would take thousands of cells.
TEST(ExactChords, AreLookedForWhereThereIsMuchToGain) {
  Random random(6);
  const double w = std::sqrt(0.5);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 15; ++k) patches.push_back(random_rational(random, 2, 1, 0.5, 2));
  // A quarter of a cylinder with an elliptic end: no sweep.
  patches.push_back(rational(2, 1, {{1, 0, 0}, {1, 0, 1000}, {1, 1, 0}, {1, 1.5, 1000}, {0, 1, 0}, {0, 1.5, 1000}},
                             {1, 1, w, w, 1, 1}));
  const auto plan = good(Tessellation::make(set_of(patches), {.tolerance = 0.01}));
  EXPECT_LT(proven_mesh_of(plan).plan().division(15).triangle_count(), 200u);
}

/// rho_j E_i + T_j with weights a_i b_j. `to_zero`: rho falls to 0.
BezierPatch random_sweep(Random& random, int m, int n, double spread, bool to_zero) {
  std::vector<Vec3> e, t;
  std::vector<double> rho, a, b;
  const auto weight = [&] { return std::exp(uniform(random, -std::log(spread), std::log(spread))); };
  for (int i = 0; i <= m; ++i) e.push_back(uniform_vector(random, -1, 1)), a.push_back(weight());
  for (int j = 0; j <= n; ++j) {
    t.push_back(uniform_vector(random, -1, 1)), b.push_back(weight());
    rho.push_back(to_zero && j == n ? 0 : uniform(random, 0, 2));
  }
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      points.push_back(rho[static_cast<std::size_t>(j)] * e[static_cast<std::size_t>(i)] +
                       t[static_cast<std::size_t>(j)]);
      weights.push_back(a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)]);
    }
  return rational(m, n, points, weights);
}

TEST(ScaledSweeps, AreFoundAlongEitherParameterAndBounded) {
  Random random(3);
  for (int kind = 0; kind < 60; ++kind) {
    const int m = 1 + static_cast<int>(random() % 15), n = 1 + static_cast<int>(random() % 15);
    std::vector<BezierPatch> patches;
    for (std::size_t k = 0; k < lanes; ++k) {
      const BezierPatch patch = random_sweep(random, m, n, 2, k % 3 == 0);
      patches.push_back(patch);
    }
    if (kind % 2)
      for (BezierPatch& patch : patches) patch = transposed(patch);
    const Isa isa = available_isas()[random() % available_isas().size()];
    const Found of = found(patches, isa);
    for (std::size_t lane = 0; lane < lanes; lane += 7) {
      ASSERT_LT(of.deviation[lane], 1e-11) << m << " x " << n;
      for (std::size_t piece = 0; piece < 9; ++piece) {
        const auto most = sampled(patches[lane], piece, 4);
        EXPECT_GE(of.bound(piece, 0, lane), most[0] * (1 - 1e-9));
        EXPECT_EQ(of.bound(piece, 1, lane), 0);
        EXPECT_GE(of.bound(piece, 2, lane), most[2] * (1 - 1e-9));
      }
    }
  }
}

TEST(ScaledSweeps, OthersAreNone) {
  Random random(4);
  const double infinite = std::numeric_limits<double>::infinity();
  for (int kind = 0; kind < 60; ++kind) {
    const BezierPatch sweep = random_sweep(random, 2, 3, 2, false);
    std::vector<Vec3> points(sweep.points().begin(), sweep.points().end());
    std::vector<double> weights(sweep.weights().begin(), sweep.weights().end());
    const std::size_t where = random() % points.size();
    if (kind % 3 == 0) points[where].y += 1e-6;
    if (kind % 3 == 1) weights[where] *= 1 + 1e-6;
    if (kind % 3 == 2)  // rho turns negative
      for (std::size_t i = 0; i <= 2; ++i) points[i * 4 + 3] = Vec3{5, 5, 5} - (points[i * 4] - points[0]);
    const Found of = found({rational(2, 3, points, weights)}, available_isas().back());
    EXPECT_EQ(of.deviation[0], infinite) << kind;
    EXPECT_GT(of.bound(0, 1, 0), 0);
  }
}

/// The proof's map, step by step: each point of any triangle, whatever its corners, lies within the bound of the
/// patch's point at (u', v').
TEST(ScaledSweeps, TheMixedDerivativeDoesNotCount) {
  Random random(5);
  double largest = 0;
  for (int kind = 0; kind < 400; ++kind) {
    const int m = 1 + static_cast<int>(random() % 5), n = 1 + static_cast<int>(random() % 5);
    const BezierPatch patch = random_sweep(random, m, n, 3, kind % 4 == 0);
    const Found of = found({patch}, available_isas().back());
    ASSERT_LT(of.deviation[0], 1e-11);
    // rho by the length of r(1,v) - r(0,v), which is rho(v) (E(1) - E(0)).
    const auto rho = [&](double v) {
      return length(reference_position(patch, 1, v) - reference_position(patch, 0, v));
    };
    for (int sample = 0; sample < 20; ++sample) {
      const double h = uniform(random, 0, 1), k = uniform(random, 0, 1), u0 = uniform(random, 0, 1 - h),
                   v0 = uniform(random, 0, 1 - k);
      double u[3], v[3], weight[3], t[3] = {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
      const double sum = t[0] + t[1] + t[2];
      Vec3 on_triangle;
      double mean_v = 0, mean_u = 0, weights = 0;
      for (int c = 0; c < 3; ++c) {
        u[c] = u0 + h * (c < 2 ? c : uniform(random, 0, 1));
        v[c] = v0 + k * (c == 0 ? uniform(random, 0, 1) : c - 1);
        t[c] /= sum, weight[c] = rho(v[c]);
        on_triangle = on_triangle + t[c] * reference_position(patch, u[c], v[c]);
        mean_v += t[c] * v[c], mean_u += t[c] * weight[c] * u[c], weights += t[c] * weight[c];
      }
      if (!(weights > 0)) continue;
      mean_u = std::clamp(mean_u / weights, 0.0, 1.0);
      const double off = length(on_triangle - reference_position(patch, mean_u, std::min(mean_v, 1.0)));
      const double bound = (h * h * of.bound(0, 0, 0) + k * k * of.bound(0, 2, 0)) / 8;
      ASSERT_LE(off, bound + 1e-12) << m << " x " << n;
      largest = std::max(largest, off / bound);
    }
  }
  EXPECT_GT(largest, 0.5);
}

std::vector<BezierPatch> shifted_cylinder(double height, const Vec3& shift) {
  const double w = std::sqrt(0.5);
  const Vec3 corners[] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  std::vector<BezierPatch> patches;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 a = corners[k], b = corners[(k + 1) % 4], up{0, 0, height};
    std::vector<Vec3> points{a, a + up, a + b, a + b + up, b, b + up};
    for (Vec3& p : points) p = p + shift;
    patches.push_back(rational(2, 1, points, {1, 1, w, w, 1, 1}));
  }
  return patches;
}

TEST(ScaledSweeps, ACylinderTakesAsManyTrianglesAtAnyHeightAndPlace) {
  const auto triangles = [](double height, const Vec3& shift, double tolerance) {
    return good(Tessellation::make(set_of(shifted_cylinder(height, shift)), {.tolerance = tolerance}))
        .capacity()
        .triangles;
  };
  for (const double height : {1.0, 4.0, 100.0}) {
    EXPECT_EQ(triangles(height, {}, 0.01), 48u) << height;
    EXPECT_EQ(triangles(height, {1e9, -1e8, 1e7}, 0.01), 48u) << height;
  }
  EXPECT_EQ(triangles(4, {}, 0.001), 152u);
}

TEST(FlatQuads, TakeTwoTriangles) {
  const BezierPatch square = rational(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}, {1, 1, 1, 3});
  const BezierPatch slanted = polynomial(1, 1, {{0, 0, 0}, {0.1, 1, 1}, {3, 0, 0.5}, {1, 2, 2.0 + 1.0 / 6}});
  for (const BezierPatch& patch : {square, polynomial(2, 2,
                                                      {{0, 0, 0},
                                                       {0, .9, 0},
                                                       {0, 1, 0},
                                                       {.1, 0, 0},
                                                       {.8, .1, 0},
                                                       {.3, 1, 0},
                                                       {2, 0, 0},
                                                       {2, .3, 0},
                                                       {2, 1, 0}})}) {
    EXPECT_TRUE(flat_quad_deviation(patch));
    const auto plan = good(Tessellation::make(set_of({patch}), {.tolerance = 1e-4}));
    EXPECT_EQ(plan.capacity().triangles, 2u);
  }
  EXPECT_FALSE(flat_quad_deviation(slanted));  // not flat
}

TEST(FlatQuads, OthersAreNone) {
  const auto is_flat_quad = [](std::vector<Vec3> points) {
    return flat_quad_deviation(polynomial(2, 2, points)).has_value();
  };
  const std::vector<Vec3> flat{{0, 0, 0}, {0, .5, 0}, {0, 1, 0},  {1, 0, 0}, {1, .5, 0},
                               {1, 1, 0}, {2, 0, 0},  {2, .5, 0}, {2, 1, 0}};
  EXPECT_TRUE(is_flat_quad(flat));
  const auto changed = [&](std::size_t k, Vec3 to) {
    std::vector<Vec3> points = flat;
    points[k] = to;
    return points;
  };
  EXPECT_FALSE(is_flat_quad(changed(4, {1, .5, 1e-6})));  // off the plane
  EXPECT_FALSE(is_flat_quad(changed(4, {1, 1.1, 0})));    // folds over its border
  EXPECT_FALSE(is_flat_quad(changed(3, {1, 1e-6, 0})));   // a border bulges inward
  EXPECT_FALSE(is_flat_quad(changed(3, {1, -1e-6, 0})));  // or outward
  EXPECT_FALSE(is_flat_quad(changed(0, {1.5, .8, 0})));   // a corner that looks inward
  EXPECT_FALSE(is_flat_quad(std::vector<Vec3>(9, Vec3{1, 2, 3})));
}

/// Weights of extreme ratios, patches thinner than rounding, a place far away: a plan that keeps its tolerance, or an
/// error that says why not.
TEST(ExactChords, HardPatchesAreBoundedOrRefused) {
  Random random(8);
  std::size_t planned = 0;
  for (int kind = 0; kind < 300; ++kind) {
    const int m = 1 + static_cast<int>(random() % 4), n = 1 + static_cast<int>(random() % 4);
    BezierPatch patch = kind % 3 == 0 ? random_rational(random, m, n, 1e-9, 1e9)
                                      : random_sweep(random, m, n, kind % 3 == 1 ? 3e4 : 2, true);
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (Vec3& p : points) {
      if (kind % 4 == 1) p.z *= 1e-18;
      if (kind % 4 == 2) p = p + Vec3{1e12, -1e12, 1e11};
      if (kind % 4 == 3) p = 1e12 * p;
    }
    patch = rational(m, n, points, {patch.weights().begin(), patch.weights().end()});
    const Result<PatchSet> set = PatchSet::make(std::vector<BezierPatch>{patch});
    if (!set) continue;
    const double tolerance = 1e-2 * set->box().diagonal();
    const auto plan = Tessellation::make(*set, {.tolerance = tolerance, .max_triangles = 1000000});
    if (!plan) {
      EXPECT_EQ(plan.status().code(), StatusCode::invalid_argument) << plan.status().message();
      continue;
    }
    ++planned;
    EXPECT_LE(plan->bound(), tolerance * (1 + 1e-6));
  }
  EXPECT_GT(planned, 100u);
}

}}  // namespace tessera::test
