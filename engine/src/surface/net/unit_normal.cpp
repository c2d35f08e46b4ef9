#include <limits>

#include "surface/net/difference_net.h"
#include "tessera/bezier_patch.h"

// Near a point, N(u + h, v + k) = r_u x r_v + h D_u + k D_v + O(h^2 + k^2) with D_u = r_uu x r_v + r_u x r_uv and
// D_v = r_uv x r_v + r_u x r_vv. Where r_u x r_v vanishes, the directions (h, k) that lead into the patch decide.

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Parameters within this distance of an end are seen only from inside the patch.
constexpr double border_width = 0x1p-20;
/// Limits from two sides are equal if they differ by less.
constexpr double same_direction = 1e-6;

/// A vector and a bound of its rounding error.
struct Bounded {
  Vec3 value;
  double error = 0;
  bool vanishes() const { return !(max_abs(value) > error); }
};

Bounded cross(const Bounded& a, const Bounded& b) {
  return {cross(a.value, b.value), a.error * length(b.value) + length(a.value) * b.error};
}
Bounded operator+(const Bounded& a, const Bounded& b) { return {a.value + b.value, a.error + b.error}; }

template <int A, int B>
Bounded bounded_derivative(const HomogeneousNet& net, const LoweredBernstein& u, const LoweredBernstein& v) {
  const double unit = 16 * (u.degree + v.degree) * std::numeric_limits<double>::epsilon();
  return {derivative<A, B>(net, u, v).vector(), unit * derivative_magnitude<A, B>(net, u, v)};
}

/// Moves a rational net so that the point at the parameters is zero. Then r vanishes from the quotient rule, and
/// numerators are enough for the direction of r_u x r_v and, where that vanishes, the directions of D_u and D_v.
void move_to_point(HomogeneousNet& net, const LoweredBernstein& u, const LoweredBernstein& v) {
  const Vec3 r = derivative<0, 0>(net, u, v).project();
  for (std::size_t k = 0; k < net.size(); ++k) {
    Homogeneous& p = net.points[k];
    p = {p.x - p.w * r.x, p.y - p.w * r.y, p.z - p.w * r.z, p.w};
  }
}

/// The one direction on which all views from inside the patch agree.
class CommonLimit {
 public:
  void see(const Bounded& first_order, double parameter) {
    if (first_order.vanishes()) return;
    const Vec3 direction = normalized(first_order.value);
    if (parameter < 1 - border_width) see(direction);
    if (parameter > border_width) see(-direction);
  }
  UnitNormal result() const {
    if (!found_ || contradicted_) return {};
    return {direction_, NormalKind::limit};
  }

 private:
  void see(const Vec3& direction) {
    if (found_ && !(length(direction - direction_) < same_direction)) contradicted_ = true;
    if (!found_) direction_ = direction;
    found_ = true;
  }

  Vec3 direction_;
  bool found_ = false, contradicted_ = false;
};

}  // namespace

UnitNormal unit_normal(const BezierPatch& patch, double u, double v) {
  HomogeneousNet net(patch, nearest_corner(patch, u, v));
  const LoweredBernstein bu(patch.degree_u(), u), bv(patch.degree_v(), v);
  if (patch.is_rational()) move_to_point(net, bu, bv);
  const Bounded ru = bounded_derivative<1, 0>(net, bu, bv), rv = bounded_derivative<0, 1>(net, bu, bv);
  const Bounded normal = cross(ru, rv);
  if (!normal.vanishes()) return {normalized(normal.value), NormalKind::regular};

  const Bounded ruu = bounded_derivative<2, 0>(net, bu, bv), ruv = bounded_derivative<1, 1>(net, bu, bv);
  const Bounded rvv = bounded_derivative<0, 2>(net, bu, bv);
  CommonLimit limit;
  limit.see(cross(ruu, rv) + cross(ru, ruv), u);
  limit.see(cross(ruv, rv) + cross(ru, rvv), v);
  return limit.result();
}

}}  // namespace tessera::abi_0_1
