#include "tessera/hermite_patch.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"
#include "surface/net/validate.h"
#include "surface/spline/hermite_nodes.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Checks that there is one positive factor per span, the first 1.
Status check_factors(std::span<const double> factors, std::size_t spans, const std::string& name) {
  if (factors.size() != spans)
    return {StatusCode::count_mismatch, "a network with " + std::to_string(spans + 1) +
                                            " nodes along a direction has " + counted(spans, "factor") + " " + name +
                                            ", found " + std::to_string(factors.size())};
  for (std::size_t i = 0; i < spans; ++i) {
    const auto bad = [&](StatusCode code, const char* wanted) {
      return Status(code, "factor " + name + "[" + std::to_string(i) + "] is " + text(factors[i]) + wanted,
                    static_cast<std::ptrdiff_t>(i));
    };
    if (!std::isfinite(factors[i])) return bad(StatusCode::non_finite, ", it must be finite");
    if (!(factors[i] > 0)) return bad(StatusCode::invalid_argument, ", it must be greater than 0");
    if (i == 0 && factors[i] != 1) return bad(StatusCode::invalid_argument, ", it must be 1");
  }
  return {};
}

/// Returns the knots 0, 1, .. with the spacings h_i = k_i h_{i-1}. Errors: a spacing that rounding loses beside the
/// knots before it.
Result<std::vector<double>> knots_of(std::span<const double> factors, const std::string& name) {
  std::vector<double> knots{0};
  double spacing = 1;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    spacing *= factors[i];
    const double next = knots.back() + spacing;
    if (!std::isfinite(next) || !(next > knots.back()))
      return Status(StatusCode::invalid_argument,
                    "factor " + name + "[" + std::to_string(i) + "] = " + text(factors[i]) + " makes the spacing " +
                        text(spacing) + ", too far from those before it",
                    static_cast<std::ptrdiff_t>(i));
    knots.push_back(next);
  }
  return knots;
}

std::vector<double> factors_of(std::span<const double> knots) {
  std::vector<double> factors{1};
  for (std::size_t i = 1; i + 1 < knots.size(); ++i)
    factors.push_back((knots[i + 1] - knots[i]) / (knots[i] - knots[i - 1]));
  return factors;
}

/// Returns h_{i-1}, and h_0 at the first knot.
double spacing_before(std::span<const double> knots, std::size_t i) {
  const std::size_t end = std::max<std::size_t>(i, 1);
  return knots[end] - knots[end - 1];
}

/// Returns the span that holds t: at a knot the one on its right, outside the first or last one.
std::size_t span_at(std::span<const double> knots, double t) {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, t);
  return static_cast<std::size_t>(above - knots.begin()) - 1;
}

}  // namespace

HermiteNetwork::HermiteNetwork(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Status check_nodes(std::size_t count_u, std::size_t count_v, std::span<const HermiteNode> nodes) {
  const std::string shape = std::to_string(count_u) + " x " + std::to_string(count_v) + " nodes";
  if (count_u < 2 || count_v < 2)
    return {StatusCode::invalid_argument, "a network has at least 2 x 2 nodes, not " + shape};
  if (nodes.size() / count_u != count_v || nodes.size() % count_u != 0)  // division: a product could overflow
    return {StatusCode::count_mismatch, "the network has " + shape + ", found " + std::to_string(nodes.size())};
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (!is_finite(nodes[k].position) || !is_finite(nodes[k].du) || !is_finite(nodes[k].dv) || !is_finite(nodes[k].duv))
      return {StatusCode::non_finite, "node " + place_in_rows(k, count_v) + " has a vector that is not finite",
              static_cast<std::ptrdiff_t>(k)};
  return {};
}

Result<HermiteNetwork> HermiteNetwork::checked(HermiteNetwork network) {
  for (std::size_t i = 0; i + 1 < network.count_u(); ++i)
    for (std::size_t j = 0; j + 1 < network.count_v(); ++j)
      if (auto patch = HermitePatch::from_corners(network.patch_corners(i, j)); !patch)
        return Status(patch.status().code(),
                      "patch [" + std::to_string(i) + "][" + std::to_string(j) + "]: " + patch.status().message(),
                      static_cast<std::ptrdiff_t>(i * (network.count_v() - 1) + j));
  return network;
}

Result<HermiteNetwork> HermiteNetwork::from_factors(std::size_t count_u, std::size_t count_v,
                                                    std::span<const HermiteNode> nodes, std::span<const double> k,
                                                    std::span<const double> l) {
  return guarded([&]() -> Result<HermiteNetwork> {
    if (Status status = check_nodes(count_u, count_v, nodes); !status.ok()) return status;
    if (Status status = check_factors(k, count_u - 1, "k"); !status.ok()) return status;
    if (Status status = check_factors(l, count_v - 1, "l"); !status.ok()) return status;
    auto knots_u = knots_of(k, "k"), knots_v = knots_of(l, "l");
    if (!knots_u) return knots_u.status();
    if (!knots_v) return knots_v.status();
    Data network;
    network.nodes.assign(nodes.begin(), nodes.end());
    network.k.assign(k.begin(), k.end());
    network.l.assign(l.begin(), l.end());
    network.knots_u = *std::move(knots_u);
    network.knots_v = *std::move(knots_v);
    return checked(HermiteNetwork(std::move(network)));
  });
}

Result<HermiteNetwork> HermiteNetwork::on_knots(std::span<const double> u, std::span<const double> v,
                                                std::span<const HermiteNode> nodes) {
  return guarded([&]() -> Result<HermiteNetwork> {
    if (Status status = check_increasing(u, "knot", "u"); !status.ok()) return status;
    if (Status status = check_increasing(v, "knot", "v"); !status.ok()) return status;
    if (Status status = check_nodes(u.size(), v.size(), nodes); !status.ok()) return status;
    Data network;
    network.knots_u.assign(u.begin(), u.end());
    network.knots_v.assign(v.begin(), v.end());
    network.k = factors_of(u);
    network.l = factors_of(v);
    for (std::size_t i = 0; i < u.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j) {
        const HermiteNode& node = nodes[i * v.size() + j];
        const double h = spacing_before(u, i), g = spacing_before(v, j);
        network.nodes.push_back({node.position, h * node.du, g * node.dv, (h * g) * node.duv});
      }
    return checked(HermiteNetwork(std::move(network)));
  });
}

HermitePatch::Corners HermiteNetwork::patch_corners(std::size_t i, std::size_t j) const {
  HermitePatch::Corners corners;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const HermiteNode& n = node(i + a, j + b);
      const double k = a == 0 ? data_->k[i] : 1, l = b == 0 ? data_->l[j] : 1;
      corners[2 * a + b] = {n.position, k * n.du, l * n.dv, (k * l) * n.duv};
    }
  return corners;
}

Result<HermitePatch> HermiteNetwork::patch(std::size_t i, std::size_t j) const {
  return HermitePatch::from_corners(patch_corners(i, j));
}

SurfaceJet evaluate_jet(const HermiteNetwork& network, double u, double v) {
  const auto knots_u = network.knots_u(), knots_v = network.knots_v();
  const std::size_t i = span_at(knots_u, u), j = span_at(knots_v, v);
  const Domain d{knots_u[i], knots_u[i + 1], knots_v[j], knots_v[j + 1]};
  const SurfaceJet jet = hermite_jet(geometry_of(network.patch_corners(i, j)), d.local_u(u), d.local_v(v));
  const double a = 1 / (d.u1 - d.u0), b = 1 / (d.v1 - d.v0);  // chain rule
  return {jet.position, a * jet.du, b * jet.dv, (a * a) * jet.duu, (a * b) * jet.duv, (b * b) * jet.dvv};
}

}}  // namespace tessera::abi_0_1
