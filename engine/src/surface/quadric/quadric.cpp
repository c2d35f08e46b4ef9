#include "tessera/quadric.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "basis/symmetric_eigen.h"
#include "surface/net/homogeneous.h"
#include "tessera/guard.h"
#include "tessera/status.h"

// Reduction to principal axes: the quadratic part by its eigenvectors, then squares completed along the axes whose
// eigenvalue is not 0 (any text on analytic geometry; Farin and Hansford, Practical Linear Algebra, on quadratic
// forms).

namespace tessera { inline namespace abi_0_1 {
namespace {

/// One principal axis, with the square lambda x^2 and the linear term 2 slope x along it.
struct PrincipalAxis {
  Vec3 direction;
  double lambda = 0, slope = 0;
  bool null = false;
  int sign() const { return null ? 0 : lambda > 0 ? 1 : -1; }
};

/// The equation along its principal axes.
struct PrincipalForm {
  std::array<PrincipalAxis, 3> axes;
  double constant = 0;  ///< at the centre; exactly 0 within tolerance
  Vec3 null_slope;      ///< the linear part along null directions; exactly 0 within tolerance
  Vec3 centre;          ///< of the squares
  int positive = 0, negative = 0;
  double largest = 0;  ///< of the three parts at the length of comparison; infinite if out of range
};

void negate(PrincipalForm& form) {
  for (PrincipalAxis& axis : form.axes) {
    axis.lambda = -axis.lambda;
    axis.slope = -axis.slope;
  }
  form.constant = -form.constant;
  form.null_slope = -form.null_slope;
  std::swap(form.positive, form.negative);
}

PrincipalForm principal_form(const QuadricCoefficients& q, const QuadricOptions& options) {
  PrincipalForm form;
  const SymmetricEigen eigen = symmetric_eigen(q.a, q.b, q.c, q.d, q.e, q.f);
  const Vec3 linear{q.g, q.h, q.j};
  const double size = std::max({std::abs(eigen.values[0]), std::abs(eigen.values[1]), std::abs(eigen.values[2])});
  const double slope = length(linear), constant = std::abs(q.k);
  // At this length the quadratic part, if there is one, is the largest.
  const double own_length = size > 0                    ? std::max(slope / size, std::sqrt(constant / size))
                            : slope > 0 && constant > 0 ? constant / slope
                                                        : 1;
  const double unit = options.length > 0 ? options.length : own_length;
  const double total = form.largest = std::max({size * unit * unit, slope * unit, constant});
  const double min_square = size * unit * unit > options.tolerance * total || options.length == 0
                                ? options.tolerance * size
                                : std::numeric_limits<double>::infinity();
  double terms = std::max(constant, options.length > 0 ? total : 0);
  form.constant = q.k;
  for (std::size_t i = 0; i < 3; ++i) {
    PrincipalAxis& axis = form.axes[i];
    axis = {eigen.vectors[i], eigen.values[i], dot(linear, eigen.vectors[i]), false};
    axis.null = !(std::abs(axis.lambda) > min_square);
    if (axis.null) {
      form.null_slope += axis.slope * axis.direction;
      continue;
    }
    const double at = axis.slope / axis.lambda;
    form.centre = form.centre - at * axis.direction;
    form.constant -= axis.slope * at;
    terms = std::max(terms, std::abs(axis.slope * at));
    ++(axis.lambda > 0 ? form.positive : form.negative);
  }
  if (!(length(form.null_slope) * unit > options.tolerance * total)) form.null_slope = {};
  if (!(std::abs(form.constant) > options.tolerance * terms)) form.constant = 0;
  return form;
}

QuadricKind classify(const PrincipalForm& form) {
  const bool linear = form.null_slope != Vec3{};
  const auto by_constant = [&](QuadricKind below, QuadricKind zero, QuadricKind above) {
    return form.constant < 0 ? below : form.constant > 0 ? above : zero;
  };
  switch (form.positive + form.negative) {
    case 3:
      return form.negative == 0
                 ? by_constant(QuadricKind::ellipsoid, QuadricKind::point, QuadricKind::imaginary_ellipsoid)
                 : by_constant(QuadricKind::hyperboloid_one_sheet, QuadricKind::elliptic_cone,
                               QuadricKind::hyperboloid_two_sheets);
    case 2:
      if (linear) return form.negative == 0 ? QuadricKind::elliptic_paraboloid : QuadricKind::hyperbolic_paraboloid;
      return form.negative == 0
                 ? by_constant(QuadricKind::elliptic_cylinder, QuadricKind::line, QuadricKind::imaginary_cylinder)
                 : by_constant(QuadricKind::hyperbolic_cylinder, QuadricKind::intersecting_planes,
                               QuadricKind::hyperbolic_cylinder);
    case 1:
      if (linear) return QuadricKind::parabolic_cylinder;
      return by_constant(QuadricKind::parallel_planes, QuadricKind::coincident_planes, QuadricKind::imaginary_planes);
    default:
      return linear ? QuadricKind::plane : QuadricKind::empty;
  }
}

/// Orders positive squares first, then negative ones, then null directions; among such orders it takes the one nearest
/// to x, y, z. Returns how near it is: the sum of the axes' own components.
double arrange(std::array<PrincipalAxis, 3>& axes) {
  const auto rank = [](const PrincipalAxis& axis) { return axis.sign() > 0 ? 0 : axis.sign() < 0 ? 1 : 2; };
  std::array<std::size_t, 3> order{0, 1, 2}, best{};
  double highest = -1;
  do {
    const PrincipalAxis &x = axes[order[0]], &y = axes[order[1]], &z = axes[order[2]];
    if (rank(x) > rank(y) || rank(y) > rank(z)) continue;
    const double score = std::abs(x.direction.x) + std::abs(y.direction.y) + std::abs(z.direction.z);
    if (score > highest) {
      highest = score;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  axes = {axes[best[0]], axes[best[1]], axes[best[2]]};
  return highest;
}

/// Chooses the signs so that at most as many squares are negative as positive and the kind's equation holds, and
/// arranges the axes.
void make_canonical(PrincipalForm& form) {
  if (form.negative > form.positive) negate(form);
  PrincipalForm other = form;
  negate(other);
  const double score = arrange(form.axes), other_score = arrange(other.axes);
  if (form.positive != form.negative || form.positive == 0) return;
  const Vec3& opens = form.null_slope;  // the saddle opens the other way
  const bool linear = opens != Vec3{};
  const bool turn = linear ? opens.z > 0 || (opens.z == 0 && (opens.y > 0 || (opens.y == 0 && opens.x > 0)))
                    : form.constant != 0 ? form.constant > 0
                                         : other_score > score;
  if (turn) form = other;
}

/// Returns a or -a: the one whose given component is positive or, if that is 0, its first nonzero one.
Vec3 oriented(const Vec3& a, double component) {
  const double decisive = component != 0 ? component : a.x != 0 ? a.x : a.y != 0 ? a.y : a.z;
  return decisive < 0 ? -a : a;
}

/// Returns a unit vector at right angles to `axis`, as near to z as possible (to y if the axis is nearly z).
Vec3 beside(const Vec3& axis) {
  const Vec3 wanted = std::abs(axis.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  return normalized(wanted - dot(wanted, axis) * axis);
}

/// Returns the frame of arranged axes. Where the linear part decides, the third axis points where the surface opens.
QuadricFrame frame_of(QuadricKind kind, const PrincipalForm& form) {
  QuadricFrame frame;
  Vec3 x = form.axes[0].direction, z = form.axes[2].direction;
  const double steepness = length(form.null_slope);
  if (kind == QuadricKind::plane) {
    x = oriented(normalized(form.null_slope), normalized(form.null_slope).x);
    z = beside(x);
  } else if (steepness > 0) {
    z = -normalized(form.null_slope);  // lambda x^2 + ... = 2 steepness z
    z = normalized(z - dot(z, x) * x);
  } else {
    z = oriented(z, z.z);
  }
  x = oriented(x, x.x);
  frame.axes = {x, cross(z, x), z};
  frame.origin = form.centre;
  if (kind == QuadricKind::plane)
    frame.origin = (-form.constant / (2 * dot(form.null_slope, x))) * x;
  else if (steepness > 0)
    frame.origin += (form.constant / (2 * steepness)) * z;
  return frame;
}

Vec3 size_of(QuadricKind kind, const PrincipalForm& form) {
  const double slope = length(form.null_slope);
  const double l0 = std::abs(form.axes[0].lambda), l1 = std::abs(form.axes[1].lambda),
               l2 = std::abs(form.axes[2].lambda);
  const auto root = [](double a, double b) { return std::sqrt(std::abs(a / b)); };
  switch (kind) {
    case QuadricKind::ellipsoid:
    case QuadricKind::imaginary_ellipsoid:
    case QuadricKind::hyperboloid_one_sheet:
    case QuadricKind::hyperboloid_two_sheets:
      return {root(form.constant, l0), root(form.constant, l1), root(form.constant, l2)};
    case QuadricKind::elliptic_cone:
    case QuadricKind::point:
      return {root(l2, l0), root(l2, l1), 1};
    case QuadricKind::elliptic_paraboloid:
    case QuadricKind::hyperbolic_paraboloid:
      return {root(2 * slope, l0), root(2 * slope, l1), 1};
    case QuadricKind::elliptic_cylinder:
    case QuadricKind::imaginary_cylinder:
    case QuadricKind::hyperbolic_cylinder:
      return {root(form.constant, l0), root(form.constant, l1), 1};
    case QuadricKind::parabolic_cylinder:
      return {root(2 * slope, l0), 1, 1};
    case QuadricKind::intersecting_planes:
      return {root(l1, l0 + l1), root(l0, l0 + l1), 1};
    case QuadricKind::line:
      return {1, root(l0, l1), 1};
    case QuadricKind::parallel_planes:
    case QuadricKind::imaginary_planes:
      return {root(form.constant, l0), 1, 1};
    default:
      return {1, 1, 1};
  }
}

Status check(const std::array<double, 10>& coefficients, const QuadricOptions& options) {
  double largest = 0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    if (!std::isfinite(coefficients[k]))
      return {StatusCode::non_finite, std::string("coefficient ") + "abcdefghjk"[k] + " of the quadric is not finite",
              static_cast<std::ptrdiff_t>(k)};
    largest = std::max(largest, std::abs(coefficients[k]));
  }
  if (largest == 0)
    return {StatusCode::invalid_argument, "all ten coefficients of the quadric are 0: every point satisfies it"};
  if (!(options.tolerance > 0 && options.tolerance <= 0.01))
    return {StatusCode::invalid_argument, "the tolerance of a quadric must be above 0 and at most 0.01"};
  if (!(options.length >= 0 && std::isfinite(options.length)))
    return {StatusCode::invalid_argument, "the length of a quadric must be finite and not negative"};
  return {};
}

/// Divides by a power of two near the largest coefficient. Products then stay in range, and only coefficients below
/// 2^-1000 of the largest round.
QuadricCoefficients scaled(const QuadricCoefficients& q, const std::array<double, 10>& list) {
  double largest = 0;
  for (const double x : list) largest = std::max(largest, std::abs(x));
  const double s = 1 / power_of_two_near(largest);
  return {s * q.a, s * q.b, s * q.c, s * q.d, s * q.e, s * q.f, s * q.g, s * q.h, s * q.j, s * q.k};
}

}  // namespace

Result<Quadric> Quadric::make(const QuadricCoefficients& q, const QuadricOptions& options) {
  return guarded([&]() -> Result<Quadric> {
    const std::array<double, 10> list{q.a, q.b, q.c, q.d, q.e, q.f, q.g, q.h, q.j, q.k};
    if (Status status = check(list, options); !status.ok()) return status;
    PrincipalForm form = principal_form(scaled(q, list), options);
    make_canonical(form);
    Quadric quadric;
    quadric.coefficients_ = q;
    quadric.kind_ = classify(form);
    quadric.frame_ = frame_of(quadric.kind_, form);
    quadric.size_ = size_of(quadric.kind_, form);
    const Diagonal diagonal = quadric.diagonal();
    if (!std::isfinite(form.largest) || !is_finite(quadric.frame_.origin) || !is_finite(diagonal.squares) ||
        !std::isfinite(dot(quadric.size_, quadric.size_)))
      return Status(StatusCode::non_finite, "the canonical form of the quadric is out of the range of doubles");
    return quadric;
  });
}

}}  // namespace tessera::abi_0_1
