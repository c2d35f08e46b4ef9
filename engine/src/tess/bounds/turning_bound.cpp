#include "tess/bounds/turning_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tess/bounds/normal_net.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A quarter is cut into up to 4^max_depth pieces. A bound is good enough within this factor of the turning at corners.
constexpr int max_depth = 5;
constexpr double close_enough = 1.25;
/// Turning per unit of a parameter that is below float's rounding of normals.
constexpr double negligible = 0x1p-20;
/// Radians per unit of a parameter beyond which the normal has nearly no direction somewhere.
constexpr double max_turning = 32;

/// Cuts each row or column of a net at 1/2 by de Casteljau; `low` becomes the lower half.
void cut(VectorNet& high, VectorNet& low, bool along_u) {
  low = high;
  const int degree = along_u ? high.degree_u : high.degree_v, lines = along_u ? high.degree_v : high.degree_u;
  const auto at = [along_u](VectorNet& net, int k, int line) -> Vec3& { return along_u ? net(k, line) : net(line, k); };
  for (int line = 0; line <= lines; ++line)
    for (int k = 0; k <= degree; ++k) {
      at(low, k, line) = at(high, 0, line);
      for (int i = 0; i < degree - k; ++i) at(high, i, line) = 0.5 * at(high, i, line) + 0.5 * at(high, i + 1, line);
    }
}

/// One piece of the field: bounds over it, and the turning at its corners.
class Piece {
 public:
  /// `scale`: the factor from derivatives by the piece's parameters to those by the patch's.
  Piece(const VectorNet& net, double scale, double rounding) : net_(net), scale_(scale), rounding_(rounding) {
    Vec3 sum;
    for (const Vec3& n : net.at) sum += n;
    axis_ = normalized(sum);
    least_ = infinity;
    double steepest = 0, beside = 1;  // the sides, across and along the axis, of the widest angle with it
    for (const Vec3& n : net.at) {
      const double along = dot(n, axis_), across = length(n - along * axis_) + rounding;
      least_ = std::min(least_, along - rounding);
      if (across * beside > steepest * (along - rounding)) steepest = across, beside = along - rounding;
    }
    sine_ = steepest / std::hypot(steepest, beside);  // bound() uses it only if all of the net lies along the axis
  }

  /// Returns the bound. With N within the angle phi of the axis,
  ///   |N_u x n| <= |N_u across the axis| + |N_u along it| sin phi.
  Turning bound() const {
    if (!(least_ > 0)) return {infinity, infinity};
    Turning most;
    differences([&](bool along_u, const Vec3& d, double degree) {
      const double along = dot(d, axis_), across = length(d - along * axis_);
      const double turning =
          degree * scale_ * ((across + 2 * rounding_) + (std::abs(along) + 2 * rounding_) * sine_) / least_;
      double& of = along_u ? most.u : most.v;
      of = std::max(of, turning * (1 + 0x1p-40));
    });
    return std::isnan(most.u + most.v) ? Turning{infinity, infinity} : most;
  }
  /// Returns the largest turning at the corners, a lower bound of the largest over the piece.
  Turning at_corners() const {
    Turning most;
    const int m = net_.degree_u, n = net_.degree_v;
    for (const int i : {0, m})
      for (const int j : {0, n}) {
        const Vec3& normal = net_(i, j);
        const double size = dot(normal, normal);
        if (!(size > rounding_ * rounding_)) continue;
        const int i1 = i == 0 ? std::min(1, m) : m - 1, j1 = j == 0 ? std::min(1, n) : n - 1;
        most.u = std::max(most.u, m * scale_ * length(cross(normal, net_(i1, j))) / size);
        most.v = std::max(most.v, n * scale_ * length(cross(normal, net_(i, j1))) / size);
      }
    return most;
  }

 private:
  /// Calls visit(along u, difference of neighbours, degree) for all neighbours.
  template <class Visit>
  void differences(Visit visit) const {
    for (int i = 0; i <= net_.degree_u; ++i)
      for (int j = 0; j <= net_.degree_v; ++j) {
        if (i < net_.degree_u) visit(true, net_(i + 1, j) - net_(i, j), net_.degree_u);
        if (j < net_.degree_v) visit(false, net_(i, j + 1) - net_(i, j), net_.degree_v);
      }
  }

  const VectorNet& net_;
  double scale_, rounding_;
  Vec3 axis_;
  double least_, sine_;
};

/// Finds the bounds over one quarter.
class Search {
 public:
  Search(const VectorNet& net, double rounding) : rounding_(rounding) { visit(net, 0); }
  Turning bound() const { return std::max(bound_.u, bound_.v) <= max_turning ? bound_ : Turning{infinity, infinity}; }

 private:
  void visit(const VectorNet& net, int depth) {
    const Piece piece(net, std::ldexp(2.0, depth), rounding_);
    const Turning bound = piece.bound(), corners = piece.at_corners();
    true_.u = std::max(true_.u, corners.u);
    true_.v = std::max(true_.v, corners.v);
    if (std::max(true_.u, true_.v) > max_turning) bound_ = {infinity, infinity};
    const auto enough = [](double of, double least, double known) {
      return of <= std::max({close_enough * least, known, negligible});
    };
    if (depth == max_depth || (enough(bound.u, true_.u, bound_.u) && enough(bound.v, true_.v, bound_.v))) {
      bound_.u = std::max(bound_.u, bound.u);
      bound_.v = std::max(bound_.v, bound.v);
      return;
    }
    VectorNet half[2] = {{}, net};
    cut(half[1], half[0], true);
    for (VectorNet& high : half) {
      VectorNet low;
      cut(high, low, false);
      visit(low, depth + 1);
      visit(high, depth + 1);
    }
  }

  double rounding_;
  Turning bound_, true_;
};

/// Calls visit(turning) for each part that a cell may lie in: a cell that may cross the middle takes the larger of both
/// halves.
template <class Visit>
void for_pieces(const std::array<Turning, 4>& quarters, bool even_u, bool even_v, Visit visit) {
  for (int i = 0; i < (even_u ? 2 : 1); ++i)
    for (int j = 0; j < (even_v ? 2 : 1); ++j) {
      Turning most;
      for (int k = even_u ? i : 0; k <= (even_u ? i : 1); ++k)
        for (int l = even_v ? j : 0; l <= (even_v ? j : 1); ++l) {
          const Turning& quarter = quarters[static_cast<std::size_t>(2 * k + l)];
          most = {std::max(most.u, quarter.u), std::max(most.v, quarter.v)};
        }
      visit(most);
    }
}

}  // namespace

TurningBound::TurningBound(const BezierPatch& patch) {
  const NormalNet normal = normal_net(patch);
  VectorNet half[2] = {{}, normal.net};
  cut(half[1], half[0], true);
  for (std::size_t k = 0; k < 2; ++k) {
    VectorNet low;
    cut(half[k], low, false);
    quarters_[2 * k] = Search(low, normal.rounding).bound();
    quarters_[2 * k + 1] = Search(half[k], normal.rounding).bound();
  }
}

bool TurningBound::is_finite() const {
  return std::all_of(quarters_.begin(), quarters_.end(), [](const Turning& t) { return std::isfinite(t.u + t.v); });
}

double TurningBound::angle(Rates rates) const {
  double most = 0;
  for_pieces(quarters_, rates.u % 2 == 0, rates.v % 2 == 0,
             [&](const Turning& t) { most = std::max(most, t.angle(rates)); });
  return most;
}

double TurningBound::needed(double angle, int fixed, bool fixed_u, bool even) const {
  const bool fixed_even = fixed % 2 == 0;
  double rate = 1;
  for_pieces(quarters_, fixed_u ? fixed_even : even, fixed_u ? even : fixed_even, [&](const Turning& t) {
    const double room = angle - 0x1p-21 - (1.0 / fixed + 0x1p-24) * (fixed_u ? t.u : t.v);
    const double other = fixed_u ? t.v : t.u;
    if (other > 0 || !(room >= 0)) rate = std::max(rate, room > 0 ? other / room : infinity);
  });
  return rate;
}

}  // namespace tessera::inline abi_0_1
