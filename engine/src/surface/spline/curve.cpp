#include "tessera/curve.h"

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string>
#include <type_traits>

#include "base/text.h"
#include "surface/net/validate.h"
#include "surface/spline/spline_lines.h"
#include "surface/spline/spline_window.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr auto in_list = [](std::size_t k) { return "[" + std::to_string(k) + "]"; };

Status check_size(int degree, std::size_t points, std::size_t knots) {
  const std::size_t wanted = points + static_cast<std::size_t>(degree) + 1;
  if (knots == wanted) return {};
  return {StatusCode::count_mismatch, "degree " + std::to_string(degree) + " and " + counted(points, "point") +
                                          " need " + std::to_string(wanted) + " knots, found " + std::to_string(knots)};
}

/// Checks the requirements of both kinds, and sets an empty domain to that of the knots.
Status check_b_spline(int degree, std::span<const Vec3> points, std::span<const double> knots,
                      std::optional<Interval>& domain) {
  if (Status status = check_degree(degree, "the degree"); !status.ok()) return status;
  if (Status status = check_size(degree, points.size(), knots.size()); !status.ok()) return status;
  if (Status status = check_knots(degree, knots, "knots"); !status.ok()) return status;
  if (Status status = check_points(points, in_list); !status.ok()) return status;
  if (!domain) domain = Interval{knots[static_cast<std::size_t>(degree)], knots[points.size()]};
  return check_range(degree, knots, domain->from, domain->to, "the domain");
}

/// The points that act at t, in a frame that keeps their sums in range.
struct ActingPoints {
  ActingPoints(const Curve& curve, double t)
      : line(line_of(curve)), span(find_span(line, t)), frame(frame_of(curve, first(), span, t)) {
    for (std::size_t k = 0; k < line.order(); ++k)
      window[k] = frame.homogeneous(curve.points()[first() + k], curve.weight(first() + k));
  }

  const double* knots() const { return &line.knots[span]; }
  std::size_t first() const { return span - static_cast<std::size_t>(line.degree); }

  KnotLine line;
  std::size_t span;
  WindowFrame frame;
  SplineWindow window;

 private:
  static WindowFrame frame_of(const Curve& curve, std::size_t first, std::size_t span, double t) {
    double largest = 0, largest_weight = 0;
    for (std::size_t k = first; k <= span; ++k) {
      largest = std::max(largest, max_abs(curve.points()[k]));
      if (curve.is_rational()) largest_weight = std::max(largest_weight, curve.weight(k));
    }
    const std::size_t nearer = first + nearer_end(curve.degree(), &curve.knots()[span], t);
    return WindowFrame(largest, largest_weight, curve.is_rational() ? curve.points()[nearer] : Vec3{});
  }
};

}  // namespace

// One allocation instead of four: a face has dozens of short curves. Copies all lists to where the memory's head says.
Curve::Curve(int degree, std::span<const Vec3> points, std::span<const double> weights, std::span<const double> knots,
             const Interval& domain)
    : memory_(sizeof(Data) + points.size_bytes() + weights.size_bytes() + knots.size_bytes()) {
  static_assert(alignof(Data) <= __STDCPP_DEFAULT_NEW_ALIGNMENT__ && alignof(Vec3) == alignof(double));
  static_assert(sizeof(Data) % alignof(Vec3) == 0 && std::is_trivially_destructible_v<Data>);
  auto* const head = static_cast<Data*>(memory_.data());
  auto* const own_points = reinterpret_cast<Vec3*>(head + 1);
  auto* const own_weights =
      reinterpret_cast<double*>(std::uninitialized_copy(points.begin(), points.end(), own_points));
  double* const own_knots = std::uninitialized_copy(weights.begin(), weights.end(), own_weights);
  std::uninitialized_copy(knots.begin(), knots.end(), own_knots);
  new (head)
      Data{degree, {own_points, points.size()}, {own_weights, weights.size()}, {own_knots, knots.size()}, domain};
}

bool Curve::operator==(const Curve& other) const {
  const Data &a = data(), &b = other.data();
  return &a == &b || (a.degree == b.degree && a.domain == b.domain && std::ranges::equal(a.points, b.points) &&
                      std::ranges::equal(a.weights, b.weights) && std::ranges::equal(a.knots, b.knots));
}

Result<Curve> Curve::bezier(std::span<const Vec3> points, std::span<const double> weights, const Interval& domain) {
  return guarded([&]() -> Result<Curve> {
    const int degree = static_cast<int>(std::min<std::size_t>(points.size(), 1000)) - 1;
    if (Status status = check_degree(degree, "the degree"); !status.ok()) return status;
    std::array<double, 2 * (max_degree + 1)> both_ends;
    const std::span<double> knots = std::span(both_ends).first(2 * points.size());
    std::ranges::fill(knots.first(points.size()), domain.from);
    std::ranges::fill(knots.subspan(points.size()), domain.to);
    if (weights.empty()) return b_spline(degree, points, knots);
    return nurbs(degree, points, weights, knots);
  });
}

Result<Curve> Curve::b_spline(int degree, std::span<const Vec3> points, std::span<const double> knots,
                              std::optional<Interval> domain) {
  return guarded([&]() -> Result<Curve> {
    if (Status status = check_b_spline(degree, points, knots, domain); !status.ok()) return status;
    return Curve(degree, points, {}, knots, *domain);
  });
}

Result<Curve> Curve::nurbs(int degree, std::span<const Vec3> points, std::span<const double> weights,
                           std::span<const double> knots, std::optional<Interval> domain) {
  return guarded([&]() -> Result<Curve> {
    if (Status status = check_b_spline(degree, points, knots, domain); !status.ok()) return status;
    if (weights.size() != points.size())
      return Status(StatusCode::count_mismatch, std::to_string(points.size()) + " points need " +
                                                    std::to_string(points.size()) + " weights, found " +
                                                    std::to_string(weights.size()));
    if (Status status = check_weights(weights, in_list); !status.ok()) return status;
    if (all_equal(weights)) weights = {};
    return Curve(degree, points, weights, knots, *domain);
  });
}

CurveJet evaluate_jet(const Curve& curve, double t) {
  const ActingPoints acting(curve, t);
  const WindowFrame& frame = acting.frame;
  const SplineJet a = spline_jet(curve.degree(), acting.knots(), t, acting.window);
  if (!curve.is_rational())
    return {frame.position(a[0].vector()), frame.vector(a[1].vector()), frame.vector(a[2].vector())};
  const Homogeneous none{0, 0, 0, 0};
  const SurfaceJet jet = project(a[0], a[1], none, a[2], none, none);
  return {frame.position(jet.position), frame.vector(jet.du), frame.vector(jet.duu)};
}

Vec3 position(const Curve& curve, double t) {
  const ActingPoints acting(curve, t);
  const Homogeneous a = de_boor(curve.degree(), acting.knots(), t, acting.window);
  return acting.frame.position(curve.is_rational() ? a.project() : a.vector());
}

}}  // namespace tessera::abi_0_1
