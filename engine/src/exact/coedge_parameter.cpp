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
    const auto place = [&](double s) { return Place{s, f_.at(s)}; };
    Place before = place(f_.range.from);
    add_point(before);
    const auto append_to = [&](double s) {
      if (!(before.s < s) || !monotone_) return;
      const Place middle = place(0.5 * (before.s + s)), end = place(s);
      append(before, middle, end, 0);
      before = end;
    };
    for (const double end : f_.breaks) append_to(end);
    append_to(f_.range.to);
    if (!monotone_) return {};
    std::vector<double> knots{knots_.front()};
    knots.insert(knots.end(), knots_.begin(), knots_.end());
    knots.push_back(knots_.back());
    const Result<Curve> made = Curve::nurbs(1, points_, weights_, knots);
    return made ? std::optional<Curve>(*made) : std::nullopt;
  }

 private:
  /// A parameter, and the value of the function there.
  struct Place {
    double s, value;
  };

  void add_point(const Place& at, double ratio = 1) {
    points_.push_back({at.value, 0, 0});
    weights_.push_back(weights_.empty() ? 1 : ratio * weights_.back());
    knots_.push_back(at.s);
  }

  /// Appends one fraction, which interpolates both ends and the middle; halves the interval until points between fit.
  void append(const Place& a, const Place& middle, const Place& b, int depth) {
    const double ratio = (middle.value - a.value) / (b.value - middle.value);
    if (!(ratio > 1e-6 && ratio < 1e6)) {
      monotone_ = false;
      return;
    }
    const auto between = [&](const Place& low, const Place& high) {
      const double s = 0.5 * (low.s + high.s);
      return Place{s, f_.at(s)};
    };
    const auto fits = [&](double x, const Place& at) {
      const double fraction = ((1 - x) * a.value + x * ratio * b.value) / (1 - x + x * ratio);
      return std::abs(fraction - at.value) <= tolerance_ * std::abs(b.value - a.value);
    };
    const Place low = between(a, middle), high = between(middle, b);
    constexpr int deepest = 6;
    if (depth == deepest || (fits(0.25, low) && fits(0.75, high))) return add_point(b, ratio);
    append(a, low, middle, depth + 1);
    append(middle, high, b, depth + 1);
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
