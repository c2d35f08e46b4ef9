#include "tess/bounds/sweep_normal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "basis/bernstein.h"
#include "surface/net/homogeneous.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

template <class T>
using Coefficients = std::array<T, 2 * max_degree + 1>;

double times(double a, double b) { return a * b; }
Vec3 times(const Vec3& a, double b) { return b * a; }
Vec3 times(const Vec3& a, const Vec3& b) { return cross(a, b); }

/// Writes the coefficients of f' g - f g', of degree 2 `degree` - 2, for `f` and `g` of one degree; the product may be
/// a cross product. With x = t / (1 - t), F(x) = f(t) / (1 - t)^n has the coefficients C(n,k) f_k, and
/// f' g - f g' = (1 - t)^(2 n - 2) (F' G - F G').
template <class F, class G, class T>
void wronskian(const Coefficients<F>& f, const Coefficients<G>& g, int degree, Coefficients<T>& out) {
  for (int k = 0; k <= 2 * degree - 2; ++k) {
    T sum{};
    for (int i = std::max(0, k + 1 - degree); i <= std::min(degree, k + 1); ++i) {
      const int j = k + 1 - i;
      const double factor = (i - j) * binomial(degree, i) * binomial(degree, j);
      sum = sum + factor * times(f[static_cast<std::size_t>(i)], g[static_cast<std::size_t>(j)]);
    }
    out[static_cast<std::size_t>(k)] = 1 / binomial(2 * degree - 2, k) * sum;
  }
}

/// Finds the curves of a sweep, and its field.
class Sweep {
 public:
  /// `is_turned`: the profile runs along v.
  Sweep(const HomogeneousNet& net, SideMask poles, bool is_turned)
      : net_(net),
        is_turned_(is_turned),
        m_(is_turned ? net.degree_v : net.degree_u),
        n_(is_turned ? net.degree_u : net.degree_v),
        pole_low_(poles.has(is_turned ? Side::u0 : Side::v0)),
        pole_high_(poles.has(is_turned ? Side::u1 : Side::v1)) {}

  std::optional<NormalNet> field() {
    if (!find_curves()) return {};
    const double deviation = this->deviation();
    constexpr double most = 0x1p-30;
    if (!(deviation <= most)) return {};
    return make_field(deviation);
  }

 private:
  const Homogeneous& at(int i, int j) const { return is_turned_ ? net_.at(j, i) : net_.at(i, j); }
  Vec3 point(int i, int j) const { return at(i, j).project(); }

  /// Takes the profile from the row where it is largest. Returns whether the scales have one sign.
  bool find_curves() {
    int widest = 0;
    double most = 0;
    for (int j = 0; j <= n_; ++j)
      for (int i = 1; i <= m_; ++i)
        if (const double size = max_abs(point(i, j) - point(0, j)); size > most) most = size, widest = j;
    double squares = 0;
    for (int i = 0; i <= m_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      e_[k] = point(i, widest) - point(0, widest), a_[k] = at(i, 0).w / at(0, 0).w;
      squares += dot(e_[k], e_[k]);
    }
    is_even_ = true;
    for (int j = 0; j <= n_; ++j) {
      const auto k = static_cast<std::size_t>(j);
      double sum = 0;
      for (int i = 1; i <= m_; ++i) sum += dot(point(i, j) - point(0, j), e_[static_cast<std::size_t>(i)]);
      const bool is_pole = (j == 0 && pole_low_) || (j == n_ && pole_high_);
      c_[k] = point(0, j), b_[k] = at(0, j).w, r_[k] = is_pole ? 0 : sum / squares;
      if (std::abs(r_[k] - 1) <= 0x1p-40) r_[k] = 1;
      is_even_ = is_even_ && r_[k] == 1;
      if (!(r_[k] > 0 || is_pole)) return false;
    }
    return true;
  }

  /// Returns by how much points and weights differ from those of the curves, relative to the largest.
  double deviation() {
    double points = 0, weights = 0;
    for (int i = 0; i <= m_; ++i)
      for (int j = 0; j <= n_; ++j) {
        const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
        const Homogeneous& of = at(i, j);
        size_ = std::max(size_, length(of.vector())), weight_ = std::max(weight_, of.w);
        const double w = a_[k] * b_[l];
        weights = std::max(weights, std::abs(of.w - w));
        points = std::max(points, length(of.vector() - w * (c_[l] + r_[l] * e_[k])));
      }
    return std::max(points / size_, weights / weight_) + 0x1p-48;
  }

  static bool is_constant(const Coefficients<double>& weights, int degree) {
    return std::all_of(weights.begin(), weights.begin() + degree + 1, [&](double w) { return w == weights[0]; });
  }

  NormalNet make_field(double deviation) {
    scale_curves();
    const bool flat_a = is_even_ && is_constant(a_, m_), flat_b = is_constant(b_, n_);
    const int p = flat_a ? m_ - 1 : 2 * m_ - 2, q = flat_b ? n_ - 1 : 2 * n_ - 2;
    Coefficients<Vec3> across{}, turning{}, along{};
    Coefficients<double> widening{};
    flat_a ? differences(e_, m_, a_[0], across) : wronskian(e_, a_, m_, across);
    flat_b ? differences(c_, n_, b_[0], along) : wronskian(c_, b_, n_, along);
    if (!is_even_) {
      wronskian(e_, e_, m_, turning);  // 2 E' x E: f g' is g f', turned around
      flat_b ? differences(r_, n_, b_[0], widening) : wronskian(r_, b_, n_, widening);
    }
    NormalNet out;
    out.net.degree_u = is_turned_ ? q : p;
    out.net.degree_v = is_turned_ ? p : q;
    out.net.at.resize(static_cast<std::size_t>((p + 1) * (q + 1)));
    double term = 0;
    for (int i = 0; i <= p; ++i)
      for (int j = 0; j <= q; ++j) {
        const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
        const Vec3 field = cross(across[k], along[l]) + (0.5 * widening[l]) * turning[k];
        (is_turned_ ? out.net(j, i) : out.net(i, j)) = is_turned_ ? -1.0 * field : field;
        term = std::max(term, length(across[k]) * length(along[l]) + std::abs(widening[l]) * length(turning[k]));
      }
    out.rounding = 0x1p-44 * term + deviation_of_field(deviation);
    return out;
  }

  /// Turns points into homogeneous coefficients.
  void scale_curves() {
    for (std::size_t k = 0; k <= static_cast<std::size_t>(m_); ++k) e_[k] = a_[k] * e_[k];
    for (std::size_t k = 0; k <= static_cast<std::size_t>(n_); ++k) c_[k] = b_[k] * c_[k], r_[k] = b_[k] * r_[k];
  }
  template <class T>
  static void differences(const Coefficients<T>& of, int degree, double weight, Coefficients<T>& out) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(degree); ++k) out[k] = degree * weight * (of[k + 1] - of[k]);
  }

  /// Bounds d / (a R), where R is divided by v and 1 - v at poles, and a quarter of its first derivatives. The
  /// numerator has 3 terms of 3 factors each, of relative error `deviation`, and derivatives of up to 2 (3 m - 1) times
  /// as much; those of 1 / (a R) are up to 2 max(m, n) times the spread of a and of R.
  double deviation_of_field(double deviation) const {
    const double largest_term = 12.0 * m_ * n_ * size_ * size_ * weight_;
    double error = 4 * deviation * largest_term;
    Coefficients<double> r = r_;
    int degree = n_;
    if (pole_low_) {  // B_{k+1,n}(v) / v = n / (k+1) B_{k,n-1}(v)
      for (int k = 0; k < degree; ++k)
        r[static_cast<std::size_t>(k)] = double(degree) / (k + 1) * r[static_cast<std::size_t>(k + 1)];
      --degree, error *= 3 * n_;
    }
    if (pole_high_) {
      for (int k = 0; k < degree; ++k) r[static_cast<std::size_t>(k)] *= double(degree) / (degree - k);
      --degree, error *= 3 * n_;
    }
    const auto [least_a, most_a] = std::minmax_element(a_.begin(), a_.begin() + m_ + 1);
    const auto [least_r, most_r] = std::minmax_element(r.begin(), r.begin() + degree + 1);
    const double spread = std::max(*most_a / *least_a, *most_r / *least_r);
    return 8.0 * std::max(m_, n_) * spread * error / (*least_a * *least_r);
  }

  const HomogeneousNet& net_;
  bool is_turned_;
  int m_, n_;
  bool pole_low_, pole_high_;
  bool is_even_ = true;             ///< whether the scales are all 1
  Coefficients<Vec3> e_{}, c_{};    ///< the profile, and the path
  Coefficients<double> a_{}, b_{};  ///< their weights
  Coefficients<double> r_{};        ///< the scales
  double size_ = 0, weight_ = 0;    ///< the largest of the net
};

}  // namespace

std::optional<NormalNet> sweep_normal_net(const BezierPatch& patch) {
  const HomogeneousNet net(patch, patch.point(0, 0));
  const SideMask poles = patch.collapsed_sides();
  for (const bool is_turned : {false, true}) {
    // A profile that begins or ends at a pole has no direction there.
    if (is_turned ? poles.has(Side::v0) || poles.has(Side::v1) : poles.has(Side::u0) || poles.has(Side::u1)) continue;
    std::optional<NormalNet> field = Sweep(net, poles, is_turned).field();
    if (!field) continue;
    double most = 0;
    for (const Vec3& n : field->net.at) most = std::max(most, max_abs(n));
    constexpr double share = 0x1p-20;
    if (field->rounding <= share * most) return field;
  }
  return {};
}

}}  // namespace tessera::abi_0_1
