#include "robustness/mutated_surfaces.h"

#include "support/random_splines.h"

namespace tessera::test {
namespace {

template <class T>
Result<Surface> as_surface(const Result<T>& made) {
  return made ? Result<Surface>(Surface(*made)) : Result<Surface>(made.status());
}

Result<Surface> bezier(Mutator& m) {
  const int du = 1 + static_cast<int>(m.below(4)), dv = 1 + static_cast<int>(m.below(4));
  const std::vector<Vec3> points = m.list(random_points(m.random(), du, dv));
  if (m.chance(0.5)) return as_surface(BezierPatch::polynomial(m.integer(du), m.integer(dv), points));
  return as_surface(
      BezierPatch::rational(m.integer(du), m.integer(dv), points, m.list(random_weights(m.random(), du, dv, 0.25, 4))));
}

Result<Surface> b_spline(Mutator& m) {
  const KnotStyle style{.inner = static_cast<int>(m.below(3)), .clamped = m.chance(0.7), .multiple = m.chance(0.5)};
  const BSplineSurface sound = random_surface(m.random(), 1 + static_cast<int>(m.below(3)), 2, style, style, true);
  const auto copy = [](const auto& list) { return std::vector(list.begin(), list.end()); };
  const std::vector<double> u = m.list(copy(sound.knots_u())), v = m.list(copy(sound.knots_v()));
  const std::vector<double> weights = m.list(copy(sound.weights()));
  const std::vector<Vec3> points = m.list(copy(sound.points()));
  std::optional<Domain> domain;
  if (m.chance(0.3)) domain = m.domain(sound.domain());
  return as_surface(BSplineSurface::rational(m.integer(sound.degree_u()), u, m.integer(2), v, std::span(points),
                                             std::span(weights), domain));
}

Result<Surface> tensor(Mutator& m) {
  static const std::array bases{*BasisMatrix::hermite(), *BasisMatrix::catmull_rom(), *BasisMatrix::power(3),
                                *BasisMatrix::uniform_b_spline(3)};
  const BasisMatrix& u = bases[m.below(bases.size())];
  return as_surface(
      TensorPatch::make(u, bases[m.below(bases.size())], m.list(random_points(m.random(), 3, 3)), m.domain({})));
}

Result<Surface> hermite(Mutator& m) {
  return as_surface(HermitePatch::make(m.list(random_points(m.random(), 3, 3)), m.domain({})));
}

Result<Surface> network(Mutator& m) {
  std::vector<HermiteNode> nodes(6);
  for (HermiteNode& node : nodes)
    for (Vec3* vector : {&node.position, &node.du, &node.dv, &node.duv})
      *vector = m.point(uniform_vector(m.random(), -1, 1));
  return as_surface(
      HermiteNetwork::on_knots(m.list(std::vector<double>{0, 1, 2.5}), m.list(std::vector<double>{0, 2}), nodes));
}

Result<Curve> curve(Mutator& m, const Interval& domain) {
  const std::size_t count = 2 + m.below(3);
  return Curve::bezier(m.list(random_cloud(m.random(), count)),
                       m.chance(0.5) ? m.list(random_positive(m.random(), count)) : std::vector<double>{}, domain);
}

Result<Surface> ruled(Mutator& m) {
  const Interval domain{m.number(0), m.number(1)};
  const Result<Curve> a = curve(m, domain), b = curve(m, domain);
  if (!a) return a.status();
  if (!b) return b.status();
  return as_surface(RuledSurface::make(*a, *b, {m.number(0), m.number(2)}));
}

Result<Surface> coons(Mutator& m) {
  const auto line = [&](const Vec3& a, const Vec3& b) {
    return Curve::bezier(m.list(std::vector{a, 0.5 * (a + b) + 0.2 * uniform_vector(m.random(), -1, 1), b}));
  };
  const Result<Curve> c1 = line({0, 0, 0}, {1, 0, 0}), c2 = line({0, 1, 0}, {1, 1, 0}), d1 = line({0, 0, 0}, {0, 1, 0}),
                      d2 = line({1, 0, 0}, {1, 1, 0});
  for (const Result<Curve>* border : {&c1, &c2, &d1, &d2})
    if (!*border) return border->status();
  return as_surface(CoonsPatch::make({*c1, *c2, *d1, *d2}, {.f = m.chance(0.5) ? Blend::linear() : Blend::cubic(),
                                                            .closing_tolerance = m.number(1e-9)}));
}

Result<Surface> quadric(Mutator& m) {
  const auto signed_one = [&] { return m.number(m.chance(0.3) ? -1.0 : 1.0); };
  const Result<Quadric> made = Quadric::make({.a = signed_one(),
                                              .b = signed_one(),
                                              .c = m.number(m.chance(0.3) ? 0.0 : 1.0),
                                              .d = m.number(0),
                                              .g = m.number(0.1),
                                              .j = m.number(0),
                                              .k = m.number(-1)});
  if (!made) return made.status();
  return as_surface(QuadricPiece::make(*made, m.domain({0, 1, 0, 1}), m.integer(0)));
}

Result<Surface> explicit_polynomial(Mutator& m) {
  return as_surface(ExplicitPolynomial::make(
      m.integer(2), m.integer(1), m.list(std::vector<double>{1, 0, -0.5, 0.3, 0, 2}), m.domain({-1, 1, 0, 1})));
}

/// A function that is wrong at some places.
Result<Surface> function(Mutator& m) {
  const double threshold = uniform(m.random(), 0, 4), answer = m.number(0.25);
  const bool throws = m.chance(0.05);
  return as_surface(ParametricSurface::make({.position =
                                                 [=](double u, double v) {
                                                   if (u + v > threshold && throws)
                                                     throw std::runtime_error("no place");
                                                   return Vec3{u, v, u + v > threshold ? answer : 0.25};
                                                 }},
                                            m.domain({})));
}

}  // namespace

Result<Surface> mutated_surface(Mutator& m) {
  static constexpr std::array<Result<Surface> (*)(Mutator&), 12> makers{
      bezier, b_spline, bezier, tensor, hermite, network, ruled, coons, quadric, explicit_polynomial, bezier, function};
  return makers[m.below(makers.size())](m);
}

}  // namespace tessera::test
