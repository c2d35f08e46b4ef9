// Networks of Hermite patches: joins along whole edges, twists, degrees of freedom, and errors.

#include "support/errors.h"
#include "support/random_hermite.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

HermiteNetwork random_network(Random& random, std::size_t count_u, std::size_t count_v) {
  return value_of(HermiteNetwork::from_factors(count_u, count_v, random_nodes(random, count_u, count_v),
                                               random_factors(random, count_u - 1),
                                               random_factors(random, count_v - 1)));
}

/// The angle in radians between the normals of two jets.
double normal_angle(const SurfaceJet& a, const SurfaceJet& b) {
  const Vec3 m = normalized(cross(a.du, a.dv)), n = normalized(cross(b.du, b.dv));
  return std::atan2(length(cross(m, n)), dot(m, n));
}

TEST(HermiteNetwork, NeighboursAreG1AlongWholeEdges) {
  Random random(1);
  const HermiteNetwork network = random_network(random, 4, 5);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (int k = 0; k <= 32; ++k) {
        const double t = k / 32.0;
        if (i > 0) {
          const SurfaceJet p = evaluate_jet(value_of(network.patch(i - 1, j)), 1, t),
                           q = evaluate_jet(value_of(network.patch(i, j)), 0, t);
          EXPECT_TRUE(within_units(q.position, p.position, 4 * double_unit, 2));
          EXPECT_TRUE(within_units(q.du, network.factors_u()[i] * p.du, 4 * double_unit, 4));
          EXPECT_LT(normal_angle(p, q), 1e-14);
        }
        if (j > 0) {
          const SurfaceJet p = evaluate_jet(value_of(network.patch(i, j - 1)), t, 1),
                           q = evaluate_jet(value_of(network.patch(i, j)), t, 0);
          EXPECT_TRUE(within_units(q.position, p.position, 4 * double_unit, 2));
          EXPECT_TRUE(within_units(q.dv, network.factors_v()[j] * p.dv, 4 * double_unit, 4));
          EXPECT_LT(normal_angle(p, q), 1e-14);
        }
      }
}

TEST(HermiteNetwork, IsC1ByItsOwnParameters) {
  Random random(2);
  const HermiteNetwork network = random_network(random, 4, 5);
  const auto u = network.knots_u(), v = network.knots_v();
  EXPECT_EQ(network.domain(), (Domain{0, u.back(), 0, v.back()}));
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_NEAR((u[i + 1] - u[i]) / (u[i] - u[i - 1]), network.factors_u()[i], 16 * double_unit);
    for (double t = 0.1; t < v.back(); t += 0.3) {
      const SurfaceJet right = evaluate_jet(network, u[i], t), left = evaluate_jet(network, std::nextafter(u[i], 0), t);
      EXPECT_LT(max_abs(right.position - left.position), 1e-14);
      EXPECT_LT(max_abs(right.du - left.du), 1e-13);
      EXPECT_LT(max_abs(right.dv - left.dv), 1e-13);
      EXPECT_LT(max_abs(right.duv - left.duv), 1e-12);
    }
  }
}

TEST(HermiteNetwork, OnKnotsHasTheGivenDerivatives) {
  Random random(3);
  const std::vector<double> u = random_knots(random, 4, -3), v = random_knots(random, 3, 7);
  const std::vector<HermiteNode> nodes = random_nodes(random, 4, 3);
  const HermiteNetwork network = value_of(HermiteNetwork::on_knots(u, v, nodes));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const SurfaceJet jet = evaluate_jet(network, u[i], v[j]);
      const HermiteNode& node = nodes[i * 3 + j];
      EXPECT_EQ(jet.position, node.position);
      EXPECT_TRUE(within_units(jet.du, node.du, double_unit, 8));
      EXPECT_TRUE(within_units(jet.dv, node.dv, double_unit, 8));
      EXPECT_TRUE(within_units(jet.duv, node.duv, double_unit, 16));
    }
  // A network equal to it, by factors, with A = h_{i-1} R_u.
  const double h0 = u[1] - u[0];
  EXPECT_TRUE(within_units(network.node(0, 1).du, h0 * nodes[1].du, double_unit, 2));
  EXPECT_TRUE(within_units(network.node(1, 1).du, h0 * nodes[4].du, double_unit, 2));
  EXPECT_TRUE(within_units(network.node(2, 1).du, (u[2] - u[1]) * nodes[7].du, double_unit, 2));
}

TEST(HermiteNetwork, ReproducesBicubics) {
  // z = u^3 v^2 - 2 u v^3 + u^2: its own derivatives at any knots.
  const auto node = [](double u, double v) {
    return HermiteNode{{u, v, u * u * u * v * v - 2 * u * v * v * v + u * u},
                       {1, 0, 3 * u * u * v * v - 2 * v * v * v + 2 * u},
                       {0, 1, 2 * u * u * u * v - 6 * u * v * v},
                       {0, 0, 6 * u * u * v - 6 * v * v}};
  };
  const std::vector<double> u{-1, 0.25, 0.75, 2}, v{0, 0.5, 1.75};
  std::vector<HermiteNode> nodes;
  for (const double a : u)
    for (const double b : v) nodes.push_back(node(a, b));
  const HermiteNetwork network = value_of(HermiteNetwork::on_knots(u, v, nodes));
  for (double a = -1; a <= 2; a += 0.1)
    for (double b = 0; b <= 1.75; b += 0.1) {
      const SurfaceJet jet = evaluate_jet(network, a, b);
      EXPECT_LT(max_abs(jet.position - node(a, b).position), 1e-13);
      EXPECT_LT(max_abs(jet.duv - node(a, b).duv), 1e-12);
    }
}

TEST(HermiteNetwork, MovingANodeChangesItsFourPatches) {
  Random random(4);
  std::vector<HermiteNode> nodes = random_nodes(random, 5, 5);
  const std::vector<double> factors = random_factors(random, 4);
  const HermiteNetwork before = value_of(HermiteNetwork::from_factors(5, 5, nodes, factors, factors));
  nodes[2 * 5 + 2].position += {0, 0, 1};
  const HermiteNetwork after = value_of(HermiteNetwork::from_factors(5, 5, nodes, factors, factors));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const bool touched = (i == 1 || i == 2) && (j == 1 || j == 2);
      EXPECT_EQ(value_of(before.patch(i, j)).geometry() != value_of(after.patch(i, j)).geometry(), touched)
          << i << " " << j;
    }
}

// Degrees of freedom: the rank of the derivative of all patches' 48 numbers by the network's own, at a random place.

std::vector<double> numbers_of(const HermiteNetwork& network) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i + 1 < network.count_u(); ++i)
    for (std::size_t j = 0; j + 1 < network.count_v(); ++j) {
      const HermitePatch patch = value_of(network.patch(i, j));
      for (const Vec3& p : patch.geometry()) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    }
  return numbers;
}

std::size_t rank(std::vector<std::vector<double>> rows) {
  std::size_t found = 0;
  for (std::size_t column = 0; column < rows[0].size() && found < rows.size(); ++column) {
    const auto larger = [&](const auto& a, const auto& b) { return std::abs(a[column]) < std::abs(b[column]); };
    const auto pivot = std::max_element(rows.begin() + static_cast<std::ptrdiff_t>(found), rows.end(), larger);
    if (std::abs((*pivot)[column]) < 1e-4) continue;
    std::swap(*pivot, rows[found]);
    for (std::size_t i = found + 1; i < rows.size(); ++i) {
      const double factor = rows[i][column] / rows[found][column];
      for (std::size_t k = column; k < rows[i].size(); ++k) rows[i][k] -= factor * rows[found][k];
    }
    ++found;
  }
  return found;
}

std::size_t degrees_of_freedom(std::size_t count_u, std::size_t count_v) {
  Random random(5);
  const std::vector<HermiteNode> nodes = random_nodes(random, count_u, count_v);
  const std::vector<double> k = random_factors(random, count_u - 1), l = random_factors(random, count_v - 1);
  std::vector<std::vector<double>> rows;
  const double step = 1e-6;
  const auto differentiate = [&](const auto& change) {
    std::vector<double> row;
    for (const double sign : {-1.0, 1.0}) {
      std::vector<HermiteNode> n = nodes;
      std::vector<double> a = k, b = l;
      change(n, a, b, sign * step);
      const std::vector<double> numbers = numbers_of(value_of(HermiteNetwork::from_factors(count_u, count_v, n, a, b)));
      row.resize(numbers.size());
      for (std::size_t i = 0; i < row.size(); ++i) row[i] += sign * numbers[i] / (2 * step);
    }
    rows.push_back(row);
  };
  for (std::size_t node = 0; node < nodes.size(); ++node)
    for (Vec3 HermiteNode::*vector : {&HermiteNode::position, &HermiteNode::du, &HermiteNode::dv, &HermiteNode::duv})
      for (double Vec3::*component : {&Vec3::x, &Vec3::y, &Vec3::z})
        differentiate([&](auto& n, auto&, auto&, double by) { n[node].*vector.*component += by; });
  for (std::size_t i = 1; i < k.size(); ++i) differentiate([&](auto&, auto& a, auto&, double by) { a[i] += by; });
  for (std::size_t j = 1; j < l.size(); ++j) differentiate([&](auto&, auto&, auto& b, double by) { b[j] += by; });
  return rank(rows);
}

TEST(HermiteNetwork, DegreesOfFreedom) {
  EXPECT_EQ(degrees_of_freedom(2, 2), 48u);
  EXPECT_EQ(degrees_of_freedom(3, 2), 73u);
  EXPECT_EQ(degrees_of_freedom(3, 3), 110u);
}

TEST(HermiteTwists, AdiniKeepsG1AndIsExactForBilinearPlusSums) {
  Random random(6);
  const std::vector<double> u = random_knots(random, 4), v = random_knots(random, 5);
  const std::vector<HermiteNode> guessed =
      value_of(estimate_twists(TwistEstimate::adini, u, v, random_nodes(random, 4, 5)));
  const HermiteNetwork network = value_of(HermiteNetwork::on_knots(u, v, guessed));
  for (std::size_t i = 1; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (int k = 0; k <= 16; ++k)
        EXPECT_LT(normal_angle(evaluate_jet(value_of(network.patch(i - 1, j)), 1, k / 16.0),
                               evaluate_jet(value_of(network.patch(i, j)), 0, k / 16.0)),
                  1e-13);

  std::vector<HermiteNode> nodes;  // z = 5 u v + u^3 - v^2
  for (const double a : u)
    for (const double b : v)
      nodes.push_back(
          {{a, b, 5 * a * b + a * a * a - b * b}, {1, 0, 5 * b + 3 * a * a}, {0, 1, 5 * a - 2 * b}, {7, 7, 7}});
  for (const HermiteNode& node : value_of(estimate_twists(TwistEstimate::adini, u, v, nodes)))
    EXPECT_LT(max_abs(node.duv - Vec3{0, 0, 5}), 1e-12);
}

TEST(HermiteTwists, AdiniIsTheFormulaAtAnInnerNodeAndAtACorner) {
  Random random(7);
  const std::vector<double> u = random_knots(random, 3), v = random_knots(random, 3);
  const std::vector<HermiteNode> n = random_nodes(random, 3, 3);
  const auto result = value_of(estimate_twists(TwistEstimate::adini, u, v, n));
  const double du = u[2] - u[0], dv = v[2] - v[0];
  const Vec3 inner = (1 / du) * (n[7].dv - n[1].dv) + (1 / dv) * (n[5].du - n[3].du) -
                     (1 / (du * dv)) * (n[8].position - n[2].position - n[6].position + n[0].position);
  EXPECT_LT(max_abs(result[4].duv - inner), 1e-13);
  // At a corner, indices clamped: the single patch's estimate there.
  const Domain d{u[0], u[1], v[0], v[1]};
  const auto open = [&](std::size_t k) { return CornerTangents{n[k].position, n[k].du, n[k].dv}; };
  const HermitePatch patch = value_of(HermitePatch::adini({open(0), open(1), open(3), open(4)}, d));
  EXPECT_LT(max_abs(result[0].duv - patch.corner(0, 0).duv), 1e-13);
}

TEST(HermiteTwists, BesselIsExactForBiquadraticsAtEveryNode) {
  Random random(8);
  for (const auto& [nu, nv] : {std::pair<std::size_t, std::size_t>{3, 3}, {5, 4}, {3, 6}}) {
    const std::vector<double> u = random_knots(random, nu, -1), v = random_knots(random, nv, 2);
    std::vector<HermiteNode> nodes;  // z = u^2 v^2 - 3 u^2 v + u v + v^2
    for (const double a : u)
      for (const double b : v) nodes.push_back({{a, b, a * a * b * b - 3 * a * a * b + a * b + b * b}, {}, {}, {}});
    const auto result = value_of(estimate_twists(TwistEstimate::bessel, u, v, nodes));
    for (std::size_t i = 0; i < nu; ++i)
      for (std::size_t j = 0; j < nv; ++j)
        EXPECT_LT(max_abs(result[i * nv + j].duv - Vec3{0, 0, 4 * u[i] * v[j] - 6 * u[i] + 1}), 1e-10) << i << " " << j;
  }
}

TEST(HermiteTwists, ZeroIsFergusonsAndTheRestIsKept) {
  Random random(9);
  const std::vector<double> knots{0, 1, 2};
  const std::vector<HermiteNode> nodes = random_nodes(random, 3, 3);
  for (const TwistEstimate estimate : {TwistEstimate::zero, TwistEstimate::adini, TwistEstimate::bessel}) {
    const auto result = value_of(estimate_twists(estimate, knots, knots, nodes));
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_EQ(result[k].position, nodes[k].position);
      EXPECT_EQ(result[k].du, nodes[k].du);
      EXPECT_EQ(result[k].dv, nodes[k].dv);
      EXPECT_EQ(result[k].duv == Vec3{}, estimate == TwistEstimate::zero);
    }
  }
}

TEST(HermiteNetwork, RefusesWrongShapes) {
  Random random(10);
  const std::vector<HermiteNode> nodes = random_nodes(random, 3, 2);
  const std::vector<double> k{1, 2}, l{1};
  EXPECT_TRUE(HermiteNetwork::from_factors(3, 2, nodes, k, l).ok());
  expect_refused(HermiteNetwork::from_factors(2, 2, nodes, k, l), StatusCode::count_mismatch, -1,
                 "the network has 2 x 2 nodes, found 6");
  expect_refused(HermiteNetwork::from_factors(6, 1, nodes, k, l), StatusCode::invalid_argument, -1,
                 "a network has at least 2 x 2 nodes, not 6 x 1 nodes");
  expect_refused(HermiteNetwork::from_factors(0, 0, {}, {}, {}), StatusCode::invalid_argument, -1, "0 x 0");
  const std::size_t most = std::numeric_limits<std::size_t>::max();
  expect_refused(HermiteNetwork::from_factors(most, most, nodes, k, l), StatusCode::count_mismatch, -1, "found 6");
  expect_refused(HermiteNetwork::from_factors(3, 2, nodes, l, l), StatusCode::count_mismatch, -1,
                 "a network with 3 nodes along a direction has 2 factors k, found 1");
  expect_refused(HermiteNetwork::from_factors(3, 2, nodes, k, k), StatusCode::count_mismatch, -1,
                 "1 factor l, found 2");
}

TEST(HermiteNetwork, RefusesBadFactorsAndNodes) {
  Random random(11);
  std::vector<HermiteNode> nodes = random_nodes(random, 3, 2);
  const std::vector<double> l{1};
  const auto with = [&](std::vector<double> k) { return HermiteNetwork::from_factors(3, 2, nodes, k, l); };
  expect_refused(with({1, 0}), StatusCode::invalid_argument, 1, "factor k[1] is 0, it must be greater than 0");
  expect_refused(with({1, -2}), StatusCode::invalid_argument, 1, "factor k[1] is -2");
  expect_refused(with({1, infinity}), StatusCode::non_finite, 1, "factor k[1] is inf, it must be finite");
  expect_refused(with({not_a_number, 1}), StatusCode::non_finite, 0, "factor k[0] is nan");
  expect_refused(with({2, 1}), StatusCode::invalid_argument, 0, "factor k[0] is 2, it must be 1");
  expect_refused(with({1, 1e-30}), StatusCode::invalid_argument, 1, "factor k[1] = 1e-30 makes the spacing 1e-30");
  nodes[2].duv.y = not_a_number;
  expect_refused(with({1, 1}), StatusCode::non_finite, 2, "node [1][0] has a vector that is not finite");
  nodes[2].duv.y = 0;
  nodes[3].du.x = 1e308;
  expect_refused(with({1, 10}), StatusCode::non_finite, 1, "patch [1][0]: geometry element");
}

TEST(HermiteNetwork, RefusesBadKnots) {
  Random random(12);
  const std::vector<HermiteNode> nodes = random_nodes(random, 3, 2);
  const std::vector<double> u{0, 1, 2}, v{0, 1};
  const auto expect_bad = [&](const std::vector<double>& a, const std::vector<double>& b, StatusCode code,
                              std::ptrdiff_t index, const std::string& words) {
    expect_refused(HermiteNetwork::on_knots(a, b, nodes), code, index, words);
    expect_refused(estimate_twists(TwistEstimate::adini, a, b, nodes), code, index, words);
  };
  expect_bad({0, 1, 1}, v, StatusCode::invalid_argument, 2, "knot u[2] = 1 is not above the one before it");
  expect_bad(u, {0, not_a_number}, StatusCode::non_finite, 1, "knot v[1] = nan is not finite");
  expect_bad(u, {3}, StatusCode::invalid_argument, -1, "at least two knots are needed along v, found 1");
  expect_bad(u, u, StatusCode::count_mismatch, -1, "the network has 3 x 3 nodes, found 6");
  expect_refused(estimate_twists(TwistEstimate::bessel, u, v, nodes), StatusCode::invalid_argument, -1,
                 "Bessel twists need at least three nodes along v, found 2");
}

}}  // namespace tessera::test
