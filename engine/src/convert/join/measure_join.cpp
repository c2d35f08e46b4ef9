#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "basis/bernstein_net.h"
#include "convert/join/side_rows.h"
#include "surface/net/homogeneous.h"
#include "tessera/bezier_operations.h"
#include "tessera/geometry.h"
#include "tessera/guard.h"
#include "tessera/status.h"

// G1 demands det(p_c, q_c, r_b) = 0 and (p_c x r_b) . (q_c x r_b) > 0 along the border b (Farin, Curves and Surfaces
// for CAGD, 5th ed., sec. 17.2). Each side uses its own border tangent, so that gaps within tolerance do no harm: the
// quotient of (p_c x p_b) x (q_c x q_b) and (p_c x p_b) . (q_c x q_b) is the tangent of the angle between the normals.

namespace tessera { inline namespace abi_0_1 {
namespace {

// Proven maxima along a border of functions made of a vector and a scalar polynomial.

/// A vector curve and a scalar curve, both on [0,1].
struct VectorRatio {
  BernsteinNet<Vec3> numerator;
  BernsteinNet<double> denominator;
};

/// An upper bound; `sharp` says that it is within 0.1 % or `floor` of the true maximum.
struct Maximum {
  double bound = 0;
  bool sharp = true;
};

constexpr int max_halvings = 40;
constexpr int max_pieces = 20000;

struct Piece {
  VectorRatio ratio;
  int depth = 0;
};

template <class Upper, class Lower>
Maximum maximum(const VectorRatio& whole, double floor, Upper upper, Lower lower) {
  Maximum result;
  double attained = 0;
  std::vector<Piece> open{{whole, 0}};
  for (int count = 0; !open.empty(); ++count) {
    const Piece piece = std::move(open.back());
    open.pop_back();
    const VectorRatio& r = piece.ratio;
    attained = std::max({attained, lower(r.numerator.values.front(), r.denominator.values.front()),
                         lower(r.numerator.values.back(), r.denominator.values.back())});
    const double bound = upper(r);
    const bool settled = bound <= std::max(1.001 * attained, attained + floor);
    if (settled || piece.depth == max_halvings || count >= max_pieces) {
      result.bound = std::max(result.bound, bound);
      result.sharp = result.sharp && settled;
      continue;
    }
    auto [first, second] = halves(r.numerator);
    auto [first_below, second_below] = halves(r.denominator);
    open.push_back({{std::move(second), std::move(second_below)}, piece.depth + 1});
    open.push_back({{std::move(first), std::move(first_below)}, piece.depth + 1});
  }
  return result;
}

double largest(const BernsteinNet<Vec3>& net) {
  double value = 0;
  for (const Vec3& p : net.values) value = std::max(value, length(p));
  return value;
}

/// Returns a lower bound of |p| over the hull: the least distance from zero along the mean direction.
double smallest(const BernsteinNet<Vec3>& net) {
  Vec3 mean;
  for (const Vec3& p : net.values) mean += p;
  mean = normalized(mean);
  double value = std::numeric_limits<double>::infinity();
  for (const Vec3& p : net.values) value = std::min(value, dot(p, mean));
  return std::max(value, 0.0);
}

/// Bounds max |numerator| / denominator, for a positive denominator.
Maximum largest_length(const VectorRatio& ratio, double floor) {
  const auto upper = [](const VectorRatio& r) {
    const double top = largest(r.numerator),
                 least = *std::min_element(r.denominator.values.begin(), r.denominator.values.end());
    return top == 0 ? 0 : least > 0 ? top / least : std::numeric_limits<double>::infinity();
  };
  return maximum(ratio, floor, upper, [](const Vec3& p, double w) { return w > 0 ? length(p) / w : 0; });
}

/// Bounds the maximum of the angle atan2(|numerator|, denominator), for numerator = a x b and denominator = a . b.
Maximum largest_angle(const VectorRatio& ratio, double floor) {
  const auto upper = [](const VectorRatio& r) {
    // The angle falls as the denominator grows. For a fixed denominator the maximum is at an end of the numerator's
    // range.
    const double least = *std::min_element(r.denominator.values.begin(), r.denominator.values.end());
    const double far = largest(r.numerator), near = smallest(r.numerator);
    if (far == 0 && least == 0) return std::numbers::pi;  // a normal vanishes
    return std::max(std::atan2(far, least), std::atan2(near, least));
  };
  return maximum(ratio, floor, upper, [](const Vec3& p, double x) { return std::atan2(length(p), x); });
}

using Scalars = BernsteinNet<double>;
using Vectors = BernsteinNet<Vec3>;

/// Numerators along a border, in homogeneous form: the point over w, the derivatives over w^2.
struct Border {
  Vectors point;
  Scalars weight;  ///< degree 0 for a polynomial patch
  Vectors across;  ///< derivative into the patch, by its domain
  Vectors tangent;
};

double box_size(const Box3& box) {
  return std::max(max_abs(box.upper - box.lower), std::numeric_limits<double>::min());
}

Border border(const JoinedPatch& joined, bool reversed, const Vec3& origin, double scale) {
  const BezierPatch& patch = joined.patch;
  const SideView view = side_view(patch, joined.side, reversed);
  double heaviest = 1;
  if (patch.is_rational())
    heaviest = power_of_two_near(*std::max_element(patch.weights().begin(), patch.weights().end()));
  const auto weights = [&](int row) {
    if (!patch.is_rational()) return bernstein_one(0, 0);
    Scalars w(view.along, 0);
    for (int k = 0; k <= view.along; ++k) w.at(k, 0) = patch.weights()[view.index(row, k)] / heaviest;
    return w;
  };
  const auto points = [&](int row, const Scalars& w) {
    Vectors p(view.along, 0);
    for (int k = 0; k <= view.along; ++k) {
      const Vec3 relative = (1 / scale) * (patch.points()[view.index(row, k)] - origin);
      p.at(k, 0) = patch.is_rational() ? w.at(k, 0) * relative : relative;
    }
    return p;
  };
  const Scalars w0 = weights(0), w1 = weights(1);
  const Vectors p0 = points(0, w0), p1 = points(1, w1);
  // With r = A / w: r' = (A' w - A w') / w^2. Across the border A' and w' are differences of the two rows.
  Vectors across = w0 * p1 - w1 * p0;
  for (Vec3& d : across.values) d = (view.across / width_across(joined)) * d;
  Vectors tangent = patch.is_rational() ? w0 * derivative_u(p0) - derivative_u(w0) * p0 : derivative_u(p0);
  return {p0, w0, std::move(across), std::move(tangent)};
}

double largest_coefficient(const Vectors& net) {
  double largest = 0;
  for (const Vec3& p : net.values) largest = std::max(largest, max_abs(p));
  return largest;
}

/// Divides by t and by 1 - t as often as the curve vanishes at its ends, within rounding.
Vectors without_end_zeros(Vectors net) {
  // A coefficient that is zero in exact arithmetic is a sum of products of differences, which round by 2^-52 of the
  // largest each: 1e-13 allows for 450 of these roundings.
  const double zero = 1e-13 * largest_coefficient(net);
  for (int end = 0; end < 2; ++end) {
    while (net.degree_u > 0 && largest_coefficient(net) > zero && !(max_abs(net.values.front()) > zero)) {
      Vectors divided(net.degree_u - 1, 0);
      for (int k = 0; k < net.degree_u; ++k) divided.at(k, 0) = (double(net.degree_u) / (k + 1)) * net.at(k + 1, 0);
      net = std::move(divided);
    }
    std::reverse(net.values.begin(), net.values.end());
  }
  return net;
}

Vectors normal_numerator(const Border& b) {
  Vectors normal = product(b.across, b.tangent, [](const Vec3& x, const Vec3& y) { return cross(x, y); });
  const double size = largest_coefficient(normal);
  if (size > 0)
    for (Vec3& n : normal.values) n = {n.x / size, n.y / size, n.z / size};
  return without_end_zeros(std::move(normal));
}

/// Bounds the angle between the normals. The sign of p's normal is reversed, because its derivative runs into p.
Maximum normal_angle(const Border& p, const Border& q) {
  const Vectors np = normal_numerator(p), nq = normal_numerator(q);
  VectorRatio ratio{product(np, nq, [](const Vec3& x, const Vec3& y) { return cross(x, y); }),
                    product(np, nq, [](const Vec3& x, const Vec3& y) { return -dot(x, y); })};
  return largest_angle(ratio, 1e-12);
}

Vectors times(double factor, Vectors net) {
  for (Vec3& p : net.values) p = factor * p;
  return net;
}

/// Cross-derivatives from p into q over one denominator.
struct CrossDerivatives {
  Vectors p, q;
  Scalars denominator;
  double size_p = 0, size_q = 0;  ///< the largest lengths of p and of q

  double gap(double k, bool& sharp) const {
    const double floor = 1e-15 * std::max(size_p, std::abs(k) * size_q);
    const Maximum found = largest_length({p - times(k, q), denominator}, floor);
    sharp = sharp && found.sharp;
    return found.bound;
  }
};

CrossDerivatives cross_derivatives(const Border& p, const Border& q) {
  const Scalars wp = p.weight * p.weight, wq = q.weight * q.weight;
  CrossDerivatives result{wq * times(-1, p.across), wp * q.across, wp * wq, 0, 0};
  result.size_p = largest_length({p.across, wp}, 0).bound;
  result.size_q = largest_length({q.across, wq}, 0).bound;
  return result;
}

/// Returns the k > 0 that brings k q_c nearest to p_c, coefficient by coefficient; 0 if there is none.
double nearest_ratio(const CrossDerivatives& d) {
  const int degree = std::max(d.p.degree_u, d.q.degree_u);
  const Vectors p = elevated(d.p, degree, 0), q = elevated(d.q, degree, 0);
  double both = 0, square = 0;
  for (std::size_t k = 0; k < p.values.size(); ++k) {
    both += dot(p.values[k], q.values[k]);
    square += dot(q.values[k], q.values[k]);
  }
  const double ratio = both / square;
  return ratio > 0 && std::isfinite(ratio) ? ratio : 0;
}

/// Returns true if q's edge runs against p's: this brings its ends and two inner points nearer.
bool runs_against(const JoinedPatch& p, const JoinedPatch& q) {
  std::array<double, 2> gap{};
  for (const bool reversed : {false, true})
    for (const double t : {0.0, 0.25, 0.5, 1.0}) {
      const auto at = [](const JoinedPatch& joined, double s) {
        const bool end = joined.side == Side::u1 || joined.side == Side::v1;
        return crosses_u(joined.side) ? de_casteljau(joined.patch, end, s) : de_casteljau(joined.patch, s, end);
      };
      gap[reversed] = std::max(gap[reversed], max_abs(at(p, t) - at(q, reversed ? 1 - t : t)));
    }
  return gap[1] < gap[0];
}

Status check(const JoinedPatch& p, const JoinedPatch& q, const JoinTolerances& tolerances) {
  if (Status status = check_joined(p, "p"); !status.ok()) return status;
  if (Status status = check_joined(q, "q"); !status.ok()) return status;
  if (tolerances.position >= 0 && tolerances.angle >= 0 && tolerances.derivative >= 0) return {};
  return {StatusCode::invalid_argument, "the tolerances of a join must not be negative"};
}

JoinReport measure(const JoinedPatch& p, const JoinedPatch& q, const JoinTolerances& tolerances) {
  Box3 box = p.patch.hull_box();
  box.extend(q.patch.hull_box());
  const double scale = power_of_two_near(box_size(box));
  const double size = length((1 / scale) * (box.upper - box.lower));
  JoinReport report;
  report.reversed = runs_against(p, q);
  const Border bp = border(p, false, box.centre(), scale), bq = border(q, report.reversed, box.centre(), scale);

  const Maximum position =
      largest_length({bq.weight * bp.point - bp.weight * bq.point, bp.weight * bq.weight}, 1e-15 * size);
  const Maximum angle = normal_angle(bp, bq);
  report.sharp = position.sharp && angle.sharp;
  const CrossDerivatives across = cross_derivatives(bp, bq);
  const double gap = across.gap(1, report.sharp), ratio = nearest_ratio(across);
  const bool smooth = gap <= tolerances.derivative * std::max(across.size_p, across.size_q);
  if (ratio > 0 &&
      across.gap(ratio, report.sharp) <= tolerances.derivative * std::max(across.size_p, ratio * across.size_q))
    report.ratio = ratio;

  report.position_gap = scale * position.bound;
  report.normal_angle = angle.bound;
  report.derivative_gap = scale * gap;
  if (position.bound <= tolerances.position * size) {
    const bool one_normal = angle.bound <= tolerances.angle;
    report.continuity = !one_normal ? Continuity::c0 : smooth ? Continuity::c1 : Continuity::g1;
  }
  return report;
}

}  // namespace

Result<JoinReport> measure_join(const JoinedPatch& p, const JoinedPatch& q, const JoinTolerances& tolerances) {
  return guarded([&]() -> Result<JoinReport> {
    if (Status status = check(p, q, tolerances); !status.ok()) return status;
    return measure(p, q, tolerances);
  });
}

}}  // namespace tessera::abi_0_1
