#include <algorithm>
#include <string>

#include "surface/spline/hermite_nodes.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The nodes with their knots.
struct Nodes {
  std::span<const double> u, v;
  std::span<const HermiteNode> nodes;

  const HermiteNode& at(std::size_t i, std::size_t j) const { return nodes[i * v.size() + j]; }
  /// Returns (P(i1,j1) - P(i0,j1) - P(i1,j0) + P(i0,j0)) / area.
  Vec3 mixed_difference(std::size_t i0, std::size_t i1, std::size_t j0, std::size_t j1) const {
    const Vec3 high = at(i1, j1).position - at(i0, j1).position, low = at(i1, j0).position - at(i0, j0).position;
    return (1 / (v[j1] - v[j0])) * ((1 / (u[i1] - u[i0])) * (high - low));
  }
};

Vec3 adini_twist(const Nodes& n, std::size_t i, std::size_t j) {
  const std::size_t i0 = i > 0 ? i - 1 : 0, i1 = std::min(i + 1, n.u.size() - 1);
  const std::size_t j0 = j > 0 ? j - 1 : 0, j1 = std::min(j + 1, n.v.size() - 1);
  return (1 / (n.u[i1] - n.u[i0])) * (n.at(i1, j).dv - n.at(i0, j).dv) +
         (1 / (n.v[j1] - n.v[j0])) * (n.at(i, j1).du - n.at(i, j0).du) - n.mixed_difference(i0, i1, j0, j1);
}

/// The two spans whose slopes give the derivative at a node by the parabola through three nodes, and their weights.
struct BesselWeights {
  BesselWeights(std::span<const double> knots, std::size_t i) {
    const std::size_t inner = std::clamp<std::size_t>(i, 1, knots.size() - 2);
    span = inner - 1;
    const double a = (knots[inner] - knots[inner - 1]) / (knots[inner + 1] - knots[inner - 1]);
    const double low = i < inner ? 1 + a : i > inner ? a - 1 : 1 - a;
    weight[0] = low;
    weight[1] = i < inner ? -a : i > inner ? 2 - a : a;
  }
  std::size_t span;  ///< index of the first one
  double weight[2];
};

Vec3 bessel_twist(const Nodes& n, std::size_t i, std::size_t j) {
  const BesselWeights along_u(n.u, i), along_v(n.v, j);
  Vec3 twist;
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t q = 0; q < 2; ++q) {
      const std::size_t a = along_u.span + p, b = along_v.span + q;
      twist += (along_u.weight[p] * along_v.weight[q]) * n.mixed_difference(a, a + 1, b, b + 1);
    }
  return twist;
}

Status check_bessel(std::size_t count, const char* direction) {
  if (count >= 3) return {};
  return {StatusCode::invalid_argument, std::string("Bessel twists need at least three nodes along ") + direction +
                                            ", found " + std::to_string(count)};
}

}  // namespace

Result<std::vector<HermiteNode>> estimate_twists(TwistEstimate estimate, std::span<const double> u,
                                                 std::span<const double> v, std::span<const HermiteNode> nodes) {
  return guarded([&]() -> Result<std::vector<HermiteNode>> {
    if (Status status = check_increasing(u, "knot", "u"); !status.ok()) return status;
    if (Status status = check_increasing(v, "knot", "v"); !status.ok()) return status;
    const bool bessel = estimate == TwistEstimate::bessel;
    if (Status status = bessel ? check_bessel(u.size(), "u") : Status(); !status.ok()) return status;
    if (Status status = bessel ? check_bessel(v.size(), "v") : Status(); !status.ok()) return status;
    std::vector<HermiteNode> result(nodes.begin(), nodes.end());
    for (HermiteNode& node : result) node.duv = {};
    if (Status status = check_nodes(u.size(), v.size(), result); !status.ok()) return status;
    const Nodes n{u, v, nodes};
    for (std::size_t i = 0; i < u.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j) {
        HermiteNode& node = result[i * v.size() + j];
        if (estimate == TwistEstimate::adini) node.duv = adini_twist(n, i, j);
        if (bessel) node.duv = bessel_twist(n, i, j);
      }
    return result;
  });
}

}}  // namespace tessera::abi_0_1
