#pragma once
// A reference for rays: interval arithmetic in double with outward rounding over every patch, without bounding volumes.
// It finds hits and misses that are proven, and lists those that it could not decide. Shares only the patches with the
// library.
//
// The conditions are exact for the doubles of the input. With a the largest component of the direction D, they are
//   g_b = w ((P_b - o_b) D_a - (P_a - o_a) D_b) = 0 for both other components b, and t = (P_a - o_a) / D_a,
// evaluated at each control point in quadruple precision, enclosed in a double interval, and from there on only in
// intervals.

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/ray_scene.h"

namespace tessera::test {

struct Interval {
  double lo = 0, hi = 0;

  /// More than the error of an operation rounded to nearest.
  static double slip(double x) { return std::abs(x) * 0x1p-52 + 0x1p-1060; }
  static Interval around(double lo, double hi) { return {lo - slip(lo), hi + slip(hi)}; }
  static Interval at(double x) { return {x, x}; }
  double middle() const { return 0.5 * lo + 0.5 * hi; }
  double width() const { return hi - lo; }
  bool holds(double x) const { return lo <= x && x <= hi; }
};
inline Interval operator+(Interval a, Interval b) { return Interval::around(a.lo + b.lo, a.hi + b.hi); }
inline Interval operator-(Interval a, Interval b) { return Interval::around(a.lo - b.hi, a.hi - b.lo); }
inline Interval operator*(Interval a, Interval b) {
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return Interval::around(std::min({p, q, r, s}), std::max({p, q, r, s}));
}
inline Interval operator*(double a, Interval b) {
  return a < 0 ? Interval::around(a * b.hi, a * b.lo) : Interval::around(a * b.lo, a * b.hi);
}
/// Requires that b does not contain 0.
inline Interval operator/(Interval a, Interval b) {
  const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
  return Interval::around(std::min({p, q, r, s}), std::max({p, q, r, s}));
}
inline Interval join(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline bool meet(Interval a, Interval b) { return a.lo <= b.hi && b.lo <= a.hi; }

/// Interval coefficients of g_b, g_c, w t, w on a rectangle of a patch.
class IntervalNet {
 public:
  static constexpr int max_net_degree = 7;

  IntervalNet(const BezierPatch& patch, const Ray& ray)
      : m_(patch.degree_u()), n_(patch.degree_v()), count_(static_cast<std::size_t>((m_ + 1) * (n_ + 1))) {
    assert(m_ <= max_net_degree && n_ <= max_net_degree);
    const Axes axes(ray);
    for (std::size_t k = 0; k < count_; ++k) {
      const Vec3& p = patch.points()[k];
      const std::array<double, 3> x{p.x, p.y, p.z};
      const double w = patch.is_rational() ? patch.weights()[k] : 1;
      for (std::size_t c = 0; c < 2; ++c) c_[c][k] = w * axes.across(x, c);
      c_[2][k] = w * axes.along(x);
      c_[3][k] = Interval::at(w);
    }
  }
  /// Whether it is certain, without quadruple precision, that no point of the patch lies on the ray's line: all g of
  /// one kind have one sign, by more than the rounding of differences, products and their difference.
  static bool is_off(const BezierPatch& patch, const Ray& ray) {
    const Axes axes(ray);
    for (std::size_t c = 0; c < 2; ++c) {
      bool above = true, below = true;
      for (const Vec3& p : patch.points()) {
        const auto [value, off] = axes.rounded_across({p.x, p.y, p.z}, c);
        above = above && value > off;
        below = below && value < -off;
      }
      if (above || below) return true;
    }
    return false;
  }

  int degree_u() const { return m_; }
  int degree_v() const { return n_; }

  Interval hull(std::size_t c) const {
    Interval out = c_[c][0];
    for (std::size_t k = 1; k < count_; ++k) out = join(out, c_[c][k]);
    return out;
  }
  /// The largest |g|.
  double magnitude() const {
    const Interval a = hull(0), b = hull(1);
    return std::max(std::max(-a.lo, a.hi), std::max(-b.lo, b.hi));
  }
  Interval t_hull() const {
    Interval out = c_[2][0] / c_[3][0];
    for (std::size_t k = 1; k < count_; ++k) out = join(out, c_[2][k] / c_[3][k]);
    return out;
  }
  /// The derivative of g over the rectangle's own [0,1]^2.
  Interval slope(std::size_t c, bool by_u) const {
    Interval out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (int i = 0; i + (by_u ? 1 : 0) <= m_; ++i) {
      for (int j = 0; j + (by_u ? 0 : 1) <= n_; ++j) {
        out = join(out, c_[c][by_u ? index(i + 1, j) : index(i, j + 1)] - c_[c][index(i, j)]);
      }
    }
    return static_cast<double>(by_u ? m_ : n_) * out;
  }
  /// g in the middle of the rectangle.
  Interval middle(std::size_t c) const {
    std::array<Interval, max_net_degree + 1> column{};
    for (int i = 0; i <= m_; ++i) column[static_cast<std::size_t>(i)] = halved(&c_[c][index(i, 0)], n_);
    return halved(column.data(), m_);
  }
  /// Restricted to [from, to] of its own parameter.
  IntervalNet part(bool along_u, double from, double to) const {
    IntervalNet out = *this;
    const int lines = along_u ? n_ : m_, degree = along_u ? m_ : n_;
    const std::size_t step = along_u ? index(1, 0) : 1;
    for (std::size_t c = 0; c < 4; ++c) {
      for (int line = 0; line <= lines; ++line)
        restrict_row(&out.c_[c][along_u ? index(0, line) : index(line, 0)], step, degree, from, to);
    }
    return out;
  }

 private:
  __extension__ typedef __float128 Quad;

  /// The ray's largest direction a; computes g and t of a point.
  class Axes {
   public:
    explicit Axes(const Ray& ray)
        : d_{ray.direction.x, ray.direction.y, ray.direction.z}, o_{ray.origin.x, ray.origin.y, ray.origin.z} {
      for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(d_[k]) > std::abs(d_[a_])) a_ = k;
      const int exponent = -std::ilogb(d_[a_]);
      for (std::size_t k = 0; k < 3; ++k) scaled_[k] = std::ldexp(d_[k], exponent);
    }
    Interval across(const std::array<double, 3>& x, std::size_t c) const {
      const std::size_t b = (a_ + 1 + c) % 3;
      const Quad value = (static_cast<Quad>(x[b]) - static_cast<Quad>(o_[b])) * static_cast<Quad>(scaled_[a_]) -
                         (static_cast<Quad>(x[a_]) - static_cast<Quad>(o_[a_])) * static_cast<Quad>(scaled_[b]);
      return enclosed(value, magnitude(x, b));
    }
    Interval along(const std::array<double, 3>& x) const {
      return enclosed((static_cast<Quad>(x[a_]) - static_cast<Quad>(o_[a_])) / static_cast<Quad>(d_[a_]), 0);
    }
    /// across() in double, and a bound above its rounding.
    std::pair<double, double> rounded_across(const std::array<double, 3>& x, std::size_t c) const {
      const std::size_t b = (a_ + 1 + c) % 3;
      return {(x[b] - o_[b]) * scaled_[a_] - (x[a_] - o_[a_]) * scaled_[b], 0x1p-49 * magnitude(x, b) + 0x1p-1000};
    }

   private:
    /// The largest term of the sum.
    double magnitude(const std::array<double, 3>& x, std::size_t b) const {
      return (std::abs(x[b]) + std::abs(o_[b])) * std::abs(scaled_[a_]) +
             (std::abs(x[a_]) + std::abs(o_[a_])) * std::abs(scaled_[b]);
    }
    static Interval enclosed(Quad x, double magnitude) {
      const double near = static_cast<double>(x), off = Interval::slip(near) + magnitude * 0x1p-100;
      return {near - off, near + off};
    }

    std::array<double, 3> d_, o_, scaled_{};
    std::size_t a_ = 0;
  };

  /// 0.5 a + 0.5 b.
  static Interval between(Interval a, Interval b) {
    return Interval::around(0.5 * a.lo + 0.5 * b.lo, 0.5 * a.hi + 0.5 * b.hi);
  }
  static Interval halved(const Interval* row, int degree) {
    std::array<Interval, max_net_degree + 1> b{};
    std::copy_n(row, degree + 1, b.begin());
    for (int level = 1; level <= degree; ++level)
      for (int k = 0; k + level <= degree; ++k) {
        const auto at = static_cast<std::size_t>(k);
        b[at] = between(b[at], b[at + 1]);
      }
    return b[0];
  }
  /// (1 - t) a + t b for t in [0, 1].
  static Interval blend(Interval a, Interval b, Interval t) {
    const Interval rest = Interval::at(1) - t;
    return share(a, {std::max(rest.lo, 0.0), rest.hi}) + share(b, t);
  }
  /// t a for t >= 0: two products instead of four.
  static Interval share(Interval a, Interval t) {
    return Interval::around((a.lo < 0 ? t.hi : t.lo) * a.lo, (a.hi < 0 ? t.lo : t.hi) * a.hi);
  }
  static void restrict_row(Interval* row, std::size_t step, int degree, double from, double to) {
    const auto at = [&](int k) -> Interval& { return row[static_cast<std::size_t>(k) * step]; };
    const bool halves = to == 0.5;
    if (to < 1) {  // the left part, by de Casteljau's algorithm
      for (int level = 1; level <= degree; ++level) {
        for (int k = degree; k >= level; --k)
          at(k) = halves ? between(at(k - 1), at(k)) : blend(at(k - 1), at(k), Interval::at(to));
      }
    }
    if (from > 0) {  // of that, the right one
      const bool from_middle = from == 0.5 && to == 1;
      const Interval t = Interval::at(from) / Interval::at(to);
      for (int level = 1; level <= degree; ++level) {
        for (int k = 0; k + level <= degree; ++k)
          at(k) = from_middle ? between(at(k), at(k + 1)) : blend(at(k), at(k + 1), t);
      }
    }
  }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * (n_ + 1) + j); }

  int m_, n_;
  std::size_t count_;
  std::array<std::array<Interval, (max_net_degree + 1) * (max_net_degree + 1)>, 4> c_;
};

/// The findings of the reference on a ray.
struct Verdict {
  struct Root {
    std::uint32_t patch = 0;
    Interval t, u, v;
  };
  std::vector<Root> hits;       ///< proven, t inside [tnear, tfar]; a hit may occur twice
  std::vector<Root> undecided;  ///< there may be a hit

  bool hit() const { return !hits.empty(); }
  bool miss() const { return hits.empty() && undecided.empty(); }
  /// The first of the proven hits by the upper end of its t.
  const Root& first() const {
    return *std::min_element(hits.begin(), hits.end(), [](const Root& a, const Root& b) { return a.t.hi < b.t.hi; });
  }
};

class Reference {
 public:
  Reference(std::span<const BezierPatch> patches, const Ray& ray) : ray_(ray) {
    for (patch_ = 0; patch_ < patches.size(); ++patch_) {
      if (IntervalNet::is_off(patches[patch_], ray)) continue;
      whole_ = IntervalNetHolder(patches[patch_], ray);
      scale_ = whole_.net().magnitude();
      decide(whole_.net(), {{0, 1}, {0, 1}});
    }
  }
  const Verdict& verdict() const { return verdict_; }

 private:
  struct Place {
    Interval u, v;  // exact ends
  };
  /// Holds a net by value, assignable from parts.
  class IntervalNetHolder {
   public:
    IntervalNetHolder() = default;
    IntervalNetHolder(const BezierPatch& patch, const Ray& ray) { nets_.emplace_back(patch, ray); }
    const IntervalNet& net() const { return nets_.front(); }

   private:
    std::vector<IntervalNet> nets_;
  };
  enum class Test { none, one, at_most_one, open };
  static constexpr int max_boxes = 1000;    // of one ray
  static constexpr double smallest = 1e-7;  // of a rectangle's sides; for g its square

  /// Krawczyk's operator on the net's square (Neumaier, Interval Methods for Systems of Equations, sec. 5.1): K = c -
  /// A f(c) + (I - A J)(X - c). K inside of X: one root; K off X: none.
  Test krawczyk(const IntervalNet& net, Interval& u, Interval& v) const {
    u = v = {0, 1};
    const Interval j[2][2] = {{net.slope(0, true), net.slope(0, false)}, {net.slope(1, true), net.slope(1, false)}};
    const double a = j[0][0].middle(), b = j[0][1].middle(), c = j[1][0].middle(), d = j[1][1].middle();
    const double determinant = a * d - b * c;
    const double inverse[2][2] = {{d / determinant, -b / determinant}, {-c / determinant, a / determinant}};
    if (!std::isfinite(inverse[0][0]) || !std::isfinite(inverse[0][1]) || !std::isfinite(inverse[1][0]) ||
        !std::isfinite(inverse[1][1]))
      return Test::open;
    const Interval f[2] = {net.middle(0), net.middle(1)};
    const Interval half{-0.5, 0.5};
    Interval k[2];
    double norm = 0;
    for (int i = 0; i < 2; ++i) {
      Interval sum = Interval::at(0.5) - (inverse[i][0] * f[0] + inverse[i][1] * f[1]);
      double row = 0;
      for (int l = 0; l < 2; ++l) {
        const Interval r = Interval::at(i == l ? 1 : 0) - (inverse[i][0] * j[0][l] + inverse[i][1] * j[1][l]);
        sum = sum + r * half;
        row += std::max(std::abs(r.lo), std::abs(r.hi)) * (1 + 0x1p-50);
      }
      k[i] = sum;
      norm = std::max(norm, row);
    }
    if (k[0].hi < 0 || k[0].lo > 1 || k[1].hi < 0 || k[1].lo > 1) return Test::none;
    u = {std::max(0.0, k[0].lo), std::min(1.0, k[0].hi)}, v = {std::max(0.0, k[1].lo), std::min(1.0, k[1].hi)};
    if (k[0].lo > 0 && k[0].hi < 1 && k[1].lo > 0 && k[1].hi < 1) return Test::one;
    return norm < 1 ? Test::at_most_one : Test::open;
  }

  bool excluded(const IntervalNet& net) const {
    for (std::size_t c = 0; c < 2; ++c) {
      const Interval g = net.hull(c);
      if (g.lo > 0 || g.hi < 0) return true;
    }
    return !meet(net.t_hull(), {ray_.tnear, ray_.tfar});
  }

  static double point(Interval range, double at) { return range.lo + at * (range.hi - range.lo); }

  void decide(const IntervalNet& net, const Place& place) {
    if (excluded(net)) return;
    Interval u, v;
    const Test test = krawczyk(net, u, v);
    if (test == Test::none) return;
    if (test == Test::one || test == Test::at_most_one) {
      if (settle(place, u, v)) return;
    }
    const auto size = [&](bool by_u) {
      const Interval a = net.slope(0, by_u), b = net.slope(1, by_u);
      return std::max(-a.lo, a.hi) + std::max(-b.lo, b.hi);
    };
    const double size_u = size(true), size_v = size(false);
    const bool tiny = place.u.width() < smallest && place.v.width() < smallest;
    if (++visited_ > max_boxes || tiny || size_u + size_v < smallest * smallest * scale_) {
      verdict_.undecided.push_back({patch_, net.t_hull(), place.u, place.v});
      return;
    }
    const bool by_u = place.v.width() < smallest || (place.u.width() >= smallest && size_u >= size_v);
    const Interval whole = by_u ? place.u : place.v;
    const double middle = 0.5 * (whole.lo + whole.hi);
    for (int half = 0; half < 2; ++half) {
      Place part = place;
      (by_u ? part.u : part.v) = half == 0 ? Interval{whole.lo, middle} : Interval{middle, whole.hi};
      decide(net.part(by_u, half * 0.5, 0.5 + half * 0.5), part);
    }
  }

  /// A box that holds at most one root, which lies in u x v of it: encloses it in a box inside the patch that proves
  /// one root or none. False if neither is proven.
  bool settle(const Place& place, Interval u, Interval v) {
    Place around{{point(place.u, u.lo), point(place.u, u.hi)}, {point(place.v, v.lo), point(place.v, v.hi)}};
    double last_width = 1;
    for (int turn = 0; turn < 60; ++turn) {
      const auto widened = [](Interval x) {
        const double by = 0.25 * x.width() + 1e-14;
        return Interval{std::max(0.0, x.lo - by), std::min(1.0, x.hi + by)};
      };
      const Place box{widened(around.u), widened(around.v)};
      const IntervalNet net = whole_.net().part(true, box.u.lo, box.u.hi).part(false, box.v.lo, box.v.hi);
      if (excluded(net)) return true;
      Interval ku, kv;
      const Test test = krawczyk(net, ku, kv);
      if (test == Test::none) return true;
      if (test == Test::open) return false;
      around = {{point(box.u, ku.lo), point(box.u, ku.hi)}, {point(box.v, kv.lo), point(box.v, kv.hi)}};
      const double width = std::max(around.u.width(), around.v.width());
      const bool narrowest = turn > 8 && width > 0.95 * last_width;
      last_width = width;
      if (narrowest && test != Test::one) return false;
      if (test == Test::one && turn > 1) {
        const IntervalNet close = net.part(true, ku.lo, ku.hi).part(false, kv.lo, kv.hi);
        const Interval t = close.t_hull();
        if (t.lo >= ray_.tnear && t.hi <= ray_.tfar && (narrowest || t.width() <= 1e-14 * std::abs(t.hi))) {
          verdict_.hits.push_back({patch_, t, around.u, around.v});
          return true;
        }
        if (!meet(t, {ray_.tnear, ray_.tfar})) return true;
      }
    }
    return false;
  }

  const Ray& ray_;
  int visited_ = 0;
  double scale_ = 1;
  std::uint32_t patch_ = 0;
  IntervalNetHolder whole_;
  Verdict verdict_;
};

/// The proofs about points of the patches on the ray.
inline Verdict reference_verdict(std::span<const BezierPatch> patches, const Ray& ray) {
  return Reference(patches, ray).verdict();
}

}  // namespace tessera::test
