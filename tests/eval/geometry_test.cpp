// Local geometry in batches: surfaces with curvatures in closed form, points without curvature, and every output path
// of the kernels.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/impl_access.h"
#include "eval/grid_plan_impl.h"
#include "support/grids.h"
#include "support/ulp.h"
#include "tessera/convert.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

PatchSetOptions both_precisions() {
  PatchSetOptions options;
  options.blocks.double_bernstein = true;
  return options;
}

/// A set over a grid with every output evaluated.
template <class T>
struct Evaluated {
  PatchSet set;
  GridPlan plan;
  AllBuffers<T> memory;
  QuantityViews<T> out;

  Evaluated(const std::vector<BezierPatch>& patches, const std::vector<double>& t, Isa isa)
      : set(set_of(patches, both_precisions())),
        plan(value_of(GridPlan::make(set, t, t, {.precision = precision_of<T>, .isa = isa}))),
        memory(plan),
        out(memory.views()) {
    const Status status = evaluate(set, plan, out);
    EXPECT_TRUE(status.ok()) << status.message();
  }
  std::size_t count() const { return plan.capacity(); }
  /// The reference at a record.
  LocalGeometry reference(std::size_t record) const {
    const std::size_t samples = plan.count_u() * plan.count_v();
    const auto [u, v] = parameters(record);
    return local_geometry(set.patch(record / samples), u, v);
  }
  std::pair<double, double> parameters(std::size_t record) const {
    const auto& inner = impl_of(plan);
    return {inner.u[record / inner.v.size() % inner.u.size()], inner.v[record % inner.v.size()]};
  }
  Vec3 position(std::size_t record) const {
    return sizeof(T) == 4 ? read(out.position, record) + set.origin() : read(out.position, record);
  }
  void expect_undefined(std::size_t record) const {
    EXPECT_EQ(out.curvature_kind.at(record, 0), CurvatureKind::undefined);
    for (const auto* view : {&out.gaussian, &out.mean, &out.first_curvature, &out.second_curvature})
      EXPECT_EQ(view->at(record, 0), 0);
    for (const auto* view : {&out.first_form, &out.second_form, &out.first_direction, &out.second_direction})
      EXPECT_EQ(read(*view, record), Vec3{});
  }
};

std::vector<BezierPatch> curved_patches(const Result<BSplineSurface>& surface) {
  const PatchGrid grid = value_of(to_bezier(value_of(surface)));
  return {grid.patches().begin(), grid.patches().end()};
}

class Geometry : public ::testing::TestWithParam<Isa> {
 protected:
  const std::vector<double> t{0, 0.125, 0.3, 0.5, 0.8, 1};

  template <class T>
  void check_sphere();
  template <class T>
  void check_torus();
  template <class T>
  void check_poles();
};

template <class T>
constexpr double tolerance = sizeof(T) == 4 ? 2e-4 : 1e-12;

/// Umbilic, with constant curvatures, except at the poles, which have only a limit normal.
template <class T>
void Geometry::check_sphere() {
  const double radius = 2.5;
  const Evaluated<T> ball(curved_patches(make_nurbs_sphere({.origin = {1, -2, 3}}, radius)), t, GetParam());
  std::size_t poles = 0;
  for (std::size_t k = 0; k < ball.count(); ++k) {
    const Vec3 outwards = normalized(ball.position(k) - Vec3{1, -2, 3});
    EXPECT_LT(max_abs(read(ball.out.normal, k) - outwards), tolerance<T>);
    if (std::abs(outwards.z) > 1 - 1e-9) {
      ++poles;
      EXPECT_EQ(ball.out.normal_kind.at(k, 0), NormalKind::limit);
      ball.expect_undefined(k);
      continue;
    }
    EXPECT_EQ(ball.out.normal_kind.at(k, 0), NormalKind::regular);
    EXPECT_NEAR(ball.out.gaussian.at(k, 0), 1 / (radius * radius), tolerance<T>);
    EXPECT_NEAR(ball.out.mean.at(k, 0), -1 / radius, tolerance<T>);
    EXPECT_NEAR(ball.out.first_curvature.at(k, 0), -1 / radius, tolerance<T>);
    EXPECT_NEAR(ball.out.second_curvature.at(k, 0), -1 / radius, tolerance<T>);
    const Vec3 first = read(ball.out.first_direction, k), second = read(ball.out.second_direction, k);
    EXPECT_LT(max_abs(cross(first, second) - outwards), tolerance<T>);
  }
  EXPECT_EQ(poles, 8 * t.size());
}
TEST_P(Geometry, SphereFloat) { check_sphere<float>(); }
TEST_P(Geometry, SphereDouble) { check_sphere<double>(); }

/// Umbilics are flagged within the tolerance of the options.
TEST_P(Geometry, SphereIsUmbilicWithinTolerance) {
  const auto patches = curved_patches(make_nurbs_sphere({}, 1));
  const PatchSet set = set_of(patches, both_precisions());
  const std::vector<double> inner{0.1, 0.5, 0.75};
  for (const auto precision : {Precision::single_precision, Precision::double_precision}) {
    const bool single = precision == Precision::single_precision;
    const GridPlan plan = value_of(GridPlan::make(
        set, inner, inner,
        {.precision = precision, .isa = GetParam(), .geometry = {.umbilic_tolerance = single ? 1e-3 : 1e-9}}));
    std::vector<CurvatureKind> kinds(plan.capacity());
    const auto view = View1<CurvatureKind>::interleaved(kinds);
    ASSERT_TRUE((single ? evaluate(set, plan, QuantityViews<float>{.curvature_kind = view})
                        : evaluate(set, plan, QuantityViews<double>{.curvature_kind = view}))
                    .ok());
    for (const CurvatureKind kind : kinds) EXPECT_EQ(kind, CurvatureKind::umbilic);
  }
}

/// k2 = -1 / minor around the tube, k1 = -cos / (major + minor cos) around the ring.
template <class T>
void Geometry::check_torus() {
  const Evaluated<T> ring(curved_patches(make_nurbs_torus({}, 3, 1)), t, GetParam());
  for (std::size_t k = 0; k < ring.count(); ++k) {
    const Vec3 p = ring.position(k);
    const double across = std::hypot(p.x, p.y), cosine = across - 3, around = -cosine / across;
    EXPECT_EQ(ring.out.curvature_kind.at(k, 0), CurvatureKind::distinct);
    EXPECT_NEAR(ring.out.first_curvature.at(k, 0), around, 10 * tolerance<T>);
    EXPECT_NEAR(ring.out.second_curvature.at(k, 0), -1, 10 * tolerance<T>);
    EXPECT_NEAR(ring.out.gaussian.at(k, 0), -around, 10 * tolerance<T>);
    EXPECT_NEAR(ring.out.mean.at(k, 0), 0.5 * (around - 1), 10 * tolerance<T>);
    const Vec3 along_ring = normalized(Vec3{-p.y, p.x, 0});
    EXPECT_NEAR(std::abs(dot(read(ring.out.first_direction, k), along_ring)), 1, 10 * tolerance<T>);
    EXPECT_NEAR(dot(read(ring.out.second_direction, k), along_ring), 0, 10 * tolerance<T>);
  }
}
TEST_P(Geometry, TorusFloat) { check_torus<float>(); }
TEST_P(Geometry, TorusDouble) { check_torus<double>(); }

TEST_P(Geometry, CylinderSaddleAndPlane) {
  const Evaluated<double> pipe(curved_patches(make_nurbs_cylinder({}, 2, 5)), t, GetParam());
  for (std::size_t k = 0; k < pipe.count(); ++k) {
    EXPECT_NEAR(pipe.out.first_curvature.at(k, 0), 0, 1e-13);
    EXPECT_NEAR(pipe.out.second_curvature.at(k, 0), -0.5, 1e-13);
    EXPECT_LT(max_abs(cross(read(pipe.out.first_direction, k), Vec3{0, 0, 1})), 1e-13);
  }
  // (u, v, uv): K = -1 / (1 + u^2 + v^2)^2, H = -uv / (1 + u^2 + v^2)^(3/2); and its plane.
  const Evaluated<double> saddle({polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}}),
                                  polynomial(1, 1, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}})},
                                 t, GetParam());
  for (std::size_t k = 0; k < saddle.count() / 2; ++k) {
    const auto [u, v] = saddle.parameters(k);
    const double s = 1 + u * u + v * v;
    EXPECT_NEAR(saddle.out.gaussian.at(k, 0), -1 / (s * s), 1e-14);
    EXPECT_NEAR(saddle.out.mean.at(k, 0), -u * v / (s * std::sqrt(s)), 1e-14);
    EXPECT_LT(max_abs(read(saddle.out.first_form, k) - Vec3{1 + v * v, u * v, 1 + u * u}), 1e-14);
    EXPECT_LT(max_abs(read(saddle.out.second_form, k) - Vec3{0, 1 / std::sqrt(s), 0}), 1e-14);
    const std::size_t flat = saddle.count() / 2 + k;
    EXPECT_EQ(saddle.out.curvature_kind.at(flat, 0), CurvatureKind::umbilic);
    EXPECT_EQ(saddle.out.gaussian.at(flat, 0), 0);
    EXPECT_EQ(read(saddle.out.first_direction, flat), (Vec3{1, 0, 0}));
    EXPECT_EQ(read(saddle.out.second_direction, flat), (Vec3{0, 1, 0}));
  }
}

/// Curvatures whose difference is subnormal: 1 over it is infinite, and directions by it would be NaN.
TEST_P(Geometry, SubnormalDifferencesCountAsNone) {
  for (const double height : {1e-39, 1e-41, 1e-44, 1e-308, 1e-310, 5e-324}) {
    std::vector<Vec3> points;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) points.push_back({i / 3.0, j / 3.0, i == 1 && j == 2 ? height : 0});
    const auto expect_numbers = [&](const auto& evaluated) {
      for (std::size_t k = 0; k < evaluated.count(); ++k) {
        EXPECT_NEAR(length(read(evaluated.out.first_direction, k)), 1, 1e-6) << height;
        EXPECT_NEAR(length(read(evaluated.out.second_direction, k)), 1, 1e-6) << height;
      }
    };
    expect_numbers(Evaluated<float>({polynomial(3, 3, points)}, t, GetParam()));
    expect_numbers(Evaluated<double>({polynomial(3, 3, points)}, t, GetParam()));
  }
}

/// Patches with degenerate points of many sorts.
std::vector<BezierPatch> degenerate_patches() {
  Random random(95);
  std::vector<BezierPatch> patches = curved_patches(make_nurbs_sphere({}, 2));
  const auto collapse = [&](const BezierPatch& patch, double shift) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    for (int j = 1; j <= patch.degree_v(); ++j)
      points[static_cast<std::size_t>(j)] = points[0] + Vec3{shift * j, -shift * j * j, shift};
    return patch.is_rational()
               ? rational(patch.degree_u(), patch.degree_v(), points, {patch.weights().begin(), patch.weights().end()})
               : polynomial(patch.degree_u(), patch.degree_v(), points);
  };
  for (const int degree : {1, 2, 3, 4, 8, 14})
    for (int way = 0; way < 8; ++way) {
      patches.push_back(reoriented(collapse(random_polynomial(random, degree + 1, degree), 0), way));
      patches.push_back(reoriented(collapse(random_rational(random, degree, degree + 1), 0), way));
      patches.push_back(reoriented(collapse(random_polynomial(random, 3, 2), 1e-9), way));  // nearly collapsed
    }
  const Vec3 o{}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  patches.push_back(polynomial(1, 1, {o, o, o, o}));                // a point
  patches.push_back(polynomial(1, 1, {o, x, o, x}));                // a line, by v alone
  patches.push_back(polynomial(1, 1, {o, x, 2 * x, 5 * x}));        // a line, by u and v
  patches.push_back(polynomial(1, 1, {o, o, o, x}));                // two edges, at one corner
  patches.push_back(polynomial(2, 1, {o, y, x, x + y, x, x + y}));  // r_u = 0 at u = 1, not collapsed
  patches.push_back(polynomial(
      2, 2, {o, x, 2 * x + z, x, x + y, x + 2 * y, 2 * x + z, 2 * x + y, 2 * x + 2 * y}));  // parallel at a corner
  patches.push_back(polynomial(2, 1, {o, z, x, x + z, o, z}));  // folded: r_u = 0 at u = 1/2
  return patches;
}

/// Kinds and normals equal those of unit_normal(), in either precision, layout and on every instruction set.
template <class T>
void Geometry::check_poles() {
  const Evaluated<T> all(degenerate_patches(), t, GetParam());
  std::size_t limits = 0, undefined = 0;
  for (std::size_t k = 0; k < all.count(); ++k) {
    const auto [u, v] = all.parameters(k);
    const BezierPatch& patch = all.set.patch(k / (t.size() * t.size()));
    const UnitNormal expected = unit_normal(patch, u, v);
    SCOPED_TRACE(testing::Message() << "patch " << k / (t.size() * t.size()) << " at " << u << ", " << v);
    EXPECT_EQ(all.out.normal_kind.at(k, 0), expected.kind);
    const SurfaceJet jet = evaluate_jet(patch, u, v);
    // The deciding tangents; if one vanishes, r_uv.
    const bool along_v = length(jet.du) < length(jet.dv);
    const Vec3 a = expected.kind == NormalKind::limit && along_v ? jet.duv : jet.du;
    const Vec3 b = expected.kind == NormalKind::limit && !along_v ? jet.duv : jet.dv;
    const double height = length(cross(a, b)) / std::max(length(a), length(b));
    const double degree = std::max(patch.degree_u(), patch.degree_v());
    const double unit = std::numeric_limits<T>::epsilon(),
                 noise = degree * unit * largest_coefficient(patch, all.set.origin());
    const double weights = patch.is_rational() ? 64 : 1;  // from 1/4 to 4, and twice
    const double bound = expected.kind == NormalKind::undefined ? 0 : 8 * degree * noise * weights / height + 4 * unit;
    EXPECT_TRUE(within_units(read(all.out.normal, k), expected.direction, 1, bound));
    limits += expected.kind == NormalKind::limit;
    undefined += expected.kind == NormalKind::undefined;
    // Curvatures are never computed from tangents that are rounding errors.
    if (expected.kind != NormalKind::regular || !(height > noise)) all.expect_undefined(k);
  }
  EXPECT_GT(limits, 200u);
  EXPECT_GT(undefined, 80u);
}
TEST_P(Geometry, DegeneratePointsFloat) { check_poles<float>(); }
TEST_P(Geometry, DegeneratePointsDouble) { check_poles<double>(); }

/// An edit that collapses an edge, or opens it, takes effect at once.
TEST_P(Geometry, EditsMoveTheLimits) {
  const Vec3 pole{0, 0, 1};
  const std::vector<Vec3> closed{pole, pole, {1, 0, 0}, {0, 1, 0}}, open{pole, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}};
  PatchSet set = set_of({polynomial(1, 1, open)});
  const GridPlan plan = value_of(GridPlan::make(set, t, t, {.isa = GetParam()}));
  std::vector<NormalKind> kinds(plan.capacity());
  const QuantityViews<float> out{.normal_kind = View1<NormalKind>::interleaved(kinds)};
  for (const bool collapse : {false, true, false}) {
    ASSERT_TRUE(set.set_control_points(0, collapse ? closed : open).ok());
    ASSERT_TRUE(evaluate(set, plan, out).ok());
    for (std::size_t k = 0; k < t.size(); ++k) EXPECT_EQ(kinds[k], collapse ? NormalKind::limit : NormalKind::regular);
  }
}

/// A block's output holds the values of the views of `all`.
template <class T, class Output>
void expect_in_blocks(const Evaluated<T>& all, const Output& output, const AlignedVector<T>& blocks) {
  SCOPED_TRACE(output.name);
  const std::size_t width = static_cast<std::size_t>(output.width);
  for (std::size_t record = 0; record < all.count(); ++record)
    for (std::size_t c = 0; c < width; ++c) {
      const PatchSet::Slot slot = all.set.slot(record / 9);
      const T found = blocks[((slot.block * 9 + record % 9) * width + c) * PatchSet::lanes + slot.lane];
      ASSERT_EQ(found, output.of(all.out).at(record, static_cast<int>(c)));
    }
}

/// Blocks hold the values of views; each output alone equals the one with all others, also in one interleaved record.
template <class T>
void check_ways_out(Isa isa) {
  Random random(96);
  std::vector<BezierPatch> patches = mixed_patches(random, 4);
  for (const BezierPatch& patch : degenerate_patches()) patches.push_back(patch);
  const Evaluated<T> all(patches, {0, 0.4, 1}, isa);
  for (const Stores stores : {Stores::plain, Stores::streaming}) {
    Execution execution;
    execution.stores = stores;
    std::map<std::string, AlignedVector<T>> blocks;
    QuantityBlocks<T> together;
    for_each_value_quantity([&](const auto& output) {
      AlignedVector<T>& memory = blocks[output.name];
      memory.resize(all.plan.block_capacity() / 3 * static_cast<std::size_t>(output.width));
      QuantityBlocks<T> alone;
      output.of(alone) = memory;
      ASSERT_TRUE(evaluate(all.set, all.plan, alone, execution).ok());
      expect_in_blocks(all, output, memory);
      std::fill(memory.begin(), memory.end(), T{0});
      output.of(together) = memory;
    });
    ASSERT_TRUE(evaluate(all.set, all.plan, together, execution).ok());
    for_each_value_quantity([&](const auto& output) { expect_in_blocks(all, output, blocks[output.name]); });
  }
  std::vector<T> records(37 * all.count());
  QuantityViews<T> out;
  std::size_t first = 0;
  for_each_value_quantity([&](const auto& output) {
    auto& view = output.of(out);
    view = std::remove_reference_t<decltype(view)>::interleaved(records, 37, first);
    first += static_cast<std::size_t>(output.width);
  });
  ASSERT_EQ(first, 37u);
  ASSERT_TRUE(evaluate(all.set, all.plan, out).ok());
  for_each_value_quantity([&](const auto& output) {
    for (std::size_t record = 0; record < all.count(); ++record)
      for (int c = 0; c < output.width; ++c)
        ASSERT_EQ(output.of(out).at(record, c), output.of(all.out).at(record, c)) << output.name;
  });
}
TEST_P(Geometry, EveryWayOutFloat) { check_ways_out<float>(GetParam()); }
TEST_P(Geometry, EveryWayOutDouble) { check_ways_out<double>(GetParam()); }

/// Kinds in blocks, and with a stride in views.
TEST_P(Geometry, KindsInEveryLayout) {
  const Evaluated<float> all(degenerate_patches(), t, GetParam());
  const std::size_t samples = t.size() * t.size(), lanes = PatchSet::lanes;
  AlignedVector<NormalKind> normals(all.plan.block_capacity() / 3);
  AlignedVector<CurvatureKind> curvatures(normals.size());
  ASSERT_TRUE(
      evaluate(all.set, all.plan, QuantityBlocks<float>{.normal_kind = normals, .curvature_kind = curvatures}).ok());
  std::vector<NormalKind> strided(3 * all.count(), NormalKind{7});
  ASSERT_TRUE(
      evaluate(all.set, all.plan, QuantityViews<float>{.normal_kind = View1<NormalKind>::interleaved(strided, 3, 1)})
          .ok());
  for (std::size_t record = 0; record < all.count(); ++record) {
    const PatchSet::Slot slot = all.set.slot(record / samples);
    const std::size_t at = (slot.block * samples + record % samples) * lanes + slot.lane;
    EXPECT_EQ(normals[at], all.out.normal_kind.at(record, 0));
    EXPECT_EQ(curvatures[at], all.out.curvature_kind.at(record, 0));
    EXPECT_EQ(strided[3 * record + 1], all.out.normal_kind.at(record, 0));
    EXPECT_EQ(strided[3 * record], NormalKind{7});
  }
}

INSTANTIATE_TEST_SUITE_P(EveryIsa, Geometry, ::testing::ValuesIn(available_isas().begin(), available_isas().end()),
                         [](const auto& param) { return std::string(name(param.param)); });

}}  // namespace tessera::test
