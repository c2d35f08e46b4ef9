#include "query/nearest_foot.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Half the squared distance at a point of the patch: value, gradient, Hessian.
struct HalfSquare {
  double value, gu, gv, uu, uv, vv;

  HalfSquare(const SecondOrder& at, const Vec3& r)
      : value(0.5 * dot(r, r)),
        gu(dot(r, at.du)),
        gv(dot(r, at.dv)),
        uu(dot(at.du, at.du) + dot(r, at.duu)),
        uv(dot(at.du, at.dv) + dot(r, at.duv)),
        vv(dot(at.dv, at.dv) + dot(r, at.dvv)) {}
};

/// Whether a parameter stays at an end of its range: the function rises into it.
bool is_held(double x, double from, double to, double gradient) {
  return from == to || (x <= from && gradient > 0) || (x >= to && gradient < 0);
}

/// A step of Newton's method for the parameters that are not held; of steepest descent where the Hessian is not
/// positive.
struct Step {
  double u = 0, v = 0;

  Step(const HalfSquare& f, const SecondOrder& at, bool holds_u, bool holds_v) {
    const double du = dot(at.du, at.du), dv = dot(at.dv, at.dv);
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
    if (!holds_u) u = alone(f.gu, f.uu, du);
    if (!holds_v) v = alone(f.gv, f.vv, dv);
  }
};

/// Evaluates at the end of a step, which is halved until half the squared distance falls below `value`.
SecondOrder descend(const BezierPatch& patch, const Vec3& origin, const Vec3& point, double value,
                    const ParameterPoint& from, double& to_u, double& to_v) {
  constexpr int max_halvings = 8;
  SecondOrder next = second_order(patch, to_u, to_v, origin);
  for (int halving = 0; halving < max_halvings; ++halving) {
    const Vec3 to = next.position - point;
    if (0.5 * dot(to, to) <= value) break;
    to_u = 0.5 * (to_u + from.u), to_v = 0.5 * (to_v + from.v);
    next = second_order(patch, to_u, to_v, origin);
  }
  return next;
}

}  // namespace

Foot nearest_foot(const BezierPatch& patch, const Vec3& origin, const Vec3& point, const PatchPart& part, double u,
                  double v, double limit, double rounding, int max_steps) {
  constexpr double last_step = 1e-7;  // of the distance's scale: the next one would be its square
  u = std::clamp(u, part.u0, part.u1), v = std::clamp(v, part.v0, part.v1);
  Foot foot{};
  SecondOrder at = second_order(patch, u, v, origin);
  for (int k = 0;; ++k) {
    const Vec3 r = at.position - point;
    const HalfSquare f(at, r);
    if (k == 0) {
      const double least = f.value + std::min(f.gu * (part.u0 - u), f.gu * (part.u1 - u)) +
                           std::min(f.gv * (part.v0 - v), f.gv * (part.v1 - v));
      if (least > 0.5 * limit * limit) {
        foot.is_farther = true;
        return foot;
      }
    }
    const bool holds_u = is_held(u, part.u0, part.u1, f.gu), holds_v = is_held(v, part.v0, part.v1, f.gv);
    const double scale_u = length(at.du), scale_v = length(at.dv), size = std::sqrt(2 * f.value);
    const double aside = 1e-13 * size + rounding;  // up to this, the line to the foot counts as perpendicular
    foot.on_border = (holds_u && std::abs(f.gu) > aside * scale_u) || (holds_v && std::abs(f.gv) > aside * scale_v);
    Step step(f, at, holds_u, holds_v);
    double to_u = std::clamp(u + step.u, part.u0, part.u1), to_v = std::clamp(v + step.v, part.v0, part.v1);
    const double step_u = std::abs(to_u - u), step_v = std::abs(to_v - v);
    const double moved = step_u * scale_u + step_v * scale_v;
    const double bend = length(at.duu) * step_u * step_u + length(at.dvv) * step_v * step_v;
    const double reach = std::max(scale_u * (part.u1 - part.u0), scale_v * (part.v1 - part.v0));
    const bool is_last = moved <= last_step * reach && bend <= last_step * reach;
    if (is_last || k == max_steps) {
      const double su = is_last ? to_u - u : 0, sv = is_last ? to_v - v : 0;  // a longer step needs a point of its own
      foot.position = at.position + su * at.du + sv * at.dv + (0.5 * su * su) * at.duu + (su * sv) * at.duv +
                      (0.5 * sv * sv) * at.dvv;
      foot.u = is_last ? to_u : u, foot.v = is_last ? to_v : v, foot.converged = is_last;
      foot.distance = length(foot.position - point);
      return foot;
    }
    at = descend(patch, origin, point, f.value, {u, v}, to_u, to_v);
    u = to_u, v = to_v;
  }
}

}}  // namespace tessera::abi_0_1
