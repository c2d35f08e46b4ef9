// Fewer triangles by bounds of small pieces: still proven, and without a crack.

#include <algorithm>

#include "base/impl_access.h"
#include "support/crack_survey.h"
#include "support/edges_of_set.h"
#include "support/synthetic_sets.h"
#include "support/triangle_distance.h"
#include "support/true_distance.h"
#include "tess/bounds/derivative_nets.h"
#include "tess/bounds/local_chord.h"
#include "tess/proven_mesh_of.h"
#include "tess/tessellate_support.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

Tessellation planned(const PatchSet& set, double relative, bool fewest) {
  return good(Tessellation::make(set, {.tolerance = relative, .relative = true, .fewest = fewest}));
}

/// A bicubic patch that bends only near (1, 1).
BezierPatch bent_in_a_corner() {
  std::vector<Vec3> points;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points.push_back({i / 3.0, j / 3.0, i == 3 && j == 3 ? 1.0 : 0.0});
  return polynomial(3, 3, points);
}

TEST(Fewest, SavesTrianglesAndOpensNoCrack) {
  for (const double relative : {1e-2, 1e-3, 1e-4})
    for (const auto& patches : {closed_body(), sphere(), wavy_field(5, 6), mixed_patches(8, 8)}) {
      const PatchSet set = set_of(patches);
      const Tessellation plain = planned(set, relative, false), fewest = planned(set, relative, true);
      EXPECT_LE(fewest.capacity().triangles, plain.capacity().triangles);
      EXPECT_LE(fewest.bound(), relative * set.box().diagonal() * (1 + 1e-6));
      const MeshReport report = good(check(mesh_of(set, fewest))), before = good(check(mesh_of(set, plain)));
      EXPECT_EQ(report.t_junctions, 0u);
      EXPECT_EQ(report.closed(), before.closed());
      EXPECT_EQ(report.degenerate_triangles, before.degenerate_triangles);
    }
  // Not a sphere, whose patches are scaled sweeps: these have half as many triangles without the option.
  const PatchSet body = set_of(closed_body());
  const auto triangles = [&](bool fewest) { return double(planned(body, 1e-4, fewest).capacity().triangles); };
  EXPECT_LE(triangles(true), 0.85 * triangles(false));
}

TEST(Fewest, NeverTakesMoreTriangles) {
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const PatchSet set = set_of(mixed_patches(seed, 1 + static_cast<int>(seed % 6)));
    for (const double relative : {0.1, 0.02, 5e-3})
      EXPECT_LE(planned(set, relative, true).capacity().triangles, planned(set, relative, false).capacity().triangles)
          << seed << " " << relative;
  }
}

/// The field, with patches that run the other way along u, along v or both between the others.
std::vector<BezierPatch> turned(std::vector<BezierPatch> patches) {
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const BezierPatch& patch = patches[k];
    const int m = patch.degree_u(), n = patch.degree_v();
    std::vector<Vec3> points;
    for (int i = 0; i <= m; ++i)
      for (int j = 0; j <= n; ++j) points.push_back(patch.point(k % 2 ? m - i : i, k % 3 ? n - j : j));
    patches[k] = polynomial(m, n, points);
  }
  return patches;
}

/// Segments of borders that one patch has.
std::size_t lone_segments(const PatchSet& set, const Tessellation& plan) {
  const SharedEdges edges = edges_of_set(set);
  std::vector<std::size_t> patches(edges.count(), 0), segments(edges.count(), 0);
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges.edge(k, side);
      ++patches[edge];
      segments[edge] = proven_mesh_of(plan).plan().division(k).border[static_cast<std::size_t>(side)].rate();
    }
  std::size_t lone = 0;
  for (std::size_t edge = 0; edge < edges.count(); ++edge) lone += patches[edge] == 1 ? segments[edge] : 0;
  return lone;
}

TEST(Fewest, HalvesOfPatchesHaveSegmentsOfTheirOwnWhereThatSaves) {
  const PatchSet field = set_of(turned(wavy_field(7, 7)));
  const Tessellation plan = planned(field, 1e-4, true);
  std::size_t in_halves = 0;
  double cells = 0, if_uniform = 0;
  for (std::size_t k = 0; k < field.patch_count(); ++k) {
    const PatchSegments segments = proven_mesh_of(plan).plan().patches().segments[k];
    in_halves += !segments.are_uniform();
    cells += segments.cells();
    const Rates finest{std::max(segments.u.lower_rate(), segments.u.upper_rate()),
                       std::max(segments.v.lower_rate(), segments.v.upper_rate())};
    if_uniform += double(finest.u) * finest.v;
  }
  EXPECT_GT(in_halves, field.patch_count() / 4);
  EXPECT_LT(cells, 0.9 * if_uniform);
  const Mesh mesh = mesh_of(field, plan);
  const MeshReport report = good(check(mesh));
  EXPECT_EQ(report.t_junctions, 0u);
  EXPECT_EQ(report.open_edges, lone_segments(field, plan));
  for (std::size_t t = 0; t < mesh.triangle_count(); t += 7) {
    const std::uint32_t patch = mesh.patches[t];
    if (proven_mesh_of(plan).plan().patches().segments[patch].are_uniform()) continue;
    EXPECT_LE(largest_distance(field.patch(patch), triangle_of(mesh, t), 0.1, 60).low, plan.bounds()[patch]);
  }
}

/// Patches use the segments that suit their neighbours if these are as good for themselves.
TEST(Fewest, PatchesChooseTogether) {
  const PatchSet field = set_of(wavy_field(8, 8));
  const PatchShape shape{3, 3, {}, false};
  std::vector<PatchShape> shapes(field.patch_count(), shape);
  const SharedEdges edges = edges_of_set(field);
  const std::vector<std::uint8_t> against(4 * shapes.size(), 0);
  std::vector<SegmentChoices> choices;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const Rates one{3, 4}, other{4, 3};
    choices.emplace_back(ProvenSegments{k % 2 ? one : other, 1, true});
    choices.back().add({k % 2 ? other : one, 1, true});
    choices.back().add({Rates{8, 8}, 0.1, true});
    EXPECT_EQ(choices.back().count(), 2u);  // eights have too many cells
  }
  const std::vector<std::uint8_t> chosen = good(choose_together(shapes, edges, against, choices));
  std::size_t unlike = 0;
  for (std::size_t k = 0; k < shapes.size(); ++k)
    unlike += !(choices[k][chosen[k]].segments == choices[0][chosen[0]].segments);
  EXPECT_LE(unlike, shapes.size() / 8);  // at first half of them are
}

TEST(Fewest, ChoosingTogetherCanBeCancelled) {
  const PatchSet set = set_of(std::vector<BezierPatch>(20, bent_in_a_corner()));  // of as many as meet at an edge
  const std::vector<PatchShape> shapes(set.patch_count(), PatchShape{3, 3, {}, false});
  const SharedEdges edges = edges_of_set(set);
  const std::vector<std::uint8_t> against(4 * shapes.size(), 0);
  SegmentChoices some(ProvenSegments{Rates{3, 4}, 1, true});
  some.add({Rates{4, 3}, 1, true});
  const std::vector<SegmentChoices> choices(shapes.size(), some);
  std::atomic<bool> cancel = false;
  const auto chosen = good(choose_together(shapes, edges, against, choices, &cancel));
  EXPECT_EQ(std::count(chosen.begin(), chosen.end(), chosen.front()), 20);
  cancel = true;
  EXPECT_EQ(choose_together(shapes, edges, against, choices, &cancel).status().code(), StatusCode::cancelled);
}

TEST(Fewest, HalvesHaveNoMoreSegmentsThanWholesMay) {
  std::vector<Vec3> points;  // bends only where u is small
  for (int i = 0; i <= 6; ++i)
    for (int j = 0; j < 2; ++j) points.push_back({double(i), double(j), i == 0 ? 6.0 : 0.0});
  const PatchSet set = set_of({polynomial(6, 1, points)});
  const Tessellation plan = good(Tessellation::make(set, {.tolerance = 5.5e-6, .fewest = true}));
  const Segments along = proven_mesh_of(plan).plan().division(0).border[0];
  EXPECT_FALSE(along.is_uniform());
  EXPECT_GT(along.lower_rate(), 1500);
  EXPECT_LE(along.lower_rate(), max_rate);
  const MeshReport report = good(check(mesh_of(set, plan)));
  EXPECT_EQ(report.open_edges, 2u * along.rate() + 2u * proven_mesh_of(plan).plan().division(0).border[1].rate());
}

/// The middles of triangles: where rates are wrong bounds are exceeded many times over.
TEST(Fewest, BoundsHoldOfEveryKindOfPatch) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const PatchSet set = set_of(mixed_patches(seed, 12));
    const Tessellation plan = planned(set, 1e-4, true);
    const Mesh mesh = mesh_of(set, plan);
    std::size_t exceeded = 0;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const MeshTriangle triangle = triangle_of(mesh, t);
      const auto middle = [&](std::size_t c) {
        return (triangle.parameters[0][c] + triangle.parameters[1][c] + triangle.parameters[2][c]) / 3;
      };
      const Vec3 p = de_casteljau(set.patch(mesh.patches[t]), middle(0), middle(1));
      const auto& at = triangle.corners;
      exceeded += !(distance_to_triangle(p, at[0], at[1], at[2]) <= plan.bounds()[mesh.patches[t]]);
    }
    EXPECT_EQ(exceeded, 0u) << seed;
    for (const PatchSegments& segments : proven_mesh_of(plan).plan().patches().segments)
      EXPECT_LE(std::max(segments.u.rate(), segments.v.rate()), max_rate) << seed;
  }
}

TEST(Fewest, RatesGoNoFurtherThanTheirRange) {
  std::vector<Vec3> points;  // waves along v, hardly bent along u
  for (int i = 0; i <= 2; ++i)
    for (int j = 0; j <= 15; ++j)
      points.push_back({i * 0.01, j * 0.001, (j % 2 ? 1.0 : -1.0) + (i == 1 ? 3.593e-3 : 0)});
  const PatchSet set = set_of({polynomial(2, 15, points)});
  for (const bool share : {false, true}) {
    const Tessellation plan =
        good(Tessellation::make(set, {.tolerance = 1.478e-5, .joining = {.share_vertices = share}, .fewest = true}));
    const PatchSegments segments = proven_mesh_of(plan).plan().patches().segments[0];
    EXPECT_GT(segments.v.rate(), 2000);
    EXPECT_LE(segments.v.rate(), max_rate);
    EXPECT_EQ(good(check(mesh_of(set, plan))).t_junctions, 0u);
  }
}

/// A curve that is the border of a patch, and would be welded to other borders if it were a border.
TEST(Fewest, CurvesBesideWeldedBordersOpenNoCrack) {
  const auto net = [](int degree, auto at) {
    std::vector<Vec3> points;
    for (int i = 0; i <= degree; ++i)
      for (int j = 0; j <= 3; ++j) points.push_back(at(i, j));
    return polynomial(degree, 3, points);
  };
  const auto border = [](int j, double beside) { return Vec3{beside * j, j / 3.0, j == 3 ? 0.8 : 0.0}; };
  const BezierPatch curve = net(3, [&](int, int j) { return border(j, 1e-6); }),
                    below = net(3,
                                [&](int i, int j) {
                                  return border(j, 1e-6) - Vec3{0, 0, i / 3.0};
                                }),
                    right = net(2,
                                [&](int i, int j) {
                                  return border(j, 0) + Vec3{i / 2.0, 0, 0.05 * i * i * (j % 2)};
                                }),
                    left = net(2, [&](int i, int j) {
                      return border(3 - j, 0) - Vec3{i / 2.0, 0, 0.03 * i * i};
                    });
  const PatchSet set = set_of({curve, below, right, left});
  const Tessellation plan =
      good(Tessellation::make(set, {.tolerance = 1e-3, .joining = {.weld = 1e-4}, .fewest = true}));
  EXPECT_GT(plan.welded_borders(), 0u);
  EXPECT_FALSE(proven_mesh_of(plan).plan().division(2).border[3].is_uniform());
  CrackCount cracks;
  count_edges(mesh_of(set, plan), MeetingBorders(set, {1e-4}), cracks);
  EXPECT_EQ(cracks.cracks, 0u);
}

TEST(Fewest, KeepsAnglesAndPixelsAsWell) {
  const PatchSet set = set_of(wavy_field(4, 4));
  const View view{.eye = {2, -6, 5}, .target = {2, 2, 0}};
  TessellationOptions options{.tolerance = 1e-3, .angle = 0.2, .pixels = PixelTolerance{2, view}};
  const Tessellation plain = good(Tessellation::make(set, options));
  options.fewest = true;
  const Tessellation fewest = good(Tessellation::make(set, options));
  EXPECT_LT(fewest.capacity().triangles, plain.capacity().triangles);
  EXPECT_LE(fewest.bound(), 1e-3 * (1 + 1e-6));
  EXPECT_LE(fewest.angle(), 0.2 * (1 + 1e-6));
  EXPECT_LE(fewest.pixels(), 2 * (1 + 1e-6));
  EXPECT_EQ(good(check(mesh_of(set, fewest))).t_junctions, 0u);
}

/// Boxes anywhere, whatever the rates: not only cells of a grid.
TEST(Fewest, LocalBoundsHoldWhereverTrianglesLie) {
  Random random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const BezierPatch& patch : {bent_in_a_corner(), random_polynomial(random, 3, 5), random_polynomial(random, 1, 2),
                                   random_rational(random, 3, 3, 0.5, 2), random_polynomial(random, 8, 6)})
    for (const Rates rates : {Rates{2, 3}, Rates{5, 4}, Rates{12, 9}}) {
      const LocalChord local(DerivativeNets(patch), Domain{0, 1, 0, 1}, rates, rates, LocalChord::max_pieces);
      const double bound = local.distance(rates);
      EXPECT_TRUE(local.keeps(rates, bound));
      EXPECT_FALSE(local.keeps(rates, 0.99 * bound));
      for (int sample = 0; sample < 40; ++sample) {
        const double u = unit(random) * (1 - 1.0 / rates.u), v = unit(random) * (1 - 1.0 / rates.v);
        MeshTriangle triangle;
        for (std::size_t c = 0; c < 3; ++c) {
          triangle.parameters[c] = {u + (c == 1   ? 1.0
                                         : c == 2 ? unit(random)
                                                  : 0.0) /
                                            rates.u,
                                    v + (c == 2   ? 1.0
                                         : c == 1 ? unit(random)
                                                  : 0.0) /
                                            rates.v};
          triangle.corners[c] = de_casteljau(patch, triangle.parameters[c][0], triangle.parameters[c][1]);
        }
        EXPECT_LE(largest_distance(patch, triangle, 0.1, 60).low, bound * (1 + 1e-9));
      }
    }
}

TEST(Fewest, UpdatesStateTheirBoundsTheSameWay) {
  PatchSet set = set_of(wavy_field(6, 6));
  Tessellation plan = planned(set, 3e-4, true);
  Mesh mesh = mesh_of(set, plan);
  std::vector<std::uint32_t> patches;
  std::vector<Vec3> points;
  for (std::uint32_t k = 0; k < set.patch_count(); ++k) {
    patches.push_back(k);
    for (const Vec3& p : set.patch(k).points()) points.push_back(p + Vec3{0.25, 0.5, -0.25});
  }
  EXPECT_FALSE(good(plan.update(set, {patches, points}, mesh.views())).topology);  // moved alone
  EXPECT_LE(plan.bound(), plan.tolerance() * (1 + 1e-6));
  for (Vec3& p : points) p.z *= 4;
  EXPECT_TRUE(good(plan.update(set, {patches, points}, mesh.views())).topology);
  EXPECT_LE(plan.bound(), plan.tolerance() * (1 + 1e-6));
}

}}  // namespace tessera::test
