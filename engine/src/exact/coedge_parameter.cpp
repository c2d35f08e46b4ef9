#include "exact/coedge_parameter.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Fractions of linear functions, as a rational spline of degree 1.
class Fractions {
 public:
  Fractions(const MonotoneFunction& f, double tolerance) : f_(f), tolerance_(tolerance) {}

  /// Empty if the function is not monotone.
  std::optional<Curve> curve() {
    add_point(f_.range.from);
    for (const double end : f_.breaks) append(knots_.back(), end, 0);
    append(knots_.back(), f_.range.to, 0);
    if (!monotone_) return {};
    std::vector<double> knots{knots_.front()};
    knots.insert(knots.end(), knots_.begin(), knots_.end());
    knots.push_back(knots_.back());
    const Result<Curve> made = Curve::nurbs(1, points_, weights_, knots);
    return made ? std::optional<Curve>(*made) : std::nullopt;
  }

 private:
  void add_point(double s, double ratio = 1) {
    points_.push_back({f_.at(s), 0, 0});
    weights_.push_back(weights_.empty() ? 1 : ratio * weights_.back());
    knots_.push_back(s);
  }

  /// Appends one fraction, which interpolates both ends and the middle; halves the interval until points between fit.
  void append(double from, double to, int depth) {
    if (!(from < to)) return;
    const double a = f_.at(from), b = f_.at(to), middle = f_.at(0.5 * (from + to));
    const double ratio = (middle - a) / (b - middle);
    if (!(ratio > 1e-6 && ratio < 1e6)) {
      monotone_ = false;
      return;
    }
    bool fits = true;
    for (const double x : {0.25, 0.75}) {
      const double fraction = ((1 - x) * a + x * ratio * b) / (1 - x + x * ratio);
      fits = fits && std::abs(fraction - f_.at((1 - x) * from + x * to)) <= tolerance_ * std::abs(b - a);
    }
    constexpr int deepest = 6;
    if (fits || depth == deepest) return add_point(to, ratio);
    append(from, 0.5 * (from + to), depth + 1);
    append(0.5 * (from + to), to, depth + 1);
  }

  const MonotoneFunction& f_;
  double tolerance_;
  std::vector<Vec3> points_;
  std::vector<double> weights_, knots_;
  bool monotone_ = true;
};

/// Whether f runs evenly from one end of `domain` to the other, up to rounding.
bool is_even(const MonotoneFunction& f, const Interval& domain, bool reversed) {
  const double width = f.range.to - f.range.from;
  if (std::abs(domain.from - f.range.from) + std::abs(domain.to - f.range.to) > 1e-12 * width) return false;
  const auto fits = [&](double s) {
    const double even = reversed ? domain.from + domain.to - s : s;
    return std::abs(f.at(s) - even) <= 1e-12 * (width + std::abs(s));
  };
  double before = f.range.from;
  for (std::size_t k = 0; k <= f.breaks.size(); ++k) {
    const double end = k < f.breaks.size() ? f.breaks[k] : f.range.to;
    for (const double x : {0.0, 0.25, 0.5, 1.0})
      if (!fits((1 - x) * before + x * end)) return false;
    before = end;
  }
  return true;
}

}  // namespace

void settle_breaks(MonotoneFunction& f) {
  const double tiny = 1e-9 * (f.range.to - f.range.from);
  std::sort(f.breaks.begin(), f.breaks.end());
  double before = f.range.from;
  std::erase_if(f.breaks, [&](double s) {
    const bool near = s - before < tiny || f.range.to - s < tiny;
    if (!near) before = s;
    return near;
  });
}

void state_parameter(const MonotoneFunction& f, const Interval& domain, Coedge& coedge, double tolerance) {
  if (is_even(f, domain, coedge.reversed)) return;
  coedge.parameter = Fractions(f, tolerance).curve();
  if (!coedge.parameter) coedge.edge = no_id;
}

}}  // namespace tessera::abi_0_1
