#include "io/step/step_spline_inverse.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/spline_jets.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Parameters of samples, some in each knot interval, but not more than `most`.
std::vector<double> grid_parameters_of(std::span<const double> breaks, std::size_t degree, std::size_t most) {
  std::vector<double> out;
  const std::size_t spans = breaks.size() - 1;
  const std::size_t each = std::clamp<std::size_t>(most / spans, 1, degree + 1);
  const std::size_t stride = std::max<std::size_t>(1, spans / most);
  for (std::size_t k = 0; k < spans; k += stride) {
    const double to = breaks[std::min(spans, k + stride)];
    for (std::size_t i = 0; i < each; ++i)
      out.push_back(breaks[k] + static_cast<double>(i) / static_cast<double>(each) * (to - breaks[k]));
  }
  out.push_back(breaks.back());
  return out;
}

class SplineInverse : public SurfaceInverse {
 public:
  SplineInverse(BSplineSurface surface, double tolerance) : surface_(std::move(surface)), at_(surface_) {
    whole_ = surface_.domain();
    const Domain& d = whole_;
    if (closes(tolerance, [&](double x) { return std::array{Vec3{d.u0, d.v_at(x), 0}, Vec3{d.u1, d.v_at(x), 0}}; }))
      period_.u = d.u1 - d.u0;
    if (closes(tolerance, [&](double x) { return std::array{Vec3{d.u_at(x), d.v0, 0}, Vec3{d.u_at(x), d.v1, 0}}; }))
      period_.v = d.v1 - d.v0;
  }

  ParameterPoint at(const Vec3& p, const ParameterPoint& near) const override {
    Foot foot = refined(p, inside(near));
    if (!(foot.distance <= std::max(4 * tolerance_, off_))) {
      const Foot other = found(p);
      if (!(other.distance < 0.5 * foot.distance)) off_ = 1.5 * foot.distance;
      if (other.distance < foot.distance) foot = other;
    }
    return beside(foot.place, near);
  }
  ParameterPoint find(const Vec3& p) const override { return found(p).place; }

  Vec3 point(const ParameterPoint& place) const override { return jet(place).point; }
  ParameterPoint speeds(const ParameterPoint& place) const override {
    const SurfacePlace there = jet(place);
    return {length(there.du), length(there.dv)};
  }

  Result<FaceSurface> surface(const Domain& box) const override {
    const BSplineSurface& s = surface_;
    return with_parameters(s.is_rational() ? BSplineSurface::rational(s.degree_u(), s.knots_u(), s.degree_v(),
                                                                      s.knots_v(), s.points(), s.weights(), box)
                                           : BSplineSurface::polynomial(s.degree_u(), s.knots_u(), s.degree_v(),
                                                                        s.knots_v(), s.points(), box),
                           {});
  }
  std::array<std::vector<double>, 2> knots() const override {
    return {std::vector<double>(surface_.knots_u().begin(), surface_.knots_u().end()),
            std::vector<double>(surface_.knots_v().begin(), surface_.knots_v().end())};
  }

 private:
  struct Foot {
    ParameterPoint place;
    double distance = std::numeric_limits<double>::infinity();
  };

  /// Whether two opposite sides are one line, which is no point.
  template <class Pair>
  bool closes(double tolerance, const Pair& pair) const {
    double extent = 0;
    const Vec3 first = at_(pair(0)[0].x, pair(0)[0].y).point;
    for (int k = 0; k <= 6; ++k) {
      const auto [a, b] = pair(k / 6.0);
      const Vec3 p = at_(a.x, a.y).point;
      if (!(length(p - at_(b.x, b.y).point) <= tolerance)) return false;
      extent = std::max(extent, length(p - first));
    }
    return extent > tolerance;
  }

  SurfacePlace jet(const ParameterPoint& place) const {
    const ParameterPoint there = inside(place);
    return at_(there.u, there.v);
  }
  static double wrapped(double t, double from, double to, double period) {
    if (period > 0 && (t < from || t > to)) t -= period * std::floor((t - from) / period);
    return std::clamp(t, from, to);
  }
  ParameterPoint inside(const ParameterPoint& p) const {
    return {wrapped(p.u, whole_.u0, whole_.u1, period_.u), wrapped(p.v, whole_.v0, whole_.v1, period_.v)};
  }
  /// The place, moved by periods to be beside another.
  ParameterPoint beside(ParameterPoint place, const ParameterPoint& near) const {
    if (period_.u > 0) place.u += period_.u * std::round((near.u - place.u) / period_.u);
    if (period_.v > 0) place.v += period_.v * std::round((near.v - place.v) / period_.v);
    return place;
  }

  /// The step of Gauss and Newton towards p; along one parameter where the other one is held, or undefined.
  ParameterPoint step(const SurfacePlace& there, const Vec3& p, bool holds_u, bool holds_v) const {
    const Vec3 gap = p - there.point;
    const double a = dot(there.du, there.du), b = dot(there.du, there.dv), c = dot(there.dv, there.dv);
    const double x = dot(gap, there.du), y = dot(gap, there.dv), determinant = a * c - b * b;
    if (!holds_u && !holds_v && determinant > 1e-12 * a * c)
      return {(c * x - b * y) / determinant, (a * y - b * x) / determinant};
    const double width = whole_.u1 - whole_.u0, height = whole_.v1 - whole_.v0;
    const bool prefers_u = !holds_u && (holds_v || a * width * width > c * height * height);
    if (prefers_u) return {a > 0 ? x / a : 0, 0};
    return {0, !holds_v && c > 0 ? y / c : 0};
  }

  /// Goes from a place to a local minimum of the distance. Ends after 30 steps.
  Foot refined(const Vec3& p, const ParameterPoint& from) const {
    Foot foot{from, 0};
    SurfacePlace there = at_(from.u, from.v);
    foot.distance = length(there.point - p);
    const Domain& d = whole_;
    for (int k = 0; k < 30; ++k) {
      ParameterPoint move = step(there, p, false, false);
      const auto leaves = [](double at, double by, double first, double last, double period) {
        return period == 0 && ((at == first && by < 0) || (at == last && by > 0));
      };
      const bool holds_u = leaves(foot.place.u, move.u, d.u0, d.u1, period_.u);
      const bool holds_v = leaves(foot.place.v, move.v, d.v0, d.v1, period_.v);
      if (holds_u || holds_v) move = step(there, p, holds_u, holds_v);
      bool better = false;
      double share = 1;
      for (int half = 0; half < 6 && !better; ++half, share *= 0.5) {
        const ParameterPoint next = inside({foot.place.u + share * move.u, foot.place.v + share * move.v});
        if (next == foot.place) return foot;
        const double step_u = std::abs(next.u - foot.place.u) / (d.u1 - d.u0);
        const double step_v = std::abs(next.v - foot.place.v) / (d.v1 - d.v0);
        if (half == 0 && std::max(step_u, step_v) <= 1e-8) return {next, foot.distance};  // the rest is below rounding
        const SurfacePlace jet_there = at_(next.u, next.v);
        const double distance = length(jet_there.point - p);
        if (!(distance < foot.distance)) continue;
        better = true, foot = {next, distance}, there = jet_there;
      }
      if (!better) break;
    }
    return foot;
  }

  /// Searches from the nearest samples.
  Foot found(const Vec3& p) const {
    if (samples_.empty()) sample();
    Foot best;
    std::array<std::pair<double, std::size_t>, 4> nearest;
    nearest.fill({std::numeric_limits<double>::infinity(), 0});
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      std::pair<double, std::size_t> one{length(samples_[k] - p), k};
      for (auto& other : nearest)
        if (one.first < other.first) std::swap(one, other);
    }
    for (const auto& [distance, k] : nearest) {
      if (!std::isfinite(distance)) break;
      const Foot foot = refined(p, {grid_u_[k / grid_v_.size()], grid_v_[k % grid_v_.size()]});
      if (foot.distance < best.distance) best = foot;
      if (best.distance <= tolerance_) break;
    }
    return best;
  }

  void sample() const {
    const Domain& d = whole_;
    constexpr std::size_t most = 24;
    grid_u_ = grid_parameters_of(breaks_of(surface_.knots_u(), range_u(d)),
                                 static_cast<std::size_t>(surface_.degree_u()), most);
    grid_v_ = grid_parameters_of(breaks_of(surface_.knots_v(), range_v(d)),
                                 static_cast<std::size_t>(surface_.degree_v()), most);
    for (const double u : grid_u_)
      for (const double v : grid_v_) samples_.push_back(at_(u, v).point);
  }

  BSplineSurface surface_;
  FastSurface at_;
  /// How far edges are off the surface, as searches among all samples found: steps that end so near need no search.
  mutable double off_ = 0;
  mutable std::vector<double> grid_u_, grid_v_;  ///< made when they are needed; an inverse serves one thread
  mutable std::vector<Vec3> samples_;
};

}  // namespace

std::unique_ptr<SurfaceInverse> make_spline_inverse(BSplineSurface surface, double tolerance) {
  return std::make_unique<SplineInverse>(std::move(surface), tolerance);
}

}}  // namespace tessera::abi_0_1
