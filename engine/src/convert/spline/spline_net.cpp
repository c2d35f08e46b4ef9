#include "convert/spline/spline_net.h"

#include <algorithm>
#include <array>

#include "basis/knots.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Writes sum_j factors[j] rows[j] of each curve. For rational curves the factors include the weights, normalized, so
/// that the points stay in the hull.
void combine(const SplineNet& net, std::size_t first, std::size_t count, const double* factors, NetPoint* out) {
  for (std::size_t c = 0; c < net.width; ++c) {
    const NetPoint* from = &net.points[first * net.width + c];
    NetPoint sum{{}, 1};
    if (net.rational) {
      sum.weight = 0;
      for (std::size_t j = 0; j < count; ++j) sum.weight += factors[j] * from[j * net.width].weight;
    }
    for (std::size_t j = 0; j < count; ++j) {
      const NetPoint& p = from[j * net.width];
      sum.point += (net.rational ? factors[j] * p.weight / sum.weight : factors[j]) * p.point;
    }
    out[c] = sum;
  }
}

/// Returns the knots with each value once more.
std::vector<double> raised_knots(const std::vector<double>& knots) {
  std::vector<double> raised;
  raised.reserve(2 * knots.size());
  for (std::size_t k = 0; k < knots.size(); ++k) {
    if (k == 0 || knots[k] != knots[k - 1]) raised.push_back(knots[k]);
    raised.push_back(knots[k]);
  }
  return raised;
}

using Blossom = std::array<long double, max_degree + 1>;

/// Returns the mean of the blossoms of all but one of the degree + 1 `arguments`, which is the blossom of the curve
/// seen as one of the next degree (Farin, sec. 8.7). Arguments near the span come first, where the steps are narrow.
Blossom elevated_blossom(const SplineNet& net, std::size_t span, const double* arguments) {
  const std::size_t p = static_cast<std::size_t>(net.degree);
  Blossom sorted{};
  std::copy_n(arguments, p + 1, sorted.begin());
  const auto distance = [&](long double t) { return std::max({net.knots[span] - t, t - net.knots[span + 1], 0.0L}); };
  std::sort(sorted.begin(), sorted.begin() + net.degree + 1,
            [&](long double a, long double b) { return distance(a) < distance(b); });
  Blossom sum{};
  for (std::size_t left_out = 0; left_out <= p; ++left_out) {
    Blossom others{}, weights{};
    std::copy_n(sorted.begin(), left_out, others.begin());
    std::copy_n(sorted.begin() + static_cast<std::ptrdiff_t>(left_out) + 1, p - left_out,
                others.begin() + static_cast<std::ptrdiff_t>(left_out));
    blossom_weights(net.degree, std::span<const double>(net.knots), span, others.data(), weights.data());
    for (std::size_t j = 0; j <= p; ++j) sum[j] += weights[j];
  }
  for (std::size_t j = 0; j <= p; ++j) sum[j] /= static_cast<long double>(p + 1);
  return sum;
}

}  // namespace

void insert_knot(SplineNet& net, double t) {
  const std::size_t p = static_cast<std::size_t>(net.degree), width = net.width;
  const auto above = std::upper_bound(net.knots.begin(), net.knots.end(), t);
  const std::size_t k = static_cast<std::size_t>(above - net.knots.begin()) - 1, s = multiplicity(net.knots, t);
  std::vector<NetPoint> inserted((p - s) * width);  // points k-p+1 .. k-s of the new net
  for (std::size_t i = k - p + 1; i + s <= k; ++i) {
    const double left = net.knots[i], right = net.knots[i + p];
    const double factors[] = {(right - t) / (right - left), (t - left) / (right - left)};
    combine(net, i - 1, 2, factors, &inserted[(i - (k - p + 1)) * width]);
  }
  // p - s new rows replace the p - s - 1 old ones between k-p and k-s.
  const auto row = [&](std::size_t i) { return net.points.begin() + static_cast<std::ptrdiff_t>(i * width); };
  const auto grown = net.points.insert(row(k - s), width, NetPoint{});
  std::copy(inserted.begin(), inserted.end(), grown - static_cast<std::ptrdiff_t>((p - s - 1) * width));
  net.knots.insert(above, t);
}

void raise_multiplicity(SplineNet& net, double t, std::size_t times) {
  for (std::size_t count = multiplicity(net.knots, t); count < times; ++count) insert_knot(net, t);
}

void clamp(SplineNet& net, double from, double to) {
  const std::size_t p = static_cast<std::size_t>(net.degree);
  raise_multiplicity(net, from, p);
  raise_multiplicity(net, to, p);
  const auto first = std::upper_bound(net.knots.begin(), net.knots.end(), from);
  const auto last = std::lower_bound(net.knots.begin(), net.knots.end(), to);
  // The first span acts on the points from its own index less the degree; the last span ends before `to`.
  const std::size_t first_point = static_cast<std::size_t>(first - net.knots.begin()) - 1 - p;
  const std::size_t end_point = static_cast<std::size_t>(last - net.knots.begin());
  std::vector<double> knots(p + 1, from);
  knots.insert(knots.end(), first, last);
  knots.insert(knots.end(), p + 1, to);
  net.knots = std::move(knots);
  const auto row = [&](std::size_t i) { return net.points.begin() + static_cast<std::ptrdiff_t>(i * net.width); };
  net.points = std::vector<NetPoint>(row(first_point), row(end_point));
}

SplineNet elevate_degree(const SplineNet& net) {
  const std::size_t p = static_cast<std::size_t>(net.degree);
  SplineNet result{net.degree + 1, net.rational, net.width, raised_knots(net.knots), {}};
  const std::size_t count = result.knots.size() - p - 2;
  result.points.resize(count * net.width);
  for (std::size_t i = 0; i < count; ++i) {
    // Takes a span on which point i acts, in the middle of its knots.
    const double middle = result.knots[i + 1 + p / 2];
    const auto at = result.knots[i + p + 2] == middle ? std::lower_bound(net.knots.begin(), net.knots.end(), middle)
                                                      : std::upper_bound(net.knots.begin(), net.knots.end(), middle);
    const std::size_t span = static_cast<std::size_t>(at - net.knots.begin()) - 1;
    const Blossom blossom = elevated_blossom(net, span, &result.knots[i + 1]);
    std::array<double, max_degree + 1> factors;
    for (std::size_t j = 0; j <= p; ++j) factors[j] = static_cast<double>(blossom[j]);
    combine(net, span - p, p + 1, factors.data(), &result.points[i * net.width]);
  }
  return result;
}

std::vector<NetPoint> transposed(const std::vector<NetPoint>& points, std::size_t width) {
  std::vector<NetPoint> result;
  result.reserve(points.size());
  for (std::size_t c = 0; c < width; ++c)
    for (std::size_t k = c; k < points.size(); k += width) result.push_back(points[k]);
  return result;
}

}}  // namespace tessera::abi_0_1
