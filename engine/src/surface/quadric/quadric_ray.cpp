#include <algorithm>
#include <cmath>
#include <limits>

#include "tessera/quadric.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

/// A sum and the sum of its terms' absolute values, to which its rounding is relative.
struct Sum {
  double value = 0, size = 0;
  void add(double term) {
    value += term;
    size += std::abs(term);
  }
  bool vanishes() const { return !(std::abs(value) > rounding * size); }
};

/// The quadratic a t^2 + 2 b t + c along the ray.
struct LineQuadratic {
  Sum a, b, c;
};

LineQuadratic along(const Quadric::Diagonal& q, const Vec3& o, const Vec3& d) {
  LineQuadratic line;
  for (const auto component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    const double s = q.squares.*component, l = q.linear.*component;
    line.a.add(s * d.*component * d.*component);
    line.b.add(s * o.*component * d.*component);
    line.b.add(0.5 * l * d.*component);
    line.c.add(s * o.*component * o.*component);
    line.c.add(l * o.*component);
  }
  line.c.add(q.constant);
  return line;
}

/// Returns b^2 - a c accurately even if the rounded products cancel (Kahan).
double discriminant(double a, double b, double c) {
  const double product = a * c;
  return std::fma(b, b, -product) + std::fma(-a, c, product);
}

/// Writes the roots to `hits`, by q = -(b + sign(b) sqrt(discriminant)), t = q/a and c/q (Numerical Recipes, sec. 5.6).
void solve(const LineQuadratic& line, QuadricHits& hits) {
  const double a = line.a.value, b = line.b.value, c = line.c.value;
  if (line.a.vanishes()) {
    if (!line.b.vanishes())
      hits.t[0] = -c / (2 * b), hits.count = 1;
    else
      hits.contained = line.c.vanishes();
    return;
  }
  const double d = discriminant(a, b, c);
  const double error =
      rounding * (2 * std::abs(b) * line.b.size + line.a.size * std::abs(c) + std::abs(a) * line.c.size);
  if (std::abs(d) <= error) {
    hits.t[0] = -b / a;
    hits.count = 1;
    hits.tangent = true;
  } else if (d > 0) {
    const double q = -(b + std::copysign(std::sqrt(d), b));
    hits.t = {std::min(q / a, c / q), std::max(q / a, c / q)};
    hits.count = 2;
  }
}

}  // namespace

QuadricHits intersect(const Quadric& quadric, const Vec3& origin, const Vec3& direction) {
  QuadricHits hits;
  if (!is_finite(origin) || !is_finite(direction) || direction == Vec3{}) return hits;
  const double scale = max_abs(direction);
  const Vec3 scaled{direction.x / scale, direction.y / scale, direction.z / scale};
  const double speed = length(scaled);
  const Vec3 o = quadric.frame().local(origin), d = quadric.frame().local_vector((1 / speed) * scaled);
  const double nearest = -dot(o, d);
  solve(along(quadric.diagonal(), o + nearest * d, d), hits);
  int kept = 0;
  for (int k = 0; k < hits.count; ++k) {
    const double t = (hits.t[static_cast<std::size_t>(k)] + nearest) / speed / scale;
    if (std::isfinite(t)) hits.t[static_cast<std::size_t>(kept++)] = t;
  }
  hits.count = kept;
  for (std::size_t k = static_cast<std::size_t>(kept); k < 2; ++k) hits.t[k] = 0;
  return hits;
}

QuadricHits intersect(const QuadricPiece& piece, const Vec3& origin, const Vec3& direction) {
  QuadricHits hits = intersect(piece.quadric(), origin, direction);
  int kept = 0;
  for (int k = 0; k < hits.count; ++k) {
    const double t = hits.t[static_cast<std::size_t>(k)];
    if (piece.locate(origin + t * direction)) hits.t[static_cast<std::size_t>(kept++)] = t;
  }
  hits.count = kept;
  for (std::size_t k = static_cast<std::size_t>(kept); k < 2; ++k) hits.t[k] = 0;
  return hits;
}

}}  // namespace tessera::abi_0_1
