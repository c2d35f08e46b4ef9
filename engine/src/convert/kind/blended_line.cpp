#include "convert/kind/blended_line.h"

#include <algorithm>
#include <utility>

#include "convert/basis/polar_forms.h"
#include "surface/net/homogeneous.h"
#include "tessera/convert.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A polynomial on [0,1] by its Bernstein coefficients. Long double, because the surface's points are rounded once, at
/// the end.
using Coefficients = std::vector<long double>;

int degree_of(const Coefficients& a) { return static_cast<int>(a.size()) - 1; }

/// c_k = sum_i C(m,i) C(n,k-i) / C(m+n,k) a_i b_{k-i} (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 6.10).
Coefficients product(const Coefficients& a, const Coefficients& b) {
  const int m = degree_of(a), n = degree_of(b);
  Coefficients c(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      c[i + k] += binomial(m, static_cast<int>(i)) * binomial(n, static_cast<int>(k)) * (a[i] * b[k]);
  for (std::size_t k = 0; k < c.size(); ++k) c[k] /= binomial(m + n, static_cast<int>(k));
  return c;
}

Coefficients elevated(const Coefficients& a, int degree) {
  return product(Coefficients(static_cast<std::size_t>(degree - degree_of(a)) + 1, 1), a);
}

/// Returns the inner knots of `other` that the curve does not have.
std::vector<double> missing_breaks(const Curve& curve, const Curve& other) {
  std::vector<double> missing;
  for (const double t : other.knots()) {
    const bool inner = t > curve.domain().from && t < curve.domain().to;
    const bool stands = std::binary_search(curve.knots().begin(), curve.knots().end(), t);
    if (inner && !stands && (missing.empty() || missing.back() != t)) missing.push_back(t);
  }
  return missing;
}

/// A curve in Bezier pieces with weights near 1. A polynomial curve has weights of degree 0.
class HomogeneousPieces {
 public:
  static Result<HomogeneousPieces> make(const Curve& curve, const Curve& other) {
    const auto finer = insert_knots(curve, missing_breaks(curve, other));
    if (!finer) return finer.status();
    auto pieces = to_bezier(*finer);
    if (!pieces) return pieces.status();
    double scale = 1;
    if (!pieces->weights.empty())
      scale = power_of_two_near(*std::max_element(pieces->weights.begin(), pieces->weights.end()));
    for (double& weight : pieces->weights) weight /= scale;
    return HomogeneousPieces(*std::move(pieces), scale);
  }

  int degree() const { return pieces_.degree; }
  bool is_rational() const { return !pieces_.weights.empty(); }
  const std::vector<double>& breaks() const { return pieces_.breaks; }
  /// Returns the original weights divided by those here: a power of two.
  double scale() const { return scale_; }
  const Vec3& point(std::size_t piece, std::size_t i) const { return pieces_.points[place(piece) + i]; }

  Coefficients weights(std::size_t piece) const {
    if (!is_rational()) return {1};
    const auto from = pieces_.weights.begin() + static_cast<std::ptrdiff_t>(place(piece));
    return {from, from + degree() + 1};
  }
  /// Returns the coefficients of w x, w y or w z.
  Coefficients numerator(std::size_t piece, double Vec3::*component) const {
    Coefficients values;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree()); ++i) {
      const long double w = is_rational() ? pieces_.weights[place(piece) + i] : 1;
      values.push_back(w * point(piece, i).*component);
    }
    return values;
  }

 private:
  HomogeneousPieces(BezierPieces pieces, double scale) : pieces_(std::move(pieces)), scale_(scale) {}
  std::size_t place(std::size_t piece) const { return piece * static_cast<std::size_t>(degree()); }
  BezierPieces pieces_;
  double scale_;
};

/// Returns true if w1 == w2 to the last bit once both have the higher degree.
bool same_weights(const HomogeneousPieces& a, const HomogeneousPieces& b) {
  if (!a.is_rational() || !b.is_rational()) return false;
  const int degree = std::max(a.degree(), b.degree());
  for (std::size_t piece = 0; piece + 1 < a.breaks().size(); ++piece) {
    const Coefficients w1 = elevated(a.weights(piece), degree), w2 = elevated(b.weights(piece), degree);
    for (std::size_t i = 0; i < w1.size(); ++i)
      if (static_cast<double>(w1[i]) != static_cast<double>(w2[i])) return false;
  }
  return true;
}

/// Makes the line piece by piece.
class LineMaker {
 public:
  LineMaker(const HomogeneousPieces& first, const HomogeneousPieces& second, const Blend* blend)
      : curves_{&first, &second}, blend_(blend), same_(same_weights(first, second)) {
    for (std::size_t a = 0; a < 2; ++a) {
      const int factor = same_ || !curves_[1 - a]->is_rational() ? 0 : curves_[1 - a]->degree();
      degree_ = std::max(degree_, curves_[a]->degree() + factor);
    }
    if (blend == nullptr) return;
    const std::size_t order = std::max(blend->first().size(), blend->second().size());
    degree_ = std::max(degree_, degree_of(common_weights(0)) + static_cast<int>(order) - 1);
  }

  int degree() const { return degree_; }

  BlendedLine line() const {
    const std::vector<double>& breaks = curves_[0]->breaks();
    const std::size_t size = (breaks.size() - 1) * static_cast<std::size_t>(degree_) + 1;
    BlendedLine line;
    line.degree = degree_;
    line.breaks = breaks;
    for (auto& curve : line.curves) curve.resize(size);
    if (curves_[0]->is_rational() || curves_[1]->is_rational()) line.weights.resize(size);
    if (blend_ != nullptr)
      for (auto& f : line.blends) f.resize(size);
    for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) fill(line, piece);
    if (blend_ != nullptr)
      for (std::size_t a = 0; a < 2; ++a) {
        line.blends[a].front() = a == 0 ? 1 : 0;
        line.blends[a].back() = a == 0 ? 0 : 1;
      }
    return line;
  }

 private:
  /// Returns W; of the lower degree if the two weight functions are equal.
  Coefficients common_weights(std::size_t piece) const {
    if (same_) return curves_[curves_[0]->degree() <= curves_[1]->degree() ? 0 : 1]->weights(piece);
    return product(curves_[0]->weights(piece), curves_[1]->weights(piece));
  }

  /// Restores the original scale where the weights are those of one curve; products of two stay near 1.
  double scale() const {
    if (same_) return curves_[0]->scale();
    return curves_[0]->is_rational() && curves_[1]->is_rational() ? 1 : curves_[0]->scale() * curves_[1]->scale();
  }

  /// Returns numerator / W, each coefficient divided by the weight of the same index.
  Coefficients over_weights(const Coefficients& numerator, const Coefficients& weights) const {
    Coefficients values = elevated(numerator, degree_);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] /= weights[i];
    return values;
  }

  void fill(BlendedLine& line, std::size_t piece) const {
    const std::size_t first = piece * static_cast<std::size_t>(degree_);
    const Coefficients common = common_weights(piece), weights = elevated(common, degree_);
    for (std::size_t i = 0; i < weights.size() && !line.weights.empty(); ++i)
      line.weights[first + i] = scale() * static_cast<double>(weights[i]);
    for (std::size_t a = 0; a < 2; ++a) fill_curve(line.curves[a], first, piece, a, weights);
    if (blend_ == nullptr) return;
    const Domain domain{line.breaks.front(), line.breaks.back(), 0, 1};
    const double from = domain.local_u(line.breaks[piece]), to = domain.local_u(line.breaks[piece + 1]);
    for (std::size_t a = 0; a < 2; ++a) {
      const Coefficients f = bernstein_coefficients(a == 0 ? blend_->first() : blend_->second(), from, to);
      const Coefficients values = over_weights(product(common, f), weights);
      std::copy(values.begin(), values.end(), line.blends[a].begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

  /// Writes the points of curve a; its ends keep their bits.
  void fill_curve(std::vector<Vec3>& points, std::size_t first, std::size_t piece, std::size_t a,
                  const Coefficients& weights) const {
    const HomogeneousPieces& curve = *curves_[a];
    const Coefficients factor = same_ ? Coefficients{1} : curves_[1 - a]->weights(piece);
    for (double Vec3::*component : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const Coefficients values = over_weights(product(factor, curve.numerator(piece, component)), weights);
      for (std::size_t i = 0; i < values.size(); ++i) points[first + i].*component = static_cast<double>(values[i]);
    }
    points[first] = curve.point(piece, 0);
    points[first + static_cast<std::size_t>(degree_)] = curve.point(piece, static_cast<std::size_t>(curve.degree()));
  }

  std::array<const HomogeneousPieces*, 2> curves_;
  const Blend* blend_;
  bool same_;
  int degree_ = 1;
};

}  // namespace

Result<BlendedLine> blended_line(const Curve& first, const Curve& second, const Blend* blend,
                                 const std::string& direction) {
  const auto a = HomogeneousPieces::make(first, second), b = HomogeneousPieces::make(second, first);
  if (!a) return a.status();
  if (!b) return b.status();
  const LineMaker maker(*a, *b, blend);
  if (maker.degree() <= max_degree) return maker.line();
  const auto kind = [](const Curve& curve) {
    return (curve.is_rational() ? "rational of degree " : "polynomial of degree ") + std::to_string(curve.degree());
  };
  std::string message = "the surface would be of degree " + std::to_string(maker.degree()) + " in " + direction +
                        ", above " + std::to_string(max_degree) + ": the curves along " + direction + " are " +
                        kind(first) + " and " + kind(second);
  if (blend != nullptr)
    message += ", the blending functions of degree " +
               std::to_string(std::max(blend->first().size(), blend->second().size()) - 1);
  return Status(StatusCode::unsupported_degree, message);
}

}}  // namespace tessera::abi_0_1
