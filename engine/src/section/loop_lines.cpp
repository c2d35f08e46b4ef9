#include "section/loop_lines.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/impl_access.h"
#include "basis/bernstein_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using Net = BernsteinNet<double>;

/// The Bernstein polynomials C(m,i) a^i b^(m-i) of a curve's coordinates a and b, which have a common weight.
std::vector<Net> composed_basis(const Net& a, const Net& b, int degree) {
  std::vector<Net> rising{bernstein_one(0, 0)}, falling{bernstein_one(0, 0)}, basis;
  for (int k = 0; k < degree; ++k) {
    rising.push_back(a * rising.back());
    falling.push_back(b * falling.back());
  }
  for (int i = 0; i <= degree; ++i) {
    basis.push_back(rising[static_cast<std::size_t>(i)] * falling[static_cast<std::size_t>(degree - i)]);
    for (double& value : basis.back().values) value *= binomial(degree, i);
  }
  return basis;
}

void add(Net& sum, const Net& net, double factor) {
  for (std::size_t k = 0; k < sum.values.size(); ++k) sum.values[k] += factor * net.values[k];
}

}  // namespace

std::pair<std::vector<double>, std::vector<double>> heights_along(const BezierPatch& patch, const Domain& domain,
                                                                  const PlaneBezier& curve, const Levels& levels) {
  const int degree = curve.degree(), m = patch.degree_u(), n = patch.degree_v();
  Net u(degree, 0), v(degree, 0), u_rest(degree, 0), v_rest(degree, 0);
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const double weight = curve.weight(k);
    u.values[k] = weight * std::clamp(domain.local_u(curve.points[k].u), 0.0, 1.0);
    v.values[k] = weight * std::clamp(domain.local_v(curve.points[k].v), 0.0, 1.0);
    u_rest.values[k] = weight - u.values[k];
    v_rest.values[k] = weight - v.values[k];
  }
  const std::vector<Net> basis_u = composed_basis(u, u_rest, m), basis_v = composed_basis(v, v_rest, n);
  Net heights(degree * (m + n), 0), weights(degree * (m + n), 0);
  const bool is_rational = patch.is_rational() || !curve.weights.empty();
  for (int i = 0; i <= m; ++i) {
    Net row(degree * n, 0), row_weights(degree * n, 0);
    for (int j = 0; j <= n; ++j) {
      add(row, basis_v[static_cast<std::size_t>(j)], patch.weight(i, j) * levels.height(patch.point(i, j)));
      if (is_rational) add(row_weights, basis_v[static_cast<std::size_t>(j)], patch.weight(i, j));
    }
    add(heights, basis_u[static_cast<std::size_t>(i)] * row, 1);
    if (is_rational) add(weights, basis_u[static_cast<std::size_t>(i)] * row_weights, 1);
  }
  if (!is_rational) weights.values.clear();
  return {std::move(heights.values), std::move(weights.values)};
}

LoopLines::LoopLines(const BezierPatch& patch, const Domain& domain, const TrimRegion& region,
                     std::span<const std::uint32_t> pieces, const Levels& levels, LoopVertices& vertices)
    : region_(&region), domain_(domain), pieces_(pieces.begin(), pieces.end()) {
  const std::vector<TrimPiece>& all = impl_of(region).pieces;
  lines_.reserve(pieces.size());
  for (const std::uint32_t k : pieces) {
    const TrimPiece& piece = all[k];
    auto [weighted, weights] = heights_along(patch, domain, piece.curve, levels);
    HeightLine& line = lines_.emplace_back(std::move(weighted), std::move(weights));
    line.divide(levels);
    line.set_ends(vertices.height(piece.start(), line.heights().front()),
                  vertices.height(piece.end(), line.heights().back()));
    is_proven_ = is_proven_ && !line.is_shallow();
  }
}

bool LoopLines::find(const Level& level, double contact, std::vector<LoopHit>& hits) const {
  bool touches = false;
  hits.clear();
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const std::span<const double> heights = lines_[k].heights();
    touches = touches || std::abs(heights.front() - level.at) <= contact;
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      touches = touches || std::abs(heights[i + 1] - level.at) <= contact;
      if (level.is_above(heights[i]) == level.is_above(heights[i + 1])) continue;
      const PlaneBezier& curve = impl_of(*region_).pieces[pieces_[k]].curve;
      LoopHit hit{.piece = pieces_[k], .interval = static_cast<std::uint32_t>(i)};
      hit.place = lines_[k].root(i, level.at);
      const ParameterPoint at = hit.place == 1
                                    ? curve.points.back()
                                    : curve.points.front() + relative_point(curve, curve.points.front(), hit.place);
      hit.at = {std::clamp(domain_.local_u(at.u), 0.0, 1.0), std::clamp(domain_.local_v(at.v), 0.0, 1.0)};
      hits.push_back(hit);
    }
  }
  return touches;
}

}}  // namespace tessera::abi_0_1
