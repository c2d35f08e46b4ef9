// Hermite patches and networks, quadrics, functions, borders.

#include <stdexcept>
#include <vector>

#include "robustness/bad_input.h"
#include "tessera/convert.h"
#include "tessera/coons_patch.h"
#include "tessera/generic_callable.h"
#include "tessera/hermite_patch.h"
#include "tessera/quadric.h"
#include "tessera/tensor_patch.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Numbers = std::vector<double>;

Vec3 plane(double u, double v) { return {u, v, 0}; }

Curve straight(const Vec3& a, const Vec3& b, const Interval& domain = {}) {
  return *Curve::bezier(std::vector<Vec3>{a, b}, {}, domain);
}

CoonsBorders square() {
  return {straight({0, 0, 0}, {1, 0, 0}), straight({0, 1, 0}, {1, 1, 0}), straight({0, 0, 0}, {0, 1, 0}),
          straight({1, 0, 0}, {1, 1, 0})};
}

/// A surface that is `position` but for the corners of its domain, which are sound.
Result<ParametricSurface> surface(std::function<Vec3(double, double)> position) {
  return ParametricSurface::make({.position = [=](double u, double v) {
    return (u == 0 || u == 1) && (v == 0 || v == 1) ? plane(u, v) : position(u, v);
  }});
}

void callable_curves(Table& table) {
  table.of("ParametricCurve::make(functions, domain)");
  table.row("an empty std::function", invalid_argument, ParametricCurve::make({}));
  const auto line = [](double t) { return Vec3{t, 0, 0}; };
  table.row("an empty interval", invalid_argument, ParametricCurve::make({.position = line}, {2, 2}));
  table.row("an infinite interval", non_finite, ParametricCurve::make({.position = line}, {0, infinity}));
  table.row("a function that gives NaN at an end", non_finite, ParametricCurve::make({.position = [](double) {
              return Vec3{not_a_number, 0, 0};
            }}));
  table.row("a function that throws", invalid_argument,
            ParametricCurve::make({.position = [](double) -> Vec3 { throw std::runtime_error("no such place"); }}));
  table.row("a function that throws what is no std::exception", invalid_argument,
            ParametricCurve::make({.position = [](double) -> Vec3 { throw 1; }}));
}

void callable_fits(Table& table) {
  table.of("evaluate_jet(ParametricSurface, u, v)");
  const auto hole = surface([](double u, double v) { return u > 0.4 ? Vec3{not_a_number, 0, 0} : plane(u, v); });
  table.row("NaN at (u,v)", non_finite, evaluate_jet(*hole, 0.5, 0.5));
  const auto thrower = surface([](double, double) -> Vec3 { throw std::runtime_error("not here"); });
  table.row("a function that throws", invalid_argument, evaluate_jet(*thrower, 0.5, 0.5));
  table.row("parameters of NaN", non_finite, evaluate_jet(*surface(plane), not_a_number, 0.5));

  table.of("to_bezier(ParametricSurface, FitOptions)");
  const Result<ParametricSurface> flat = surface(plane);
  table.row("a function that gives NaN inside", non_finite, to_bezier(*hole));
  table.row("a function that throws inside", invalid_argument, to_bezier(*thrower));
  table.row("a tolerance of NaN", invalid_argument, to_bezier(*flat, {.tolerance = not_a_number}));
  table.row("a negative tolerance", invalid_argument, to_bezier(*flat, {.tolerance = -1}));
  table.row("a tolerance below rounding", invalid_argument, to_bezier(*flat, {.tolerance = 1e-300}));
  table.row("degree 1", invalid_argument, to_bezier(*flat, {.degree = 1}));
  table.row("degree 16", invalid_argument, to_bezier(*flat, {.degree = 16}));
  table.row("a largest count of 0 patches", invalid_argument, to_bezier(*flat, {.max_patches = 0}));
  table.row("breaks that decrease", invalid_argument, to_bezier(*flat, {.breaks_u = {0.5, 0.25}}));
  table.row("a break outside the domain", invalid_argument, to_bezier(*flat, {.breaks_v = {2}}));
  table.row("a break of NaN", invalid_argument, to_bezier(*flat, {.breaks_v = {not_a_number}}));
  const auto jump = surface([](double u, double v) { return Vec3{u, v, u < 0.3 ? 0.0 : 1.0}; });
  table.row("a jump inside", invalid_argument, to_bezier(*jump, {.tolerance = 1e-3, .max_patches = 64}));
}

void quadric_equations(Table& table) {
  table.of("Quadric::make(coefficients, options)");
  table.row("coefficients that are all 0", invalid_argument, Quadric::make({}));
  table.row("NaN in a coefficient", non_finite, Quadric::make({.a = 1, .b = not_a_number}));
  table.row("infinity in a coefficient", non_finite, Quadric::make({.a = 1, .k = infinity}));
  table.row("a tolerance of 0", invalid_argument, Quadric::make({.a = 1}, {.tolerance = 0}));
  table.row("a tolerance of NaN", invalid_argument, Quadric::make({.a = 1}, {.tolerance = not_a_number}));
  table.row("a negative length", invalid_argument, Quadric::make({.a = 1}, {.length = -1}));
  const QuadricCoefficients ball{.a = 1, .b = 1, .c = 1, .k = -1};
  table.gives("coefficients of 1e300", "accepted",
              Quadric::make({.a = 1e300, .b = 1e300, .c = 1e300, .k = -1e300}).ok());
  table.of("QuadricPiece::make(quadric, range, sheet)");
  const Result<Quadric> sphere = Quadric::make(ball), nothing = Quadric::make({.a = 1, .b = 1, .c = 1, .k = 1});
  table.row("an imaginary quadric", unsupported, QuadricPiece::make(*nothing, {}));
  table.row("an empty range", invalid_argument, QuadricPiece::make(*sphere, {0, 0, 0, 1}));
  table.row("a reversed range", invalid_argument, QuadricPiece::make(*sphere, {0, 1, 1, 0}));
  table.row("latitudes beyond the pole", invalid_argument, QuadricPiece::make(*sphere, {0, 1, 0, 2}));
  table.row("more than a full turn", invalid_argument, QuadricPiece::make(*sphere, {0, 7, 0, 1}));
  table.row("NaN in the range", non_finite, QuadricPiece::make(*sphere, {0, not_a_number, 0, 1}));
  table.row("a second sheet of a sphere", invalid_argument, QuadricPiece::make(*sphere, {}, 1));
  table.row("sheet -1", invalid_argument, QuadricPiece::make(*sphere, {}, -1));
  table.of("intersect(quadric, origin, direction)");
  table.gives("a direction of 0", "no hit", intersect(*sphere, {0, 0, 3}, {}).count == 0);
  table.gives("NaN in the origin", "no hit", intersect(*sphere, {0, not_a_number, 3}, {0, 0, -1}).count == 0);
  table.gives("an infinite direction", "no hit", intersect(*sphere, {0, 0, 3}, {0, 0, -infinity}).count == 0);
}

void coons_borders(Table& table) {
  table.of("CoonsPatch::make(borders, options)");
  CoonsBorders open = square();
  open.d2 = straight({1, 0, 0}, {1, 1, 0.25});
  table.row("a border that does not close", invalid_argument, CoonsPatch::make(open));
  CoonsBorders shifted = square();
  shifted.c2 = straight({0, 1, 0}, {1, 1, 0}, {0, 2});
  table.row("curves on different intervals", invalid_argument, CoonsPatch::make(shifted));
  table.row("a closing tolerance of NaN", invalid_argument,
            CoonsPatch::make(square(), {.closing_tolerance = not_a_number}));
  table.row("a negative closing tolerance", invalid_argument, CoonsPatch::make(square(), {.closing_tolerance = -1}));

  table.of("Blend::polynomial(first, second)");
  table.row("no coefficients", unsupported_degree, Blend::polynomial({}, {}));
  table.row("blends that do not sum to 1", invalid_argument, Blend::polynomial(Numbers{1, -1}, Numbers{0, 0.5}));
  table.row("blends that are not 1 and 0 at 0", invalid_argument,
            Blend::polynomial(Numbers{0.5, 0.1}, Numbers{0.5, -0.1}));
  table.row("NaN in a coefficient", non_finite, Blend::polynomial(Numbers{1, not_a_number}, Numbers{0, 1}));
  table.row("a coefficient of 1e300", invalid_argument, Blend::polynomial(Numbers{1, 1e300}, Numbers{0, -1e300}));
  table.row("degree 16", unsupported_degree, Blend::polynomial(Numbers(17, 1.0), Numbers(17, 0.0)));
  table.of("Blend::callable(first, second)");
  const auto down = [](double t) { return 1 - t; };
  table.row("an empty std::function", invalid_argument, Blend::callable(down, {}));
  table.row("functions that do not sum to 1", invalid_argument, Blend::callable(down, down));
  table.row("a function that gives NaN", non_finite,
            Blend::callable(down, [](double t) { return t == 0.5 ? not_a_number : t; }));
  table.row("a function that throws", invalid_argument,
            Blend::callable(down, [](double) -> double { throw std::runtime_error("out of order"); }));
}

}  // namespace

void fill_callables(Table& table) {
  callable_curves(table);
  table.of("ParametricSurface::make(functions, domain)");
  table.row("an empty std::function", invalid_argument, ParametricSurface::make({}));
  table.row("a rectangle that is empty", invalid_argument, ParametricSurface::make({.position = plane}, {0, 0, 0, 1}));
  table.row("a rectangle with NaN", non_finite, ParametricSurface::make({.position = plane}, {0, not_a_number, 0, 1}));
  table.row("a function that is infinite at a corner", non_finite,
            ParametricSurface::make({.position = [](double u, double) {
              return Vec3{1 / u, 0, 0};
            }}));
  table.of("ParametricSurface::over_disc(functions, disc), PolarMap::make(disc)");
  table.row("an empty std::function", invalid_argument, ParametricSurface::over_disc({}));
  table.row("radius 0", invalid_argument, ParametricSurface::over_disc({.position = plane}, {0, 0, 0}));
  table.row("a radius that is lost beside the centre", invalid_argument, PolarMap::make({1e20, 0, 1}));
  table.row("NaN in the centre", non_finite, PolarMap::make({not_a_number, 0, 1}));
  table.of("generic_surface(f, domain)");
  table.row("an expression that is not finite at a corner", non_finite, generic_surface([](auto u, auto v) {
              return std::array{1 / u, u + v, v};
            }));
  callable_fits(table);
}

void fill_hermite(Table& table) {
  const std::vector<Vec3> geometry(16, Vec3{1, 2, 3});
  std::vector<Vec3> bad = geometry;
  bad[5].y = not_a_number;
  table.of("HermitePatch::make(geometry, domain, order)");
  table.row("15 vectors", count_mismatch, HermitePatch::make(std::span(geometry).first(15)));
  table.row("NaN in a vector", non_finite, HermitePatch::make(bad));
  table.row("an empty domain", invalid_argument, HermitePatch::make(geometry, {1, 1, 0, 1}));
  table.row("an infinite domain", non_finite, HermitePatch::make(geometry, {0, infinity, 0, 1}));
  table.of("HermitePatch::from_algebraic(coefficients), ferguson, adini");
  table.row("no coefficients", count_mismatch, HermitePatch::from_algebraic({}));
  HermitePatch::OpenCorners corners{};
  corners[2].du.x = infinity;
  table.row("an infinite tangent", non_finite, HermitePatch::ferguson(corners));
  table.row("an infinite tangent (adini)", non_finite, HermitePatch::adini(corners));
  table.of("HermitePatch::through_points(points, u, v, domain)");
  const Numbers thirds{0, 1.0 / 3, 2.0 / 3, 1};
  table.row("two equal parameters: the system is singular", invalid_argument,
            HermitePatch::through_points(geometry, Numbers{0, 0.5, 0.5, 1}, thirds));
  table.row("three parameters", count_mismatch, HermitePatch::through_points(geometry, Numbers{0, 0.5, 1}, thirds));
  table.row("a parameter of NaN", non_finite,
            HermitePatch::through_points(geometry, thirds, Numbers{0, not_a_number, 0.5, 1}));

  table.of("HermiteNetwork::from_factors(count_u, count_v, nodes, k, l)");
  const std::vector<HermiteNode> nodes(6);
  const Numbers two{1, 2}, one{1};
  table.row("one node along u", invalid_argument, HermiteNetwork::from_factors(1, 6, nodes, {}, Numbers(5, 1.0)));
  table.row("a network of the wrong shape", count_mismatch, HermiteNetwork::from_factors(3, 3, nodes, two, two));
  table.row("counts whose product overflows", count_mismatch,
            HermiteNetwork::from_factors(std::size_t{1} << 33, std::size_t{1} << 33, nodes, two, one));
  table.row("a factor of 0", invalid_argument, HermiteNetwork::from_factors(3, 2, nodes, Numbers{1, 0}, one));
  table.row("a first factor that is not 1", invalid_argument,
            HermiteNetwork::from_factors(3, 2, nodes, Numbers{2, 2}, one));
  table.row("a factor of NaN", non_finite, HermiteNetwork::from_factors(3, 2, nodes, Numbers{1, not_a_number}, one));
  table.of("HermiteNetwork::on_knots(u, v, nodes), estimate_twists(estimate, u, v, nodes)");
  table.row("knots that do not increase", invalid_argument,
            HermiteNetwork::on_knots(Numbers{0, 1, 1}, Numbers{0, 1}, nodes));
  table.row("no knots", invalid_argument, HermiteNetwork::on_knots({}, {}, {}));
  table.row("two knots for Bessel twists", invalid_argument,
            estimate_twists(TwistEstimate::bessel, Numbers{0, 1, 2}, Numbers{0, 1}, nodes));
  table.row("a node too few", count_mismatch,
            estimate_twists(TwistEstimate::adini, Numbers{0, 1, 2}, Numbers{0, 1}, std::span(nodes).first(5)));
}

void fill_quadrics(Table& table) {
  quadric_equations(table);
  table.of("ExplicitPolynomial::make(degree_x, degree_y, coefficients, rectangle)");
  table.row("degree -1", unsupported_degree, ExplicitPolynomial::make(-1, 0, Numbers{}, {}));
  table.row("degree 16", unsupported_degree, ExplicitPolynomial::make(16, 0, Numbers(17, 1.0), {}));
  table.row("a coefficient too few", count_mismatch, ExplicitPolynomial::make(1, 1, Numbers(3, 1.0), {}));
  table.row("NaN in a coefficient", non_finite, ExplicitPolynomial::make(1, 0, Numbers{0, not_a_number}, {}));
  table.row("an infinite rectangle", non_finite, ExplicitPolynomial::make(0, 0, Numbers{1}, {0, infinity, 0, 1}));
  table.of("to_bezier(ExplicitPolynomial)");
  const auto steep = ExplicitPolynomial::make(2, 0, Numbers{0, 0, 1e300}, {0, 1e10, 0, 1});
  table.row("a height out of the range of doubles", non_finite, to_bezier(*steep));
}

void fill_borders(Table& table) {
  table.of("RuledSurface::make(first, second, across, straight)");
  const Curve a = straight({0, 0, 0}, {1, 0, 0}), b = straight({0, 1, 0}, {1, 1, 0}, {0, 2});
  table.row("curves on different intervals", invalid_argument, RuledSurface::make(a, b));
  table.row("an interval that is reversed", invalid_argument, RuledSurface::make(a, a, {1, 0}));
  table.row("an interval with NaN", non_finite, RuledSurface::make(a, a, {0, not_a_number}));
  coons_borders(table);
  table.of("to_bezier(CoonsPatch), to_bezier(RuledSurface)");
  std::vector<Vec3> line;
  for (int k = 0; k <= 15; ++k) line.push_back({k / 15.0, 0, 0});
  std::vector<double> weights(16, 1.0), others(16, 1.0);
  weights[3] = 2;
  others[7] = 3;
  const Result<RuledSurface> high = RuledSurface::make(*Curve::bezier(line, weights), *Curve::bezier(line, others));
  table.row("rational borders whose products exceed degree 15", unsupported_degree, to_bezier(*high));
  const auto hole = ParametricCurve::make({.position = [](double t) {
    return t > 0.4 && t < 0.6 ? Vec3{not_a_number, 0, 0} : Vec3{t, 0, 0};
  }});
  table.row("a border that gives NaN inside", non_finite, to_bezier(*RuledSurface::make(*hole, a)));
}

}  // namespace tessera::test
