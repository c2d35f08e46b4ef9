#include "ray/facet/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ray/line/first_order.h"
#include "ray/line/orthonormal_basis.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double overshoot = 0.25;  // how far outside [0,1] Newton may go before it comes back or changes the patch
constexpr int max_steps = 16;       // quadratic convergence takes 2 to 4
constexpr int max_halvings = 6;
constexpr std::size_t max_patches = 8;  // limit of patches visited for one hit: all around a vertex of usual valence

/// Solves x a + y b = c as seen along the ray; false if a and b are parallel or zero.
bool solve(const OrthonormalBasis& e, const Vec3& a, const Vec3& b, const Vec3& c, double& x, double& y) {
  const double a1 = dot(e.first, a), a2 = dot(e.second, a), b1 = dot(e.first, b), b2 = dot(e.second, b);
  const double c1 = dot(e.first, c), c2 = dot(e.second, c);
  const double determinant = a1 * b2 - a2 * b1;
  x = (c1 * b2 - c2 * b1) / determinant;
  y = (a1 * c2 - a2 * c1) / determinant;
  return std::isfinite(x) && std::isfinite(y);
}

}  // namespace

/// The rectangle of parameters that limits Newton's iterates.
struct Refiner::Leash {
  Domain box;
  double u(double value) const { return std::clamp(value, box.u0, box.u1); }
  double v(double value) const { return std::clamp(value, box.v0, box.v1); }
};

/// Patches to try, each with a start, in the order found and no place twice (a closed patch is its own neighbour).
class Refiner::Frontier {
 public:
  struct Start {
    std::uint32_t patch;
    double u, v;
  };

  void push(const Start& start) {
    const auto seen = [&](const Start& other) {
      return other.patch == start.patch && std::abs(other.u - start.u) < 0.5 && std::abs(other.v - start.v) < 0.5;
    };
    if (count_ == max_patches || std::any_of(starts_.begin(), starts_.begin() + count_, seen)) return;
    starts_[count_++] = start;
  }
  bool pop(Start& start) {
    if (next_ == count_) return false;
    start = starts_[next_++];
    return true;
  }

 private:
  std::array<Start, max_patches> starts_;
  std::size_t count_ = 0, next_ = 0;
};

Refiner::Refiner(const SetView& set, const Adjacency& adjacency, const Box3& box, double reach)
    : set_(set), adjacency_(adjacency), cells_(reach) {
  // Positions round by their absolute size. The tolerance is far above that for models near zero.
  rounding_ = 4 * std::numeric_limits<double>::epsilon() * std::max(max_abs(box.lower), max_abs(box.upper));
  tolerance_ = 1e-10 * box.diagonal() + 16 * rounding_;
}

Refiner::Leash Refiner::leash(std::uint32_t patch, double u, double v) const {
  // Near a pole the parameter that runs around it says little, so it is free there.
  const SideMask collapsed = set_.collapsed_sides(patch);
  const double du = collapsed.has(Side::v0) || collapsed.has(Side::v1) ? 1 : cells_;
  const double dv = collapsed.has(Side::u0) || collapsed.has(Side::u1) ? 1 : cells_;
  return {{std::max(u - du, -overshoot), std::min(u + du, 1 + overshoot), std::max(v - dv, -overshoot),
           std::min(v + dv, 1 + overshoot)}};
}

bool Refiner::evaluate(const RaySegment& segment, std::uint32_t patch, double u, double v, SurfaceRoot& root) const {
  const FirstOrder at = first_order(set_.patch(patch), u, v);
  if (!at.valid) return false;
  const Vec3 offset = at.position - set_.origin() - segment.start;
  const double s = dot(offset, segment.direction);
  root = {patch, u, v, s, at.position, at.du, at.dv, length(offset - s * segment.direction)};
  return true;
}

/// Takes one step of Newton's method on the two coordinates across the ray, halved until the residual shrinks.
bool Refiner::descend(const RaySegment& segment, const Leash& leash, SurfaceRoot& root) const {
  const Vec3 error = root.position - set_.origin() - segment.start;
  double du = 0, dv = 0;
  if (!solve(OrthonormalBasis(segment.direction), root.du, root.dv, error, du, dv)) return false;
  const int halvings = root.residual > tolerance_ ? max_halvings : 0;  // below, only rounding can prevent progress
  for (int halving = 0; halving <= halvings; ++halving) {
    const double u = leash.u(root.u - du), v = leash.v(root.v - dv);
    SurfaceRoot next;
    if (evaluate(segment, root.patch, u, v, next) && next.residual < root.residual) {
      root = next;
      return true;
    }
    du *= 0.5, dv *= 0.5;
  }
  return false;
}

/// Returns whether the root lies in the patch, or within the tolerance of it, and then moves it to the border.
bool Refiner::inside(const RaySegment& segment, SurfaceRoot& root) const {
  const double u = std::clamp(root.u, 0.0, 1.0), v = std::clamp(root.v, 0.0, 1.0);
  if (u == root.u && v == root.v) return true;
  SurfaceRoot clamped;
  if (!evaluate(segment, root.patch, u, v, clamped) || clamped.residual > tolerance_) return false;
  root = clamped;
  return true;
}

Refiner::Outcome Refiner::newton(const RaySegment& segment, SurfaceRoot& root) const {
  const Leash leash = this->leash(root.patch, root.u, root.v);
  for (int step = 0; step < max_steps && root.residual > rounding_; ++step) {
    if (!descend(segment, leash, root)) break;  // as small as rounding or the shape of the surface allows
  }
  if (root.residual <= tolerance_ && inside(segment, root)) return Outcome::inside;
  const bool left = root.u < 0 || root.u > 1 || root.v < 0 || root.v > 1;
  return left ? Outcome::outside : Outcome::failed;
}

void Refiner::push_neighbours(const SurfaceRoot& root, Frontier& frontier) const {
  const std::array<double, 4> excess{-root.u, root.u - 1, -root.v, root.v - 1};
  const SideMask collapsed = set_.collapsed_sides(root.patch);
  const bool over_pole = (collapsed.has(Side::u0) && excess[0] > 0) || (collapsed.has(Side::u1) && excess[1] > 0) ||
                         (collapsed.has(Side::v0) && excess[2] > 0) || (collapsed.has(Side::v1) && excess[3] > 0);
  std::array<int, 4> order{0, 1, 2, 3};  // the edge with the largest excess comes first
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const double x = excess[static_cast<std::size_t>(a)], y = excess[static_cast<std::size_t>(b)];
    return x != y ? x > y : a < b;
  });
  for (const int edge : order) {
    const EdgeLink& link = adjacency_.across(root.patch, edge);
    if (!link.exists() || !(excess[static_cast<std::size_t>(edge)] > 0 || over_pole)) continue;
    const double along = std::clamp(edge < 2 ? root.v : root.u, 0.0, 1.0);
    const double there = link.reversed ? 1 - along : along;
    const double end = link.edge % 2;
    frontier.push(link.edge < 2 ? Frontier::Start{link.patch, end, there} : Frontier::Start{link.patch, there, end});
  }
}

bool Refiner::refine(const RaySegment& segment, std::uint32_t patch, double u, double v, SurfaceRoot& root) const {
  Frontier frontier;
  frontier.push({patch, u, v});
  for (Frontier::Start start; frontier.pop(start);) {
    if (!evaluate(segment, start.patch, start.u, start.v, root)) continue;
    const Outcome outcome = newton(segment, root);
    if (outcome == Outcome::inside) return true;
    if (outcome == Outcome::outside) push_neighbours(root, frontier);
  }
  return false;
}

}}  // namespace tessera::abi_0_1
