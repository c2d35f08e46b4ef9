#include "join/edge_tables.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_depth = 10;
constexpr std::size_t first_pieces = 4;

/// Throws std::bad_alloc.
Curve linear_spline(const std::vector<double>& s, const std::vector<double>& t, const std::vector<double>& weights) {
  std::vector<Vec3> points;
  for (const double x : t) points.push_back({x, 0, 0});
  std::vector<double> knots{s.front()};
  knots.insert(knots.end(), s.begin(), s.end());
  knots.push_back(s.back());
  Result<Curve> spline = Curve::nurbs(1, points, weights, knots);
  if (spline) return *std::move(spline);
  if (spline.status().code() == StatusCode::out_of_memory || s.size() == 2) throw std::bad_alloc();
  return linear_spline({s.front(), s.back()}, {t.front(), t.back()}, {1, 1});  // rounding makes steps in between equal
}

/// Builds the fractions piece by piece.
class Fractions {
 public:
  Fractions(const LeadingLine& leader, const FollowingLine& follower, double slack)
      : leader_(leader), follower_(follower), slack_(slack) {
    s_.push_back(leader.range.from);
    t_.push_back(follower.turned ? follower.within.to : follower.within.from);
    weights_.push_back(1);
  }

  Curve curve() {
    const Interval& range = leader_.range;
    const double last = follower_.turned ? follower_.within.from : follower_.within.to;
    for (std::size_t k = 1; k <= first_pieces; ++k) {
      const double x = static_cast<double>(k) / first_pieces, s = (1 - x) * range.from + x * range.to;
      if (k == first_pieces) {
        append(range.to, last, 0);
        break;
      }
      const double t = nearest(s, t_.back(), last);
      if (is_between(t_.back(), t, last)) append(s, t, 0);
    }
    return linear_spline(s_, t_, weights_);
  }

  /// Whether points at s and t are as near as it takes.
  bool fits(double s, double t) const {
    const Vec3 p = leader_.at(s);
    const double distance = length(follower_.curve->at(t) - p);
    return distance <= slack_ || distance <= slack_ + follower_.curve->nearest_from(p, t, follower_.within).distance;
  }

 private:
  static bool is_between(double a, double t, double b) {
    constexpr double margin = 1e-3;  // of the way: steeper fractions do not occur where nearest points are smooth
    const double x = (t - a) / (b - a);
    return x > margin && x < 1 - margin;
  }

  /// The parameter of the nearest point between two others.
  double nearest(double s, double a, double b) const {
    return follower_.curve->nearest(leader_.at(s), {std::min(a, b), std::max(a, b)}).t;
  }

  void append(double s, double t, int depth) {
    const double from_s = s_.back(), from_t = t_.back();
    const double middle_s = 0.5 * (from_s + s), middle_t = nearest(middle_s, from_t, t);
    if (!is_between(from_t, middle_t, t)) return add(s, t, 1);
    const double ratio = (middle_t - from_t) / (t - middle_t);
    bool fit = true;
    for (const double x : {0.25, 0.75}) {
      const double at = ((1 - x) * from_t + x * ratio * t) / (1 - x + x * ratio);
      fit = fit && fits((1 - x) * from_s + x * s, at);
    }
    if (fit || depth == max_depth) return add(s, t, ratio);
    append(middle_s, middle_t, depth + 1);
    append(s, t, depth + 1);
  }

  void add(double s, double t, double ratio) {
    const double weight = ratio * weights_.back();
    const bool fair = weight > 1e-40 && weight < 1e40;
    s_.push_back(s);
    t_.push_back(t);
    weights_.push_back(fair ? weight : weights_.back());
  }

  const LeadingLine& leader_;
  const FollowingLine& follower_;
  double slack_;
  std::vector<double> s_, t_, weights_;
};

}  // namespace

std::optional<Curve> even_parameter(const Interval& range, const Interval& to, bool turned) {
  if (range == to) return {};
  return linear_spline({range.from, range.to}, turned ? std::vector{to.to, to.from} : std::vector{to.from, to.to},
                       {1, 1});
}

std::optional<Curve> following_parameter(const LeadingLine& leader, const FollowingLine& follower, double slack) {
  Fractions fractions(leader, follower, slack);
  bool is_even = true;
  constexpr int samples = 16;
  for (int k = 1; k < samples && is_even; ++k) {
    const double x = static_cast<double>(k) / samples, y = follower.turned ? 1 - x : x;
    is_even = fractions.fits((1 - x) * leader.range.from + x * leader.range.to,
                             (1 - y) * follower.within.from + y * follower.within.to);
  }
  if (is_even) return even_parameter(leader.range, follower.within, follower.turned);
  return fractions.curve();
}

}}  // namespace tessera::abi_0_1
