// The reader of .json models: every kind reads back as it was written.

#include <gtest/gtest.h>

#include <algorithm>

#include "io/model_text.h"
#include "support/errors.h"
#include "support/quadrics.h"
#include "support/random_bases.h"
#include "support/random_hermite.h"
#include "support/random_splines.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

std::string field(const std::string& key, const std::string& value) { return "\"" + key + "\": " + value; }

void expect_same(const Curve& a, const Curve& b) {
  EXPECT_EQ(a.degree(), b.degree());
  EXPECT_TRUE(std::ranges::equal(a.points(), b.points()));
  EXPECT_TRUE(std::ranges::equal(a.weights(), b.weights()));
  EXPECT_TRUE(std::ranges::equal(a.knots(), b.knots()));
  EXPECT_EQ(a.domain(), b.domain());
}
void expect_same(const BSplineSurface& a, const BSplineSurface& b) {
  EXPECT_EQ(a.degree_u(), b.degree_u());
  EXPECT_EQ(a.degree_v(), b.degree_v());
  EXPECT_TRUE(std::ranges::equal(a.points(), b.points()));
  EXPECT_TRUE(std::ranges::equal(a.weights(), b.weights()));
  EXPECT_TRUE(std::ranges::equal(a.knots_u(), b.knots_u()));
  EXPECT_TRUE(std::ranges::equal(a.knots_v(), b.knots_v()));
  EXPECT_EQ(a.domain(), b.domain());
}
void expect_same(const HermitePatch& a, const HermitePatch& b) {
  EXPECT_EQ(a.geometry(), b.geometry());
  EXPECT_EQ(a.domain(), b.domain());
}

Domain random_domain(Random& random) {
  const double u = uniform(random, -5, 5), v = uniform(random, -5, 5);
  return {u, u + uniform(random, 0.1, 3), v, v + uniform(random, 0.1, 3)};
}

TEST(JsonModel, BezierPatchesOfEveryDegree) {
  Random random(1);
  for (int m = 1; m <= max_degree; ++m)
    for (int n = 1; n <= max_degree; n += 1 + static_cast<int>(random() % 4)) {
      const BezierPatch patch = random() % 2 ? random_polynomial(random, m, n) : random_rational(random, m, n);
      const std::size_t columns = static_cast<std::size_t>(n + 1);
      std::string fields = field("points", json_net(patch.points(), columns));
      if (patch.is_rational()) fields += ", " + field("weights", json_net(patch.weights(), columns));
      if (random() % 2) fields += ", " + field("degree", "[" + std::to_string(m) + ", " + std::to_string(n) + "]");
      const BezierPatch read = read_as<BezierPatch>("bezier", fields);
      EXPECT_EQ(read.degree_u(), m);
      EXPECT_EQ(read.degree_v(), n);
      EXPECT_TRUE(std::ranges::equal(read.points(), patch.points()));
      EXPECT_TRUE(std::ranges::equal(read.weights(), patch.weights()));
    }
}

TEST(JsonModel, TensorPatchesOfEveryBasis) {
  Random random(2);
  const auto basis_text = [](const NamedBasis& named) -> std::string {
    const BasisMatrix& basis = named.basis;
    const std::string name = named.name;
    if (name == "custom") {
      std::vector<double> entries;
      for (int k = 0; k <= basis.degree(); ++k)
        for (int i = 0; i <= basis.degree(); ++i) entries.push_back(basis.power_coefficient(k, i));
      return json_net(std::span<const double>(entries), static_cast<std::size_t>(basis.degree() + 1));
    }
    return name == "Bezier"             ? "\"bezier\""
           : name == "power"            ? "\"power\""
           : name == "uniform B-spline" ? "\"uniform_b_spline\""
           : name == "Hermite"          ? "\"hermite\""
                                        : "\"catmull_rom\"";
  };
  for (const NamedBasis& u : bases_of(random, 3))
    for (const int n : {1, 3, 5})
      for (const NamedBasis& v : bases_of(random, n)) {
        const TensorPatch patch = random_tensor(random, u.basis, v.basis, random_domain(random));
        const auto read = read_as<TensorPatch>(
            "tensor", field("basis_u", basis_text(u)) + ", " + field("basis_v", basis_text(v)) + ", " +
                          field("geometry", json_net(patch.geometry(), static_cast<std::size_t>(n + 1))) + ", " +
                          field("domain", json(patch.domain())));
        EXPECT_EQ(read.basis_u(), patch.basis_u()) << u.name;
        EXPECT_EQ(read.basis_v(), patch.basis_v()) << v.name;
        EXPECT_TRUE(std::ranges::equal(read.geometry(), patch.geometry()));
        EXPECT_EQ(read.domain(), patch.domain());
      }
  const auto both = read_as<TensorPatch>(
      "tensor", field("basis", "\"power\"") + ", " + field("geometry", "[[[0,0,0],[0,1,0]],[[1,0,0],[0,0,1]]]"));
  EXPECT_EQ(both.basis_u(), value_of(BasisMatrix::power(1)));
  EXPECT_EQ(both.basis_v(), value_of(BasisMatrix::power(1)));
}

TEST(JsonModel, SplinesOfEveryStyle) {
  Random random(3);
  for (int k = 0; k < 40; ++k) {
    const int p = 1 + static_cast<int>(random() % 6), q = 1 + static_cast<int>(random() % 6);
    const auto style = [&] {
      return KnotStyle{
          .inner = static_cast<int>(random() % 4), .clamped = random() % 2 == 0, .multiple = random() % 2 == 0};
    };
    const BSplineSurface surface = random_surface(random, p, q, style(), style(), k % 2 == 0);
    std::string fields = field("degree", "[" + std::to_string(p) + ", " + std::to_string(q) + "]") + ", " +
                         field("knots_u", json(surface.knots_u())) + ", " + field("knots_v", json(surface.knots_v())) +
                         ", " + field("points", json_net(surface.points(), surface.count_v()));
    if (surface.is_rational()) fields += ", " + field("weights", json_net(surface.weights(), surface.count_v()));
    if (k % 3 == 0) fields += ", " + field("domain", json(surface.domain()));
    expect_same(read_as<BSplineSurface>(surface.is_rational() ? "nurbs" : "b_spline", fields), surface);
  }
}

TEST(JsonModel, KnotsByWords) {
  const std::string points = field("points",
                                   "[[[0,0,0],[0,1,0],[0,2,0]],[[1,0,0],[1,1,1],[1,2,0]],"
                                   "[[2,0,0],[2,1,0],[2,2,0]],[[3,0,0],[3,1,0],[3,2,1]]]");
  const auto read = [&](const std::string& u, const std::string& v) {
    return read_as<BSplineSurface>(
        "b_spline", field("degree", "2") + ", " + field("knots_u", u) + ", " + field("knots_v", v) + ", " + points);
  };
  const BSplineSurface surface = read("\"clamped\"", "\"uniform\"");
  EXPECT_TRUE(std::ranges::equal(surface.knots_u(), std::vector<double>{0, 0, 0, 1, 2, 2, 2}));
  EXPECT_TRUE(std::ranges::equal(surface.knots_v(), std::vector<double>{-2, -1, 0, 1, 2, 3}));
  EXPECT_EQ(surface.domain(), (Domain{0, 2, 0, 1}));

  const BSplineSurface closed = read("\"periodic\"", "\"periodic\"");
  EXPECT_EQ(closed.domain(), (Domain{0, 4, 0, 3}));
  EXPECT_EQ(closed.count_u(), 6u);
  EXPECT_EQ(closed.count_v(), 5u);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 5; ++j) EXPECT_EQ(closed.point(i, j), closed.point(i % 4, j % 3));
  for (const double t : {0.0, 0.7, 1.9}) {
    const SurfaceJet first = evaluate_jet(closed, 0, t), last = evaluate_jet(closed, 4, t);
    EXPECT_LT(max_abs(first.position - last.position), 1e-14);
    EXPECT_LT(max_abs(first.du - last.du), 1e-14);
  }
}

TEST(JsonModel, ShapesOfRevolution) {
  const Axis axis{.origin = {1, 2, 3}, .direction = {1, 1, 0}, .zero = {0, 0, 1}};
  const std::string with_axis =
      ", " + field("axis", R"({"origin": [1, 2, 3], "direction": [1, 1, 0], "zero": [0, 0, 1]})");
  const auto read = [](const std::string& kind, const std::string& fields) {
    return read_as<BSplineSurface>(kind, fields);
  };
  expect_same(read("sphere", field("radius", "2")), value_of(make_nurbs_sphere({}, 2)));
  expect_same(read("sphere", field("radius", "2") + ", " + field("arcs", "3") + with_axis),
              value_of(make_nurbs_sphere(axis, 2, CircleArcs::three)));
  expect_same(read("torus", field("major", "3") + ", " + field("minor", "0.5") + with_axis),
              value_of(make_nurbs_torus(axis, 3, 0.5)));
  expect_same(read("cylinder", field("radius", "2") + ", " + field("height", "5") + with_axis),
              value_of(make_nurbs_cylinder(axis, 2, 5)));
  expect_same(read("cone", field("bottom", "2") + ", " + field("top", "0") + ", " + field("height", "5") + with_axis),
              value_of(make_nurbs_cone(axis, 2, 0, 5)));
  Random random(4);
  const Curve profile = random_curve(random, 3, {}, true);
  expect_same(read("revolution", field("profile", json(profile)) + with_axis),
              value_of(make_surface_of_revolution(profile, axis)));
}

TEST(JsonModel, HermitePatchesInEveryForm) {
  Random random(5);
  for (int k = 0; k < 10; ++k) {
    const HermitePatch patch = random_hermite(random, random_domain(random));
    const std::string domain = ", " + field("domain", json(patch.domain()));
    const auto net = [](const HermitePatch::Grid& grid) { return json_net(std::span<const Vec3>(grid), 4); };
    expect_same(read_as<HermitePatch>("hermite", field("geometry", net(patch.geometry())) + domain), patch);
    expect_same(read_as<HermitePatch>("hermite", field("geometry", net(patch.geometry(HermiteOrder::by_kind))) + ", " +
                                                     field("order", "\"by_kind\"") + domain),
                patch);
    std::string corners, open;
    HermitePatch::OpenCorners tangents;
    for (int c = 0; c < 4; ++c) {
      const HermiteNode node = patch.corner(c / 2, c % 2);
      tangents[static_cast<std::size_t>(c)] = {node.position, node.du, node.dv};
      const std::string before = c == 0 ? "[[" : c == 2 ? "], [" : ", ";
      corners += before + json(node);
      std::string text = json(node);
      open += before + text.substr(0, text.find(", \"duv\"")) + "}";
    }
    expect_same(read_as<HermitePatch>("hermite", field("corners", corners + "]]") + domain), patch);
    expect_same(read_as<HermitePatch>("ferguson", field("corners", open + "]]") + domain),
                value_of(HermitePatch::ferguson(tangents, patch.domain())));
    expect_same(read_as<HermitePatch>("adini", field("corners", open + "]]") + domain),
                value_of(HermitePatch::adini(tangents, patch.domain())));

    const HermitePatch::Grid grid = random_grid(random);
    expect_same(read_as<HermitePatch>("algebraic", field("coefficients", net(grid)) + domain),
                value_of(HermitePatch::from_algebraic(grid, patch.domain())));
    const std::vector<double> u = random_knots(random, 4), v = random_knots(random, 4);
    expect_same(read_as<HermitePatch>("through_points", field("points", net(grid)) + ", " + field("u", json(u)) + ", " +
                                                            field("v", json(v)) + domain),
                value_of(HermitePatch::through_points(grid, u, v, patch.domain())));
  }
}

TEST(JsonModel, HermiteNetworks) {
  Random random(6);
  const auto expect_same_network = [](const HermiteNetwork& a, const HermiteNetwork& b) {
    ASSERT_EQ(a.count_u(), b.count_u());
    ASSERT_EQ(a.count_v(), b.count_v());
    EXPECT_TRUE(std::ranges::equal(a.knots_u(), b.knots_u()));
    EXPECT_TRUE(std::ranges::equal(a.knots_v(), b.knots_v()));
    for (std::size_t i = 0; i < a.count_u(); ++i)
      for (std::size_t j = 0; j < a.count_v(); ++j) EXPECT_EQ(a.node(i, j), b.node(i, j));
  };
  const std::size_t m = 3, n = 4;
  const std::vector<HermiteNode> nodes = random_nodes(random, m, n);
  const std::string net = field("nodes", json_net(std::span<const HermiteNode>(nodes), n));
  const std::vector<double> k = random_factors(random, m - 1), l = random_factors(random, n - 1);
  const std::vector<double> u = random_knots(random, m), v = random_knots(random, n);
  const auto read = [&](const std::string& more) { return read_as<HermiteNetwork>("hermite_network", net + more); };
  expect_same_network(read(", " + field("factors_u", json(k)) + ", " + field("factors_v", json(l))),
                      value_of(HermiteNetwork::from_factors(m, n, nodes, k, l)));
  const std::string knots = ", " + field("knots_u", json(u)) + ", " + field("knots_v", json(v));
  expect_same_network(read(knots), value_of(HermiteNetwork::on_knots(u, v, nodes)));
  for (const auto& [word, estimate] :
       {std::pair{"zero", TwistEstimate::zero}, {"adini", TwistEstimate::adini}, {"bessel", TwistEstimate::bessel}}) {
    const std::vector<HermiteNode> estimated = value_of(estimate_twists(estimate, u, v, nodes));
    expect_same_network(read(knots + ", " + field("twists", "\"" + std::string(word) + "\"")),
                        value_of(HermiteNetwork::on_knots(u, v, estimated)));
  }
  // Unit knots and unit factors are the same network.
  expect_same_network(read(""), value_of(HermiteNetwork::from_factors(m, n, nodes, std::vector<double>(m - 1, 1),
                                                                      std::vector<double>(n - 1, 1))));
}

TEST(JsonModel, ExplicitPolynomials) {
  Random random(7);
  for (const int m : {0, 1, 4, 15})
    for (const int n : {0, 2, 15}) {
      std::vector<double> a(static_cast<std::size_t>((m + 1) * (n + 1)));
      for (double& value : a) value = uniform(random, -1, 1);
      const Domain domain = random_domain(random);
      const auto read = read_as<ExplicitPolynomial>(
          "explicit_polynomial",
          field("coefficients", json_net(std::span<const double>(a), static_cast<std::size_t>(n + 1))) + ", " +
              field("domain", json(domain)));
      EXPECT_EQ(read.degree_x(), m);
      EXPECT_EQ(read.degree_y(), n);
      EXPECT_EQ(read.rectangle(), domain);
      for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n; ++j) EXPECT_EQ(read.coefficient(i, j), a[static_cast<std::size_t>(i * (n + 1) + j)]);
    }
}

TEST(JsonModel, QuadricsOfEveryKind) {
  Random random(8);
  for (const QuadricSample& sample : quadric_samples()) {
    if (!is_surface(sample.kind)) continue;
    const QuadricCoefficients q = moved(sample.coefficients, random_frame(random, 3));
    const Domain range = sample_range(sample.kind);
    const std::string letters = "abcdefghjk";
    const double values[] = {q.a, q.b, q.c, q.d, q.e, q.f, q.g, q.h, q.j, q.k};
    std::string coefficients;
    for (std::size_t k = 0; k < letters.size(); ++k)
      coefficients += (k == 0 ? "{" : ", ") + field(letters.substr(k, 1), json(values[k]));
    for (int sheet = 0; sheet < sheet_count(sample.kind); ++sheet) {
      const auto read = read_as<QuadricPiece>("quadric", field("coefficients", coefficients + "}") + ", " +
                                                             field("range", json(range)) + ", " +
                                                             field("sheet", std::to_string(sheet)));
      EXPECT_EQ(read.quadric().kind(), sample.kind) << name(sample.kind);
      EXPECT_EQ(read.sheet(), sheet);
      EXPECT_EQ(read.range(), range);
      const QuadricCoefficients& c = read.quadric().coefficients();
      EXPECT_TRUE(std::ranges::equal(std::array{c.a, c.b, c.c, c.d, c.e, c.f, c.g, c.h, c.j, c.k}, values));
    }
  }
}

TEST(JsonModel, RuledSurfaces) {
  Random random(9);
  const Curve first = random_curve(random, 3, {}, false);
  const Interval& on = first.domain();
  const Curve second = value_of(Curve::bezier(random_points(random, 0, 4), random_weights(random, 0, 4, 0.5, 2), on));
  const std::string curves = field("first", json(first)) + ", " + field("second", json(second));
  const auto plain = read_as<RuledSurface>("ruled", curves);
  expect_same(std::get<Curve>(plain.first()), first);
  expect_same(std::get<Curve>(plain.second()), second);
  EXPECT_EQ(plain.domain(), (Domain{on.from, on.to, 0, 1}));
  const auto across =
      read_as<RuledSurface>("ruled", curves + ", " + field("across", "[2, 3.5]") + ", " + field("straight", "\"u\""));
  EXPECT_EQ(across.straight(), Direction::u);
  EXPECT_EQ(across.domain(), (Domain{2, 3.5, on.from, on.to}));
}

TEST(JsonModel, CurvesOfEveryKind) {
  const std::string arc = R"({"kind": "bezier", "points": [[1,0,0],[1,1,0],[0,1,0]], "weights": [1,"sqrt(2)/2",1]})";
  const std::string circle = R"({"kind": "circle", "radius": 2, "arcs": 3, "axis": {"origin": [0, 0, 1]}})";
  const std::string wave = R"j({"kind": "parametric", "x": "t", "y": 2, "z": "sin(pi*t)"})j";
  const std::string ring =
      R"({"kind": "b_spline", "degree": 3, "knots": "periodic", "domain": [1, 2],
          "points": [[1,0,0],[0,1,0],[-1,0,0],[0,-1,0]]})";
  const auto one = read_as<RuledSurface>("ruled", field("first", arc) + ", " + field("second", circle));
  expect_same(std::get<Curve>(one.first()), value_of(Curve::bezier(std::vector<Vec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                                                   std::vector<double>{1, std::sqrt(2.0) / 2, 1})));
  expect_same(std::get<Curve>(one.second()), value_of(make_nurbs_circle({.origin = {0, 0, 1}}, 2, CircleArcs::three)));
  const auto two = read_as<RuledSurface>("ruled", field("first", wave) + ", " + field("second", arc));
  EXPECT_EQ(value_of(position(two.first(), 0.25)), (Vec3{0.25, 2, std::sin(std::acos(-1.0) * 0.25)}));
  const auto three = read_as<RuledSurface>("ruled", field("first", ring) + ", " + field("second", ring));
  EXPECT_EQ(std::get<Curve>(three.first()).points().size(), 7u);
  EXPECT_EQ(three.domain(), (Domain{1, 2, 0, 1}));
}

TEST(JsonModel, CoonsPatches) {
  const std::string borders =
      R"("c1": {"kind": "bezier", "points": [[0,0,0],[1,0,0]]}, "c2": {"kind": "bezier", "points": [[0,1,0],[1,1,2]]},
         "d1": {"kind": "bezier", "points": [[0,0,0],[0,1,0]]}, "d2": {"kind": "bezier", "points": [[1,0,0],[1,1,2]]})";
  const auto height = [&](const std::string& more, double u, double v) {
    return value_of(evaluate_jet(read_as<CoonsPatch>("coons", borders + more), u, v)).position.z;
  };
  const auto h3 = [](double t) { return t * t * (3 - 2 * t); };
  const auto h5 = [](double t) { return t * t * t * (10 - 15 * t + 6 * t * t); };
  // Each direction has its own blend: z = 2u g(v) + 2v f(u) - 2 f(u) g(v).
  const std::string quintic = R"({"coefficients": [[1,0,0,-10,15,-6],[0,0,0,10,-15,6]]})";
  const std::string smooth = R"j({"expressions": ["1-t^2*(3-2*t)", "t^2*(3-2*t)"]})j";
  for (const double u : {0.0, 0.3, 1.0})
    for (const double v : {0.0, 0.25, 0.9}) {
      EXPECT_NEAR(height("", u, v), 2 * u * v, 1e-15);
      EXPECT_NEAR(height(R"(, "f": "cubic")", u, v), 2 * u * v + 2 * v * h3(u) - 2 * h3(u) * v, 1e-15);
      EXPECT_NEAR(height(R"(, "f": "linear", "g": "cubic")", u, v), 2 * u * v, 1e-15);
      EXPECT_NEAR(height(", \"f\": " + quintic + ", \"g\": " + smooth, u, v),
                  2 * u * h3(v) + 2 * v * h5(u) - 2 * h5(u) * h3(v), 1e-14);
    }
}

TEST(JsonModel, ParametricSurfaces) {
  const auto cylinder = read_as<ParametricSurface>(
      "parametric", R"j("x": "cos(u)", "y": "sin(u)", "z": "v", "domain": [[0, "2*pi"], [-1, 1]])j");
  EXPECT_EQ(cylinder.domain(), (Domain{0, 2 * std::acos(-1.0), -1, 1}));
  EXPECT_EQ(value_of(cylinder.position(1.25, -0.5)), (Vec3{std::cos(1.25), std::sin(1.25), -0.5}));
  const auto constant = read_as<ParametricSurface>("parametric", R"("x": "u", "y": "v", "z": 2.5)");
  EXPECT_EQ(value_of(constant.position(0.5, 0.25)), (Vec3{0.5, 0.25, 2.5}));
  const auto half = read_as<ParametricSurface>(
      "parametric", R"j("x": "u", "y": "v", "z": "sqrt(4-(u-1)^2-v^2)", "disc": {"x": 1, "radius": 2})j");
  EXPECT_EQ(half.domain().u1, 2);
  for (const double angle : {0.0, 1.0, 3.0}) {
    const Vec3 p = value_of(half.position(1.5, angle));
    EXPECT_NEAR(length(p - Vec3{1, 0, 0}), 2, 4e-15);
    EXPECT_NEAR(p.x, 1 + 1.5 * std::cos(angle), 4e-15);
    EXPECT_NEAR(value_of(half.position(2, angle)).z, 0, 1e-7);
  }
}

TEST(JsonModel, PlacementsApplyInOrder) {
  const std::string patch = R"("points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]])";
  const auto placement = [&](const std::string& maps) {
    return *parsed(json_with(surface_of("bezier", patch + ", \"placement\": " + maps))).surfaces[0].placement;
  };
  EXPECT_EQ(placement("[]"), Affine{});
  const Vec3 p{1, 2, 3};
  EXPECT_EQ(placement(R"([{"translate": [1, 0, 0]}, {"scale": 2}])").point(p), (Vec3{4, 4, 6}));
  EXPECT_EQ(placement(R"([{"scale": 2}, {"translate": [1, 0, 0]}])").point(p), (Vec3{3, 4, 6}));
  EXPECT_EQ(placement(R"([{"scale": [1, 2, -1]}])").point(p), (Vec3{1, 4, -3}));
  EXPECT_EQ(placement(R"([{"matrix": [[0,1,0,5],[1,0,0,6],[0,0,1,"7"]]}])").point(p), (Vec3{7, 7, 10}));
  const Vec3 turned = placement(R"([{"rotate": {"axis": [0, 0, 2], "angle": "pi/2"}}])").point(p);
  EXPECT_LT(max_abs(turned - Vec3{-2, 1, 3}), 1e-15);
}

TEST(JsonModel, NamesAndPlaceOfTheModel) {
  const std::string patch = R"("points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]])";
  const Model model = parsed("\xEF\xBB\xBF{\"surfaces\": [" + surface_of("bezier", patch + R"(, "name": "a \"b\" é")") +
                             ", " + surface_of("bezier", patch + R"(, "description": "flat")") +
                             "], \"version\": 1.0, \"format\": \"tessera\"}");
  ASSERT_EQ(model.surfaces.size(), 2u);
  EXPECT_EQ(model.surfaces[0].name, "a \"b\" é");
  EXPECT_EQ(model.surfaces[1].name, "");
}

}}  // namespace tessera::test
