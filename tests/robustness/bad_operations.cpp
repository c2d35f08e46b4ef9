// Operations on patches and splines, conversions, joins; sets and models.

#include <vector>

#include "robustness/bad_input.h"
#include "support/random_splines.h"
#include "tessera/bezier_operations.h"
#include "tessera/convert.h"
#include "tessera/local_geometry.h"
#include "tessera/model.h"
#include "tessera/patch_set.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Numbers = std::vector<double>;

void patch_operations(Table& table, const BezierPatch& patch, const BezierPatch& rational) {
  table.of("u_line(patch, v), v_line, split_u(patch, t), split_v, boundary_curve(patch, edge)");
  table.row("parameter -0.1", invalid_argument, u_line(patch, -0.1));
  table.row("parameter NaN", non_finite, v_line(patch, not_a_number));
  table.row("a split at 1.5", invalid_argument, split_u(patch, 1.5));
  table.row("a split at infinity", non_finite, split_v(patch, infinity));
  table.row("no side", invalid_argument, boundary_curve(patch, Side{4}));
  table.of("sub_patch(patch, rectangle)");
  table.row("a reversed rectangle", invalid_argument, sub_patch(patch, {1, 0, 0, 1}));
  table.row("a rectangle beyond [0,1]", invalid_argument, sub_patch(patch, {0, 1, 0, 1.01}));
  table.row("NaN in the rectangle", non_finite, sub_patch(patch, {not_a_number, 1, 0, 1}));
  table.of("elevate_degree(patch, degree_u, degree_v), derivative_patch(patch, order_u, order_v)");
  table.row("a degree below the patch's", unsupported_degree, elevate_degree(patch, 1, 3));
  table.row("degree 16", unsupported_degree, elevate_degree(patch, 16, 3));
  table.row("a derivative of order -1", invalid_argument, derivative_patch(patch, -1, 0));
  table.row("a derivative of a rational patch", unsupported, derivative_patch(rational, 1, 0));
  table.gives("a derivative of order 2147483647", "a patch that is zero",
              max_abs(derivative_patch(patch, std::numeric_limits<int>::max(), 0)->point(0, 0)) == 0);
  table.of("make_ruled(c0, c1), make_cylinder(curve, direction), make_cone(apex, curve)");
  const BezierPolygon line{{{0, 0, 0}, {1, 0, 0}}, {}};
  table.row("curves without points", unsupported_degree, make_ruled({}, {}));
  table.row("a curve of 17 points", unsupported_degree, make_ruled(line, {std::vector<Vec3>(17), {}}));
  table.row("curves of other weights", unsupported, make_ruled(line, {line.points, {1, 2}}));
  table.row("a weight too few", count_mismatch, make_ruled({line.points, {1}}, {line.points, {1}}));
  table.row("a direction of 0", invalid_argument, make_cylinder(line, {}));
  table.row("an apex of NaN", non_finite, make_cone({not_a_number, 0, 0}, line));
  table.of("measure_net(patch, options)");
  table.row("1 sample", invalid_argument, measure_net(patch, {.samples = 1}));
  table.row("1001 samples", invalid_argument, measure_net(patch, {.samples = 1001}));
  table.row("a tolerance of NaN", invalid_argument, measure_net(patch, {.tolerance = not_a_number}));
}

void spline_operations(Table& table) {
  Random random(3);
  const Curve curve = random_curve(random, 3, {}, false);
  const BSplineSurface surface = random_surface(random, 3, 2, {}, {}, true);
  const double inside = 0.5 * (surface.domain().u0 + surface.domain().u1);
  table.of("insert_knots(curve, knots), insert_knots(surface, knots_u, knots_v)");
  table.row("a knot at an end of the domain", invalid_argument, insert_knots(curve, Numbers{curve.domain().from}));
  table.row("a knot of NaN", non_finite, insert_knots(curve, Numbers{not_a_number}));
  table.row("a knot too often", invalid_argument, insert_knots(surface, Numbers(4, inside), {}));
  table.of("elevate_degree(curve, by), elevate_degree(surface, by_u, by_v)");
  table.row("by -1", invalid_argument, elevate_degree(curve, -1));
  table.row("by 13, from degree 3", unsupported_degree, elevate_degree(surface, 13, 0));
  table.row("by 2147483647", unsupported_degree, elevate_degree(curve, std::numeric_limits<int>::max()));
  table.of("make_compatible(a, b)");
  const Curve other = *Curve::bezier(std::vector<Vec3>(3), {}, {100, 101});
  table.row("curves of other domains", invalid_argument, make_compatible(curve, other));
  table.of("touched_patches(surface, i, j)");
  table.row("an unknown point", invalid_argument, touched_patches(surface, 1000, 0));
}

void joins(Table& table, const BezierPatch& patch) {
  table.of("measure_join(p, q, tolerances)");
  const JoinedPatch side{patch};
  table.row("no side", invalid_argument, measure_join({patch, Side{5}}, side));
  table.row("an empty domain", invalid_argument, measure_join({patch, Side::u0, {0, 0, 0, 1}}, side));
  table.row("a negative tolerance", invalid_argument, measure_join(side, side, {.angle = -1}));
  table.row("a tolerance of NaN", invalid_argument, measure_join(side, side, {.position = not_a_number}));
  table.of("make_join(p, q, k, reversed)");
  table.row("k = 0", invalid_argument, make_join(side, side, 0));
  table.row("k = NaN", non_finite, make_join(side, side, not_a_number));
  table.row("k = infinity", non_finite, make_join(side, side, infinity));
}

void grids_of_patches(Table& table, const BezierPatch& patch) {
  table.of("PatchGrid::make(breaks_u, breaks_v, patches, error)");
  table.row("no breakpoints", invalid_argument, PatchGrid::make({}, {0, 1}, {}));
  table.row("breakpoints that decrease", invalid_argument, PatchGrid::make({0, 1, 0.5}, {0, 1}, {patch, patch}));
  table.row("a breakpoint of NaN", non_finite, PatchGrid::make({0, not_a_number}, {0, 1}, {patch}));
  table.row("a patch too few", count_mismatch, PatchGrid::make({0, 1, 2}, {0, 1}, {patch}));
  const Result<PatchGrid> grid = PatchGrid::make({0, 1}, {0, 1}, {patch});
  table.of("PatchGrid::locate(u, v), evaluate_jet(u, v)");
  table.gives("parameters of NaN", "nothing", !grid->locate(not_a_number, 0) && !grid->evaluate_jet(0, not_a_number));
  table.gives("parameters outside the domain", "nothing", !grid->locate(1.5, 0) && !grid->evaluate_jet(0, -1));
  table.of("transform(grid, map)");
  table.row("a map with NaN", non_finite, transform(*grid, Affine::translated({0, not_a_number, 0})));
  table.row("a map by which points overflow", non_finite,
            transform(*grid, Affine{{Vec3{1.7e308, 0, 0}, {1.7e308, 0, 0}, {1.7e308, 0, 0}}, {}}));
}

/// Two sound surfaces and a wrong one between them.
Model model_with(const Surface& surface, const Affine& placement = {}) {
  const BezierPatch sound = wavy_field(1, 1).front();
  return {.name = "model", .surfaces = {{"first", sound}, {"rim", surface, placement}, {"last", sound}}};
}

void models(Table& table, const BezierPatch& patch) {
  table.of("to_bezier(ModelSurface, FitOptions), evaluate_jet(ModelSurface, u, v)");
  const ModelSurface far{"far", patch, Affine::scaled({infinity, 1, 1})};
  table.row("a placement with infinity", non_finite, to_bezier(far));
  table.row("a placement with infinity, evaluated", non_finite, evaluate_jet(far, 0.5, 0.5));
  table.of("make_patch_set(model, options, fit)");
  table.row("no surfaces", invalid_argument, make_patch_set(Model{}));
  table.row("a placement with NaN", non_finite,
            make_patch_set(model_with(patch, Affine::translated({0, 0, not_a_number}))));
  const auto hole = ParametricSurface::make({.position = [](double u, double v) {
    return u == 0.5 ? Vec3{not_a_number, 0, 0} : Vec3{u, v, 0};
  }});
  table.row("a surface whose function gives NaN", non_finite, make_patch_set(model_with(*hole)));
  table.of("make_patch_set(grids, options)");
  table.row("no grids", invalid_argument, make_patch_set(std::span<const PatchGrid>{}));
}

}  // namespace

void fill_operations(Table& table) {
  Random random(1);
  const BezierPatch patch = random_polynomial(random, 3, 3), rational = random_rational(random, 3, 3);
  patch_operations(table, patch, rational);
  spline_operations(table);
  joins(table, patch);
  grids_of_patches(table, patch);
}

void fill_sets(Table& table) {
  const std::vector<BezierPatch> patches = wavy_field(2, 1);
  const auto huge = [&](double size) {
    std::vector<BezierPatch> list = patches;
    std::vector<Vec3> points(list[1].points().begin(), list[1].points().end());
    points[7].z = size;
    list[1] = *list[1].with_points(points);
    return list;
  };
  table.of("PatchSet::make(patches, options)");
  table.row("no patches", invalid_argument, PatchSet::make({}));
  table.row("a point of 1e300", non_finite, PatchSet::make(huge(1e300)));
  table.row("a point of 1e39", non_finite, PatchSet::make(huge(1e39)));
  const PatchSetOptions doubles{.blocks = {.float_bernstein = false, .double_bernstein = true}};
  table.gives("a point of 1e39, double blocks alone", "accepted", PatchSet::make(huge(1e39), doubles).ok());
  table.gives("a subnormal point", "accepted", PatchSet::make(huge(5e-324)).ok());
  table.row("an origin of NaN", non_finite, PatchSet::make(patches, {.origin = Vec3{0, not_a_number, 0}}));
  table.row("an origin of 1e300", non_finite, PatchSet::make(patches, {.origin = Vec3{1e300, 0, 0}}));
  std::vector<double> weights(16, 1.0);
  weights[5] = 1e-12;
  const BezierPatch light = *BezierPatch::rational(3, 3, patches[0].points(), weights);
  table.row("a weight of 1e-12 of the largest", non_finite, PatchSet::make(std::vector{patches[0], light}));
  table.row("a source too few", count_mismatch, PatchSet::make(patches, {.sources = std::vector<PatchSource>(1)}));

  table.of("PatchSet::set_control_points(index, points)");
  PatchSet set = value_of(PatchSet::make(patches));
  const auto refused = [&](const std::string& input, StatusCode code, std::size_t index,
                           const std::vector<Vec3>& points) {
    const std::uint64_t revision = set.revision();
    const Status status = set.set_control_points(index, points);
    table.row(input, code, status, [&] {
      return set.revision() == revision && std::ranges::equal(set.patch(1).points(), patches[1].points());
    });
  };
  std::vector<Vec3> points(patches[1].points().begin(), patches[1].points().end());
  refused("an unknown patch", invalid_argument, 2, points);
  refused("the largest number for a patch", invalid_argument, std::numeric_limits<std::size_t>::max(), points);
  refused("no points", count_mismatch, 1, {});
  refused("a point too few", count_mismatch, 1, std::vector<Vec3>(15));
  points[3].x = not_a_number;
  refused("NaN in a point", non_finite, 1, points);
  points[3].x = 1e300;
  refused("a point of 1e300", non_finite, 1, points);
  models(table, patches[0]);
}

}  // namespace tessera::test
