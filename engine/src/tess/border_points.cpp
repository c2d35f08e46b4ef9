#include "tess/border_points.h"

#include <array>

#include "eval/border_weights.h"

namespace tessera {
namespace {

/// A border's homogeneous control points in the order of the ring.
struct BorderNet {
  int degree = 0;
  bool rational = false;
  std::array<std::array<float, 4>, max_degree + 1> points{};
};

BorderNet border_net(const PatchSet::Impl& set, std::size_t patch, Side side) {
  const PackedBorder border(set, patch, side);
  BorderNet net;
  net.degree = border.count() - 1;
  net.rational = border.components() == 4;
  const bool backward = side == Side::v1 || side == Side::u0;
  for (int k = 0; k <= net.degree; ++k)
    for (int c = 0; c < border.components(); ++c)
      net.points[static_cast<std::size_t>(k)][static_cast<std::size_t>(c)] = border.value(backward ? net.degree - k : k, c);
  return net;
}

float symmetric_sum(const BorderNet& net, std::size_t component, const float* weights) {
  const auto term = [&](int i) { return weights[i] * net.points[static_cast<std::size_t>(i)][component]; };
  const int n = net.degree;
  float sum = term(0) + term(n);
  for (int i = 1; 2 * i < n; ++i) sum = sum + (term(i) + term(n - i));
  return n % 2 == 0 ? sum + term(n / 2) : sum;
}

/// The first control point as packed: w p / w would depend on the weight.
std::array<float, 3> corner(const PatchSet::Impl& set, std::size_t patch, Side side) {
  const BezierPatch& net = set.patches[patch];
  const bool end_u = side == Side::u1 || side == Side::v1, end_v = side == Side::v1 || side == Side::u0;
  const Vec3 p = net.point(end_u ? net.degree_u() : 0, end_v ? net.degree_v() : 0) - set.origin + Vec3{};
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

}  // namespace

void BorderWeights::add(int degree, int rate) {
  auto& table = tables_[{degree, rate}];
  if (table.empty()) table = symmetric_weights(degree, rate);
}

void write_border(const PatchSet::Impl& set, std::size_t patch, Side side, int rate, const BorderWeights& weights,
                  const View3<float>& out, std::size_t first) {
  const auto put = [&](int k, const std::array<float, 3>& point) {
    for (int c = 0; c < 3; ++c) out.at(first + static_cast<std::size_t>(k), c) = point[static_cast<std::size_t>(c)];
  };
  const std::array<float, 3> start = corner(set, patch, side);
  put(0, start);
  if (set.collapsed[patch].has(edge_of(side))) {
    for (int k = 1; k < rate; ++k) put(k, start);
    return;
  }
  const BorderNet net = border_net(set, patch, side);
  const float* table = weights.of(net.degree, rate);
  for (int k = 1; k < rate; ++k) {
    const float* row = table + std::ptrdiff_t{k} * (net.degree + 1);
    std::array<float, 3> point{};
    for (std::size_t c = 0; c < 3; ++c) point[c] = symmetric_sum(net, c, row);
    if (net.rational) {
      const float reciprocal = 1 / symmetric_sum(net, 3, row);
      for (float& x : point) x = x * reciprocal;
    }
    put(k, point);
  }
}

}  // namespace tessera
