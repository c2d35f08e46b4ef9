// Curves, Bezier and tensor patches, B-spline surfaces.

#include <array>
#include <vector>

#include "robustness/bad_input.h"
#include "tessera/bezier_patch.h"
#include "tessera/curve.h"
#include "tessera/nurbs_surface.h"
#include "tessera/tensor_patch.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Points = std::vector<Vec3>;
using Numbers = std::vector<double>;

Points points(std::size_t count) {
  Points out;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = static_cast<double>(k);
    out.push_back({x, 0.25 * x * x, 1 - x});
  }
  return out;
}
Points with(Points list, std::size_t k, const Vec3& point) {
  list[k] = point;
  return list;
}
Numbers with(Numbers list, std::size_t k, double number) {
  list[k] = number;
  return list;
}

/// Faults of a list of points; a maker must report or accept each.
template <class Make>
void bad_points(Table& table, std::size_t count, Make make) {
  table.row("no points", count_mismatch, make(Points{}));
  table.row("a point too few", count_mismatch, make(points(count - 1)));
  table.row("a point too many", count_mismatch, make(points(count + 1)));
  table.row("NaN in a point", non_finite, make(with(points(count), 1, {0, not_a_number, 0})));
  table.row("infinity in a point", non_finite, make(with(points(count), count - 1, {0, 0, -infinity})));
  table.gives("points of 1e300", "accepted", make(with(points(count), 1, {1e300, 0, 0})).ok());
  table.gives("subnormal points", "accepted", make(with(points(count), 1, {5e-324, -5e-324, 0})).ok());
}

template <class Make>
void bad_weights(Table& table, std::size_t count, Make make) {
  const Numbers good(count, 1.5);
  table.row("a weight too few", count_mismatch, make(Numbers(count - 1, 1.0)));
  table.row("a weight of 0", invalid_weight, make(with(good, 1, 0)));
  table.row("a negative weight", invalid_weight, make(with(good, 2, -1)));
  table.row("a weight of NaN", invalid_weight, make(with(good, 0, not_a_number)));
  table.row("an infinite weight", invalid_weight, make(with(good, 0, infinity)));
  table.row("a weight of 1e-101 of the largest", invalid_weight, make(with(good, 1, 1.5e-101)));
}

template <class Make>
void bad_knots(Table& table, Make make) {
  const Numbers good{0, 0, 0, 1, 2, 2, 2};
  table.row("no knots", count_mismatch, make(Numbers{}));
  table.row("a knot too few", count_mismatch, make(Numbers(good.begin(), good.end() - 1)));
  table.row("a knot that decreases", invalid_argument, make(with(good, 3, -1)));
  table.row("an inner knot more often than the degree", invalid_argument, make(Numbers{0, 0, 1, 1, 1, 2, 2}));
  table.row("all knots equal", invalid_argument, make(Numbers(7, 1.0)));
  table.row("NaN in a knot", non_finite, make(with(good, 3, not_a_number)));
  table.row("an infinite knot", non_finite, make(with(good, 6, infinity)));
}

}  // namespace

void fill_curves(Table& table) {
  const Numbers knots{0, 0, 0, 1, 2, 2, 2};
  table.of("Curve::bezier(points, weights, domain)");
  table.row("no points", unsupported_degree, Curve::bezier(Points{}));
  table.row("one point", unsupported_degree, Curve::bezier(points(1)));
  table.row("17 points", unsupported_degree, Curve::bezier(points(17)));
  table.row("NaN in a point", non_finite, Curve::bezier(with(points(4), 2, {not_a_number, 0, 0})));
  bad_weights(table, 4, [](const Numbers& w) { return Curve::bezier(points(4), w); });
  table.row("an empty domain", invalid_argument, Curve::bezier(points(4), {}, {1, 1}));
  table.row("a reversed domain", invalid_argument, Curve::bezier(points(4), {}, {1, 0}));
  table.row("a domain with NaN", non_finite, Curve::bezier(points(4), {}, {not_a_number, 1}));

  table.of("Curve::b_spline(degree, points, knots, domain)");
  table.row("degree 0", unsupported_degree, Curve::b_spline(0, points(4), knots));
  table.row("degree 16", unsupported_degree, Curve::b_spline(16, points(4), knots));
  table.row("degree -1", unsupported_degree, Curve::b_spline(-1, points(4), knots));
  bad_points(table, 4, [&](const Points& p) { return Curve::b_spline(2, p, knots); });
  bad_knots(table, [](const Numbers& k) { return Curve::b_spline(2, points(4), k); });
  table.row("a domain beyond the knots", invalid_argument, Curve::b_spline(2, points(4), knots, Interval{0, 3}));
  table.row("a domain with NaN", non_finite, Curve::b_spline(2, points(4), knots, Interval{0, not_a_number}));

  table.of("Curve::nurbs(degree, points, weights, knots, domain)");
  bad_weights(table, 4, [&](const Numbers& w) { return Curve::nurbs(2, points(4), w, knots); });
  table.of("make_nurbs_circle(axis, radius, arcs)");
  table.row("an axis without a direction", invalid_argument, make_nurbs_circle({.direction = {}}, 1));
  table.row("a zero angle along the axis", invalid_argument, make_nurbs_circle({.zero = {0, 0, 2}}, 1));
  table.row("NaN in the axis", non_finite, make_nurbs_circle({.direction = {0, not_a_number, 1}}, 1));
  table.row("radius 0", invalid_argument, make_nurbs_circle({}, 0));
  table.row("radius NaN", non_finite, make_nurbs_circle({}, not_a_number));
}

void fill_patches(Table& table) {
  table.of("BezierPatch::polynomial(degree_u, degree_v, points)");
  for (const int degree : {0, -1, 16})
    table.row("degree " + std::to_string(degree) + " along u", unsupported_degree,
              BezierPatch::polynomial(degree, 3, points(16)));
  table.row("degree 2147483647 along v", unsupported_degree,
            BezierPatch::polynomial(3, std::numeric_limits<int>::max(), points(16)));
  bad_points(table, 16, [](const Points& p) { return BezierPatch::polynomial(3, 3, p); });
  table.of("BezierPatch::rational(degree_u, degree_v, points, weights)");
  bad_points(table, 16, [](const Points& p) { return BezierPatch::rational(3, 3, p, with(Numbers(16, 1.0), 3, 2)); });
  bad_weights(table, 16, [](const Numbers& w) { return BezierPatch::rational(3, 3, points(16), w); });
  table.of("BezierPatch::with_points(points)");
  const Result<BezierPatch> patch = BezierPatch::polynomial(3, 3, points(16));
  bad_points(table, 16, [&](const Points& p) { return patch->with_points(p); });

  table.of("BasisMatrix::bezier, power, uniform_b_spline(degree)");
  table.row("degree 0", unsupported_degree, BasisMatrix::bezier(0));
  table.row("degree 16", unsupported_degree, BasisMatrix::power(16));
  table.row("degree -3", unsupported_degree, BasisMatrix::uniform_b_spline(-3));
  table.of("BasisMatrix::custom(degree, entries)");
  table.row("degree 16", unsupported_degree, BasisMatrix::custom(16, Numbers(289, 1.0)));
  table.row("an entry too few", count_mismatch, BasisMatrix::custom(2, Numbers(8, 1.0)));
  table.row("NaN in an entry", non_finite, BasisMatrix::custom(1, Numbers{1, 0, not_a_number, 1}));
  table.of("TensorPatch::make(basis_u, basis_v, geometry, domain)");
  const Result<BasisMatrix> basis = BasisMatrix::hermite();
  bad_points(table, 16, [&](const Points& p) { return TensorPatch::make(*basis, *basis, p); });
  table.row("an empty domain", invalid_argument, TensorPatch::make(*basis, *basis, points(16), {0, 0, 0, 1}));
  table.row("NaN in the domain", non_finite, TensorPatch::make(*basis, *basis, points(16), {0, not_a_number, 0, 1}));
  table.of("change_basis(patch, basis_u, basis_v)");
  const Result<TensorPatch> tensor = TensorPatch::make(*basis, *basis, points(16));
  const Result<BasisMatrix> singular = BasisMatrix::custom(3, Numbers(16, 1.0)), line = BasisMatrix::power(1);
  table.row("a singular basis", invalid_argument, change_basis(*tensor, *singular, *basis));
  table.row("a basis of a lower degree", unsupported_degree, change_basis(*tensor, *basis, *line));
}

void fill_splines(Table& table) {
  const Numbers knots{0, 0, 0, 1, 2, 2, 2}, line{0, 0, 1, 1};
  table.of("BSplineSurface::polynomial(degree_u, knots_u, degree_v, knots_v, points, domain)");
  table.row("degree 0 along u", unsupported_degree, BSplineSurface::polynomial(0, knots, 1, line, points(8)));
  table.row("degree 16 along v", unsupported_degree, BSplineSurface::polynomial(2, knots, 16, line, points(8)));
  bad_points(table, 8, [&](const Points& p) { return BSplineSurface::polynomial(2, knots, 1, line, std::span(p)); });
  bad_knots(table, [&](const Numbers& k) { return BSplineSurface::polynomial(2, k, 1, line, points(8)); });
  table.row("a domain beyond the knots", invalid_argument,
            BSplineSurface::polynomial(2, knots, 1, line, points(8), Domain{0, 3, 0, 1}));
  table.row("a reversed domain", invalid_argument,
            BSplineSurface::polynomial(2, knots, 1, line, points(8), Domain{0, 2, 1, 0}));
  table.of("BSplineSurface::rational(degree_u, knots_u, degree_v, knots_v, points, weights, domain)");
  bad_weights(table, 8, [&](const Numbers& w) {
    return BSplineSurface::rational(2, knots, 1, line, std::span<const Vec3>(points(8)), std::span(w));
  });

  const Axis axis;
  table.of("make_nurbs_sphere, make_nurbs_torus, make_nurbs_cylinder, make_nurbs_cone(axis, ...)");
  table.row("a sphere of radius -1", invalid_argument, make_nurbs_sphere(axis, -1));
  table.row("a sphere of infinite radius", non_finite, make_nurbs_sphere(axis, infinity));
  table.row("a torus whose tube is as thick as its ring", invalid_argument, make_nurbs_torus(axis, 1, 1));
  table.row("a cylinder of height 0", invalid_argument, make_nurbs_cylinder(axis, 1, 0));
  table.row("a cone with two apices", invalid_argument, make_nurbs_cone(axis, 0, 0, 1));
  table.row("NaN in the axis", non_finite, make_nurbs_cone({.origin = {not_a_number, 0, 0}}, 1, 0, 1));
  table.of("make_surface_of_revolution(profile, axis, arcs)");
  const Result<Curve> profile = Curve::bezier(points(3));
  table.row("an axis without a direction", invalid_argument, make_surface_of_revolution(*profile, {.direction = {}}));
}

}  // namespace tessera::test
