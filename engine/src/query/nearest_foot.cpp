#include "query/nearest_foot.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

using kernel::HalfSquare, kernel::SecondOrder;

Vec3 vector(const double (&x)[3]) { return {x[0], x[1], x[2]}; }

/// Whether a parameter stays at an end of its range: the function rises into it.
bool is_held(double x, double from, double to, double gradient) {
  return from == to || (x <= from && gradient > 0) || (x >= to && gradient < 0);
}

/// A step of Newton's method for the parameters that are not held; of steepest descent where the Hessian is not
/// positive.
struct Step {
  double u = 0, v = 0;

  Step(const HalfSquare& f, bool holds_u, bool holds_v) {
    const auto alone = [](double gradient, double second, double first) {
      const double slope = second > 1e-3 * first ? second : first;
      return slope > 0 ? -gradient / slope : 0;
    };
    if (!holds_u && !holds_v) {
      const double det = f.uu * f.vv - f.uv * f.uv;
      if (f.uu > 0 && det > 1e-6 * f.uu * f.vv) {
        u = -(f.vv * f.gu - f.uv * f.gv) / det;
        v = -(f.uu * f.gv - f.uv * f.gu) / det;
        return;
      }
    }
    if (!holds_u) u = alone(f.gu, f.uu, f.du_du);
    if (!holds_v) v = alone(f.gv, f.vv, f.dv_dv);
  }
};

/// Whether a step is so short that the next one, its square, is of no use.
bool is_small(const SecondOrder& at, const HalfSquare& f, const PatchPart& part, double step_u, double step_v) {
  constexpr double last_step = 1e-7;  // of the part's size
  const double scale_u = std::sqrt(f.du_du), scale_v = std::sqrt(f.dv_dv);
  const double least = last_step * std::max(scale_u * (part.u1 - part.u0), scale_v * (part.v1 - part.v0));
  return std::abs(step_u) * scale_u + std::abs(step_v) * scale_v <= least &&
         length(vector(at.duu)) * step_u * step_u + length(vector(at.dvv)) * step_v * step_v <= least;
}

/// A bound from below, if the function is convex over the part.
double least_value(const HalfSquare& f, const PatchPart& part, double u, double v) {
  return f.value + std::min(f.gu * (part.u0 - u), f.gu * (part.u1 - u)) +
         std::min(f.gv * (part.v0 - v), f.gv * (part.v1 - v));
}

/// The point of a patch that Newton's method has reached.
struct Iterate {
  const SecondOrderPatch& patch;
  const Vec3& point;
  double u, v;
  SecondOrder at;
  HalfSquare f;

  void evaluate() {
    second_order(patch, u, v, at);
    patch.kernels->half_square(at, &point.x, f);
  }
  /// Goes on to another point, or less far, by halves until the function is no larger than here.
  void descend(double to_u, double to_v) {
    constexpr int max_halvings = 8;
    const double value = f.value, from_u = std::exchange(u, to_u), from_v = std::exchange(v, to_v);
    evaluate();
    for (int halving = 0; halving < max_halvings && !(f.value <= value); ++halving) {
      u = 0.5 * (u + from_u), v = 0.5 * (v + from_v);
      evaluate();
    }
  }
  /// The point a small step away.
  Vec3 position_after(double su, double sv) const {
    return vector(at.position) + su * vector(at.du) + sv * vector(at.dv) + (0.5 * su * su) * vector(at.duu) +
           (su * sv) * vector(at.duv) + (0.5 * sv * sv) * vector(at.dvv);
  }
};

}  // namespace

Foot nearest_foot(const SecondOrderPatch& patch, const Vec3& point, const PatchPart& part, double u, double v,
                  double limit, double rounding, int max_steps) {
  Iterate x{patch, point, std::clamp(u, part.u0, part.u1), std::clamp(v, part.v0, part.v1), {}, {}};
  x.evaluate();
  Foot foot{};
  foot.is_farther = least_value(x.f, part, x.u, x.v) > 0.5 * limit * limit;
  if (foot.is_farther) return foot;
  for (int k = 0;; ++k) {
    const HalfSquare& f = x.f;
    const bool holds_u = is_held(x.u, part.u0, part.u1, f.gu), holds_v = is_held(x.v, part.v0, part.v1, f.gv);
    const Step step(f, holds_u, holds_v);
    const double to_u = std::clamp(x.u + step.u, part.u0, part.u1), to_v = std::clamp(x.v + step.v, part.v0, part.v1);
    foot.converged = is_small(x.at, f, part, to_u - x.u, to_v - x.v);
    if (!foot.converged && k < max_steps) {
      x.descend(to_u, to_v);
      continue;
    }
    const double aside = 1e-13 * std::sqrt(2 * f.value) + rounding;  // up to this, the line counts as perpendicular
    foot.on_border = (holds_u && std::abs(f.gu) > aside * std::sqrt(f.du_du)) ||
                     (holds_v && std::abs(f.gv) > aside * std::sqrt(f.dv_dv));
    foot.u = foot.converged ? to_u : x.u,
    foot.v = foot.converged ? to_v : x.v;  // a longer step needs a point of its own
    foot.position = x.position_after(foot.u - x.u, foot.v - x.v);
    foot.distance = length(foot.position - point);
    return foot;
  }
}

}}  // namespace tessera::abi_0_1
