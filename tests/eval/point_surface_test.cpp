// Compares points by the parameters of B-spline surfaces with the definition.

#include <gtest/gtest.h>

#include "support/points.h"
#include "support/random_splines.h"
#include "support/ulp.h"
#include "tessera/convert.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

/// Surfaces of several degrees, polynomial and rational, with single and multiple knots, as one set.
struct Surfaces {
  std::vector<BSplineSurface> surfaces;
  std::vector<PatchGrid> grids;

  explicit Surfaces(Random& random) {
    for (int k = 0; k < 6; ++k) {
      const KnotStyle u{.inner = 2 + 7 * k, .clamped = k % 2 == 0, .multiple = k == 4}, v{.inner = 1 + k};
      surfaces.push_back(random_surface(random, 1 + k % 4, 1 + (k + 1) % 3, u, v, k % 3 == 2));
      grids.push_back(value_of(to_bezier(surfaces.back())));
    }
  }
  PatchSet set() const { return value_of(make_patch_set(grids, with_points())); }
};

struct Places {
  std::vector<std::uint32_t> surface;
  std::vector<double> u, v;
  SurfaceSamples views() const {
    return {View1<const std::uint32_t>::interleaved(surface), View1<const double>::interleaved(u),
            View1<const double>::interleaved(v)};
  }
};

/// Knots, ends and places between, surface after surface and then in random order.
Places own_places(Random& random, const std::vector<BSplineSurface>& surfaces) {
  Places places;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const Domain& d = surfaces[k].domain();
    for (const double u : sample_parameters(random, surfaces[k].knots_u(), d.u0, d.u1, 20))
      for (const double v : sample_parameters(random, surfaces[k].knots_v(), d.v0, d.v1, 7)) {
        places.surface.push_back(static_cast<std::uint32_t>(k));
        places.u.push_back(u);
        places.v.push_back(v);
      }
  }
  for (const std::size_t k : shuffled_order(random, places.u.size())) {
    places.surface.push_back(places.surface[k]);
    places.u.push_back(places.u[k]);
    places.v.push_back(places.v[k]);
  }
  return places;
}

TEST(PointsOfSurfaces, AreThoseOfTheDefinition) {
  Random random(341);
  const Surfaces all(random);
  const PatchSet set = all.set();
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  ASSERT_EQ(map.surface_count(), 6u);
  const Places places = own_places(random, all.surfaces);
  for (const Isa isa : available_isas()) {
    AllBuffers<double> twice(places.u.size());
    AllBuffers<float> single(places.u.size());
    ASSERT_TRUE(evaluate(set, map, places.views(), twice.views(), {.isa = isa}).ok());
    ASSERT_TRUE(evaluate(set, map, places.views(), single.views(), {.isa = isa}).ok());
    const QuantityViews<double> out = twice.views();
    for (std::size_t k = 0; k < places.u.size(); ++k) {
      const BSplineSurface& surface = all.surfaces[places.surface[k]];
      const RealJet jet = reference_jet(surface, places.u[k], places.v[k]);
      const double near = 1e-12;
      EXPECT_TRUE(within_units(read(out.position, k), jet.position.rounded(), near, 1)) << k;
      EXPECT_TRUE(within_units(read(single.views().position, k) + set.origin(), jet.position.rounded(), 4e-6, 1)) << k;
      EXPECT_TRUE(within_units(read(out.du, k), jet.du.rounded(), near, 100)) << k;
      EXPECT_TRUE(within_units(read(out.dv, k), jet.dv.rounded(), near, 100)) << k;
      EXPECT_TRUE(within_units(read(out.duu, k), jet.duu.rounded(), near, 10000)) << k;
      EXPECT_TRUE(within_units(read(out.duv, k), jet.duv.rounded(), near, 10000)) << k;
      EXPECT_TRUE(within_units(read(out.dvv, k), jet.dvv.rounded(), near, 10000)) << k;
      if (out.curvature_kind.at(k, 0) == CurvatureKind::undefined) continue;
      const RealGeometry g = reference_geometry(jet);
      const Vec3 du = jet.du.rounded(), dv = jet.dv.rounded();
      if (length(cross(du, dv)) < 0.05 * length(du) * length(dv)) continue;
      EXPECT_TRUE(within_units(read(out.normal, k), g.normal.rounded(), near, 1000)) << k;
      EXPECT_TRUE(within_units(read(out.first_form, k), g.first_form.rounded(), near, 10000)) << k;
      EXPECT_TRUE(within_units(read(out.second_form, k), g.second_form.rounded(), near, 1e5)) << k;
    }
  }
}

/// A breakpoint belongs to the patch on its right, the end to the last one; ends are exact.
TEST(PointsOfSurfaces, BreakpointsBelongToTheRight) {
  const std::vector<double> knots{0, 0, 1, 2.5, 7, 7};
  const std::vector<Vec3> points{{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1},
                                 {2, 0, 0}, {2, 1, 0}, {3, 0, 5}, {3, 1, 5}};
  const std::vector<double> line{0, 0, 1, 1};
  const BSplineSurface surface = value_of(BSplineSurface::polynomial(1, knots, 1, line, points));
  const PatchSet set = value_of(make_patch_set(value_of(to_bezier(surface)), with_points()));
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  EXPECT_EQ(value_of(SurfaceMap::make(set)).domain(0), surface.domain());
  const std::vector<double> u{0, 1, 2.5, 7}, v(4, 0.25);
  AllBuffers<double> out(4);
  const SurfaceSamples samples{.u = View1<const double>::interleaved(u), .v = View1<const double>::interleaved(v)};
  ASSERT_TRUE(evaluate(set, map, samples, out.views()).ok());
  const double slopes[] = {1, -1 / 1.5, 5 / 4.5, 5 / 4.5};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(read(out.views().position, k), points[2 * k] + Vec3(0, 0.25, 0));
    EXPECT_NEAR(out.views().du.at(k, 2), slopes[k], 1e-15);
  }
}

/// Thousands of spans of very different widths: each parameter finds its own.
TEST(PointsOfSurfaces, ManySpans) {
  Random random(342);
  for (const int inner : {0, 1, 2, 14, 15, 16, 900}) {
    const BSplineSurface surface = random_surface(random, 2, 1, {.inner = inner}, {.inner = 0}, false);
    const PatchSet set = value_of(make_patch_set(value_of(to_bezier(surface)), with_points()));
    const SurfaceMap map = value_of(SurfaceMap::make(set));
    const Domain& d = surface.domain();
    const std::vector<double> u = sample_parameters(random, surface.knots_u(), d.u0, d.u1, 3000), v(u.size(), d.v0);
    AllBuffers<double> out(u.size());
    const SurfaceSamples samples{.u = View1<const double>::interleaved(u), .v = View1<const double>::interleaved(v)};
    for (const Isa isa : available_isas()) {
      ASSERT_TRUE(evaluate(set, map, samples, out.views(), {.isa = isa}).ok());
      for (std::size_t k = 0; k < u.size(); ++k)
        ASSERT_LT(max_abs(read(out.views().position, k) - evaluate_jet(surface, u[k], v[k]).position), 1e-13);
    }
  }
}

TEST(PointsOfSurfaces, OutsideOfTheDomain) {
  Random random(343);
  const BSplineSurface surface = random_surface(random, 3, 2, {}, {}, false);
  const PatchSet set = value_of(make_patch_set(value_of(to_bezier(surface)), with_points()));
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  const Domain& d = surface.domain();
  const std::vector<double> u{d.u0, d.u0 - 0.125, d.u1 + 0.25, d.u1}, v{d.v1, d.v1, d.v0 - 0.5, d.v0};
  const SurfaceSamples samples{.u = View1<const double>::interleaved(u), .v = View1<const double>::interleaved(v)};
  AllBuffers<double> out(4), before(4);
  const Status status = evaluate(set, map, samples, out.views());
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(status.index(), 1);
  EXPECT_TRUE(out == before);
  for (const OutsideDomain outside : {OutsideDomain::clamp, OutsideDomain::extrapolate}) {
    ASSERT_TRUE(evaluate(set, map, samples, out.views(), {.outside = outside}).ok());
    for (std::size_t k = 0; k < 4; ++k) {
      const bool clamped = outside == OutsideDomain::clamp;
      const SurfaceJet jet = evaluate_jet(surface, clamped ? std::clamp(u[k], d.u0, d.u1) : u[k],
                                          clamped ? std::clamp(v[k], d.v0, d.v1) : v[k]);
      EXPECT_LT(max_abs(read(out.views().position, k) - jet.position), 1e-11);
      EXPECT_LT(max_abs(read(out.views().du, k) - jet.du), 1e-10);
    }
  }
}

TEST(PointsOfSurfaces, BadInput) {
  Random random(344);
  const Surfaces all(random);
  const PatchSet set = all.set();
  const SurfaceMap map = value_of(SurfaceMap::make(set));
  Places places = own_places(random, all.surfaces);
  AllBuffers<float> out(places.u.size());
  places.surface[77] = 6;
  Status status = evaluate(set, map, places.views(), out.views());
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(status.index(), 77);
  places.surface[77] = 0;
  places.u[5] = std::nan("");
  status = evaluate(set, map, places.views(), out.views(), {.outside = OutsideDomain::extrapolate});
  EXPECT_EQ(status.code(), StatusCode::non_finite);
  EXPECT_EQ(status.index(), 5);
  const PatchSet other = value_of(make_patch_set(all.grids[0], with_points()));
  EXPECT_EQ(evaluate(other, map, places.views(), out.views()).code(), StatusCode::stale);
  // Patches that do not form a grid.
  const std::vector<BezierPatch> patches(3, random_polynomial(random, 1, 1));
  const std::vector<PatchSource> sources{{0, {0, 1, 0, 1}}, {0, {0, 1, 1, 2}}, {0, {1, 2, 0, 1}}};
  PatchSetOptions with_sources = with_points();
  with_sources.sources = sources;
  const PatchSet holes = value_of(PatchSet::make(patches, with_sources));
  EXPECT_EQ(SurfaceMap::make(holes).status().code(), StatusCode::unsupported);
  EXPECT_EQ(SurfaceMap::make(holes).status().index(), 0);
}

}}  // namespace tessera::test
