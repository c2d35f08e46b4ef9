#include "ray/leaf/leaf_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/infinity.h"
#include "ray/net/bounded_step.h"
#include "ray/net/edge_on.h"
#include "ray/net/root_certificate.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// These limits bound the time of a search. No result depends on them but for RayQuery::incomplete.
constexpr int max_boxes = 20000;  // a ray takes 1 to 300 boxes; only a surface that runs along the ray takes more
// Each clamped contraction then halves the distance to the root at least, so 60 of them take it from 1 below 2^-53.
constexpr double sure_contraction = 0.5;
constexpr int max_contractions = 60;
// Newton's method doubles the digits: 6 steps take an error of 1/2 to 2^-64. Steps that stay in the square take longer.
constexpr int max_newton_steps = 12;
// Cutting both ends of a box costs two halvings, each of which would leave two boxes of half the width.
constexpr double worth_narrowing = 0.6;
// A step of fewer than 5 units of 2^-52 in [0, 1] is rounding.
constexpr double min_step = 1e-15;
// restrict_net() rounds the ends of a part by a few units of 2^-52. The margin, 4500 units, keeps a root at the very
// end inside, and gives the part a width.
constexpr double cut_margin = 1e-12;

enum class Outcome { none, found, open };

template <int M, int N, bool Rational>
class LeafSearch {
 public:
  LeafSearch(const Leaf& leaf, double tolerance, SearchSpace& space, RayQuery& query)
      : shape_{leaf.degree_u, leaf.degree_v},
        leaf_(leaf),
        tolerance_(tolerance),
        extent_(std::sqrt(tolerance)),
        space_(space),
        query_(query) {}

  void run(const double* net) {
    project<Rational>(shape_, net, query_.line, space_.net(0));
    space_.box(0) = {};
    count_ = 1;  // slot 0 keeps the whole leaf; the stack begins above
    visit(0);
    for (int visited = 1; count_ > 1 && !query_.done(); ++visited) {
      if (visited == max_boxes) {
        query_.incomplete = true;
        return;
      }
      visit(--count_);
    }
  }

 private:
  static constexpr int components = Rational ? 4 : 3;

  /// Hulls of x, y and z as distances; `heaviest` bounds the weight.
  struct Extent {
    Hull x, y, z;
    double heaviest = 1;
    bool off_ray = false;
  };

  Extent extent_of(const double* net) const {
    const int size = shape_.size();
    Extent out;
    for (int k = 0; k < size; ++k) {
      const double scale = Rational ? 1 / net[3 * size + k] : 1;
      out.x.extend(scale * net[k]);
      out.y.extend(scale * net[size + k]);
    }
    // The quotient rounds by less than `rounding_` leaves over.
    out.off_ray = out.x.low > rounding_ || out.x.high < -rounding_ || out.y.low > rounding_ || out.y.high < -rounding_;
    if (out.off_ray) return out;
    if constexpr (Rational) out.heaviest = *std::max_element(net + 3 * size, net + 4 * size);
    for (int k = 0; k < size; ++k) out.z.extend(Rational ? net[2 * size + k] / net[3 * size + k] : net[2 * size + k]);
    const double slack = rounding_ + query_.line.slack;
    out.off_ray = out.z.low - slack > query_.far || out.z.high + slack < query_.near;
    return out;
  }

  /// Returns whether the hull across the direction (dx, dy) misses the ray. The direction is a derivative's, so that
  /// the part is seen edge on. Next to a silhouette no other direction can decide this.
  bool is_off_obliquely(const double* net, double dx, double dy) const {
    const double length = std::sqrt(dx * dx + dy * dy);
    if (!(length > 0)) return false;
    const double nx = -dy / length, ny = dx / length;
    const int size = shape_.size();
    Hull across;
    for (int k = 0; k < size; ++k) {
      const double value = nx * net[k] + ny * net[size + k];
      across.extend(Rational ? value / net[3 * size + k] : value);
    }
    const double rounding = 1.5 * rounding_;  // |nx| + |ny| <= sqrt(2), and the products' rounding
    return across.low > rounding || across.high < -rounding;
  }

  void visit(int slot) {
    const double* const net = space_.net(slot);
    const SearchBox& box = space_.box(slot);
    ++query_.steps;
    rounding_ = search_rounding(shape_.m(), shape_.n(), leaf_.halvings(), box.depth);
    const Extent extent = extent_of(net);
    if (extent.off_ray) return;
    if (lies_on_ray(extent)) return take_nearest_corner(slot, extent.z.low);
    const DerivativeHulls x = derivative_hulls(shape_, net), y = derivative_hulls(shape_, net + shape_.size());
    if (is_off_obliquely(net, x.v.centre(), y.v.centre()) || is_off_obliquely(net, x.u.centre(), y.u.centre())) return;
    const RootCertificate certificate = certify(x, y, shape_.m(), shape_.n(), rounding_, extent.heaviest);
    RootBox within;
    if (certificate.regular) {
      constexpr NetParameters middle{0.5, 0.5};
      const NetValue f = value(net, middle);
      within = roots_near(certificate, f, middle, 0.5);
      if (within.empty()) return;
      if (certificate.contraction() < sure_contraction && decide(slot, certificate, f, middle)) return;
    }
    if (is_small(extent) && is_flat(net, x, y) && take_closest_point(slot, extent.z.low)) return;
    if (box.depth + 4 > SearchSpace::max_depth) {
      query_.incomplete = true;
      return;
    }
    if (certificate.regular && narrow(slot, within)) return;
    if (narrow_edge_on(slot, x, y, extent.heaviest)) return;
    halve(slot, x, y, extent.heaviest);
  }

  NetValue value(const double* net, NetParameters at) const { return evaluate<Rational>(shape_, net, at.u, at.v); }

  /// Returns whether every point lies within the tolerance of the ray, with s in its range or at a single place. Roots
  /// found before do not count, so that the part is the same whichever is searched first.
  bool lies_on_ray(const Extent& extent) const {
    if (std::max(extent.x.largest(), extent.y.largest()) > tolerance_) return false;
    const bool between = extent.z.low >= query_.near && extent.z.high <= query_.line.far + query_.line.slack;
    return between || extent.z.high - extent.z.low <= tolerance_;
  }
  bool is_small(const Extent& extent) const {
    return std::max({extent.x.radius(), extent.y.radius(), extent.z.radius()}) <= 0.5 * extent_;
  }

  /// Returns whether the part leaves its tangent plane at the middle by at most the tolerance across the ray: by the
  /// mean value theorem, by at most half the sum of the derivatives' radii. Its roots are then one place, or lie along
  /// a line that the ray does not leave. A part that is merely small may be folded if weights differ much.
  bool is_flat(const double* net, const DerivativeHulls& x, const DerivativeHulls& y) const {
    const double* const weights = net + 3 * shape_.size();
    const double lightest = Rational ? *std::min_element(weights, weights + shape_.size()) : 1;
    return std::max(x.u.radius() + x.v.radius(), y.u.radius() + y.v.radius()) <= 2 * tolerance_ * lightest;
  }

  /// Takes the nearest corner of a part that lies on the ray. Where loops cut the leaf, the part may be kept elsewhere
  /// than at its corners: then that is the nearest kept point of a grid.
  void take_nearest_corner(int slot, double from) {
    constexpr int finest = 16;
    const int rate = query_.trims == nullptr ? 1 : finest;
    NetParameters nearest;
    double s = infinity;
    for (int i = 0; i <= rate; ++i) {
      for (int j = 0; j <= rate; ++j) {
        const NetParameters at{double(i) / rate, double(j) / rate};
        if (rate > 1 && !is_kept(slot, at)) continue;
        const double here = value(space_.net(slot), at).s();
        if (here >= query_.line.near ? here < s || s < query_.line.near : s == infinity) s = here, nearest = at;
      }
    }
    if (s < infinity) take(slot, nearest, false, from);
  }

  /// Returns the leaf's parameters at a place of a part. A narrowed part may end beyond its leaf by rounding.
  static NetParameters in_leaf(const SearchBox& box, NetParameters at) {
    return {std::min(box.u0 + at.u * box.du, 1.0), std::min(box.v0 + at.v * box.dv, 1.0)};
  }
  /// Sets the root's place in its patch: within the leaf, since sums round monotonically and the leaf's ends are exact.
  void place(NetParameters at, LeafRoot& root) const {
    root.patch = leaf_.patch;
    root.u = leaf_.u0 + at.u * leaf_.du, root.v = leaf_.v0 + at.v * leaf_.dv;
  }

  /// Whether the loops keep a point of a part.
  bool is_kept(int slot, NetParameters at) const {
    LeafRoot point;
    place(in_leaf(space_.box(slot), at), point);
    return query_.trims->side_of(point) != TrimSide::outside;
  }

  /// Takes the point nearest to the ray if it is a root within the tolerance. Other points of the part may come before
  /// it.
  bool take_closest_point(int slot, double from) {
    NetParameters at{0.5, 0.5};
    NetValue f = value(space_.net(slot), at);
    for (int step = 0; step < max_newton_steps && f.residual() > rounding_; ++step) {
      const NetParameters next = bounded_step(f, at);
      const NetValue there = value(space_.net(slot), next);
      if (!(there.residual() < f.residual())) break;
      at = next, f = there;
    }
    return f.residual() <= tolerance_ && take(slot, at, false, from);
  }

  /// Decides a box with at most one root. Returns false if it could not.
  bool decide(int slot, const RootCertificate& certificate, NetValue f, NetParameters at) {
    const Outcome outcome = solve(space_.net(slot), certificate, f, at);
    if (outcome == Outcome::found) take(slot, at, is_root(f), no_part);
    return outcome != Outcome::open;
  }

  bool is_root(const NetValue& f) const { return f.residual() <= 4 * rounding_; }

  Outcome solve(const double* net, const RootCertificate& certificate, NetValue& f, NetParameters& at) const {
    const auto excluded = [&] {
      return roots_near(certificate, f, at, std::min(1.0, root_distance(certificate, f))).empty();
    };
    for (int step = 0; step < max_newton_steps && f.residual() > rounding_; ++step) {
      const NetParameters next = bounded_step(f, at);
      const double moved = std::max(std::abs(next.u - at.u), std::abs(next.v - at.v));
      at = next, f = value(net, at);
      if (f.residual() > tolerance_ && excluded()) return Outcome::none;
      if (moved < min_step) break;
    }
    if (is_root(f)) return Outcome::found;
    const NetValue nearest = f;
    const NetParameters there = at;
    const bool touches = f.residual() <= tolerance_;
    // The clamped contraction converges to the root, or proves that there is none. In the second case a point within
    // the tolerance is not the box's root, and touches.
    bool none = false;
    for (int step = 0; step < max_contractions && !(none = excluded()); ++step) {
      const std::array<double, 2> by = certificate.step(f);
      at = {std::clamp(at.u - by[0], 0.0, 1.0), std::clamp(at.v - by[1], 0.0, 1.0)};
      f = value(net, at);
      if (is_root(f)) return Outcome::found;
    }
    if (!touches) return none ? Outcome::none : f.residual() <= tolerance_ ? Outcome::found : Outcome::open;
    at = there, f = nearest;
    return Outcome::found;
  }

  bool take(int slot, NetParameters at, bool certified, double from) {
    const SearchBox& box = space_.box(slot);
    NetParameters best = in_leaf(box, at);
    NetValue f = value(space_.net(0), best);
    for (int step = 0; step < 3 && certified; ++step) {  // the leaf's own net has the least rounding
      const NetParameters next = bounded_step(f, best);
      const NetValue there = value(space_.net(0), next);
      if (!(there.residual() < f.residual())) break;
      best = next, f = there;
    }
    LeafRoot root;
    place(best, root);
    root.s = f.s();
    root.residual = f.residual();
    root.noise = search_rounding(shape_.m(), shape_.n(), leaf_.halvings(), 0);
    // A point that is clamped to a border and off the ray by more than rounding touches: the root lies beyond.
    root.certified = certified && root.residual <= 2 * root.noise;
    root.from = from;
    if (from != no_part || !set_gain(f, leaf_.du, leaf_.dv, root)) {
      root.part_u = std::min(1.0, 2 * box.du) * leaf_.du, root.part_v = std::min(1.0, 2 * box.dv) * leaf_.dv;
    }
    return query_.take(root);
  }

  /// Cuts a box down to the rectangle of its roots, if that pays.
  bool narrow(int slot, const RootBox& within) {
    if (std::min(within.width(0), within.width(1)) > worth_narrowing) return false;
    int target = slot;
    if (slot == 0) {  // the leaf's own net is needed again
      target = 1;
      std::copy(space_.net(0), space_.net(0) + components * shape_.size(), space_.net(1));
      space_.box(1) = space_.box(0);
    }
    SearchBox& box = space_.box(target);
    for (int i = 0; i < 2; ++i) {
      const double low = std::max(0.0, within.low[i] - cut_margin), high = std::min(1.0, within.high[i] + cut_margin);
      if (high - low > worth_narrowing) continue;
      restrict_net(shape_, components, space_.net(target), i == 0, low, high);
      double& start = i == 0 ? box.u0 : box.v0;
      double& width = i == 0 ? box.du : box.dv;
      start += low * width;
      width *= high - low;
      box.depth += 2;
    }
    count_ = target + 1;
    return true;
  }

  /// Narrows a box for which x and y together decide nothing, as next to a silhouette. Returns true also if nothing of
  /// the box remains. All points that it cuts off are further from the ray than the tolerance.
  bool narrow_edge_on(int slot, const DerivativeHulls& x, const DerivativeHulls& y, double heaviest) {
    const EdgeOn seen(x, y, std::max(shape_.m(), shape_.n()), tolerance_ * heaviest, rounding_ * heaviest);
    if (!seen.grows()) return false;
    const double* const net = space_.net(slot);
    const RootBox within = seen.roots(shape_, net, [&](NetParameters at) { return value(net, at); });
    return within.empty() || narrow(slot, within);
  }

  /// Halves a box across its longer side as the ray sees it, or along the ray if it sees none. The half that seems
  /// nearer is searched first.
  void halve(int slot, const DerivativeHulls& x, const DerivativeHulls& y, double heaviest) {
    const double* const net = space_.net(slot);
    const auto length = [](const Hull& a, const Hull& b) { return a.largest() + b.largest(); };
    double along_u = length(x.u, y.u), along_v = length(x.v, y.v);
    if (std::max(along_u, along_v) <= tolerance_ * heaviest) {
      const DerivativeHulls z = derivative_hulls(shape_, net + 2 * shape_.size());
      along_u = z.u.largest(), along_v = z.v.largest();
    }
    const bool by_u = along_u >= along_v;
    const double ahead = by_u ? value(net, {1, 0.5}).s() - value(net, {0, 0.5}).s()
                              : value(net, {0.5, 1}).s() - value(net, {0.5, 0}).s();
    const int far = slot == 0 ? 1 : slot, near = far + 1;
    const int lower = ahead >= 0 ? near : far, upper = ahead >= 0 ? far : near;
    SearchBox half = space_.box(slot);
    ++half.depth;
    (by_u ? half.du : half.dv) *= 0.5;
    tessera::halve(shape_, components, net, by_u, space_.net(lower), space_.net(upper));
    space_.box(lower) = half;
    (by_u ? half.u0 : half.v0) += by_u ? half.du : half.dv;
    space_.box(upper) = half;
    count_ = near + 1;
  }

  NetShape<M, N> shape_;
  const Leaf& leaf_;
  double tolerance_, extent_;
  double rounding_ = 0;
  SearchSpace& space_;
  RayQuery& query_;
  int count_ = 0;
};

template <int M, int N, bool Rational>
void run(const Leaf& leaf, const double* net, double tolerance, SearchSpace& space, RayQuery& query) {
  LeafSearch<M, N, Rational>(leaf, tolerance, space, query).run(net);
}

}  // namespace

double search_rounding(int degree_u, int degree_v, int halvings, int depth) {
  constexpr double unit = 4 * 0.5 * std::numeric_limits<double>::epsilon();
  return unit * (32 + 4 * (degree_u + degree_v) * (1 + halvings) + 4 * std::max(degree_u, degree_v) * depth);
}

bool set_gain(const NetValue& f, double du, double dv, LeafRoot& root) {
  const double inverse = f.w / std::abs(f.xu * f.yv - f.xv * f.yu);
  root.gain_u = (std::abs(f.xv) + std::abs(f.yv)) * inverse * du;
  root.gain_v = (std::abs(f.xu) + std::abs(f.yu)) * inverse * dv;
  root.upwards = f.xu * f.yv > f.xv * f.yu;
  if (std::isfinite(root.gain_u) && std::isfinite(root.gain_v)) return true;
  root.gain_u = root.gain_v = 0;
  return false;
}

void search_leaf(const Leaf& leaf, const double* net, double tolerance, SearchSpace& space, RayQuery& query) {
  const bool cubic = leaf.degree_u == 3 && leaf.degree_v == 3, quadratic = leaf.degree_u == 2 && leaf.degree_v == 2;
  if (leaf.rational) {
    if (quadratic) return run<2, 2, true>(leaf, net, tolerance, space, query);
    return run<0, 0, true>(leaf, net, tolerance, space, query);
  }
  if (cubic) return run<3, 3, false>(leaf, net, tolerance, space, query);
  run<0, 0, false>(leaf, net, tolerance, space, query);
}

}}  // namespace tessera::abi_0_1
