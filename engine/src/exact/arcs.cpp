#include "exact/arcs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double rounding = 1e-12;

/// The point at an angle; coordinates that differ from zero only by the rounding of pi are zero.
Arcs::Point on_circle(double angle) {
  const auto clean = [](double value) { return std::abs(value) < 1e-15 ? 0.0 : value; };
  return {clean(std::cos(angle)), clean(std::sin(angle)), 1};
}

}  // namespace

Arcs::Arcs(double from, double to) : from_(from), to_(to) {
  const double right_angles = (to - from) / (std::numbers::pi / 2);
  count_ = std::max(1, static_cast<int>(std::ceil(right_angles - rounding)));
  half_ = (to_ - from_) / (2 * count_);
  tangent_ = std::tan(0.5 * half_);
}

std::vector<Arcs::Point> Arcs::points() const {
  std::vector<Point> points;
  points.reserve(2 * static_cast<std::size_t>(count_) + 1);
  points.push_back(on_circle(from_));
  const double inner = std::cos(half_);
  for (int k = 0; k < count_; ++k) {
    const Point corner = on_circle(0.5 * (knot(k) + knot(k + 1)));  // where the tangents meet
    points.push_back({corner.cosine / inner, corner.sine / inner, inner});
    points.push_back(on_circle(knot(k + 1)));
  }
  if (std::abs(to_ - from_ - 2 * std::numbers::pi) < rounding) points.back() = points.front();
  return points;
}

std::vector<double> Arcs::knots() const {
  std::vector<double> knots;
  knots.reserve(2 * static_cast<std::size_t>(count_) + 4);
  knots.push_back(from_);
  for (int k = 0; k <= count_; ++k) knots.insert(knots.end(), 2, knot(k));
  knots.push_back(to_);
  return knots;
}

double Arcs::middle(double value) const {
  const double place = std::floor((value - from_) / (2 * half_));
  const bool within = value >= from_ && value <= to_;
  const double k = within ? std::clamp(place, 0.0, count_ - 1.0) : place;
  return 0.5 * (knot(k) + knot(k + 1));
}

double Arcs::parameter(double angle) const {
  const double m = middle(angle);
  return m + half_ * std::tan(0.5 * (angle - m)) / tangent_;
}

double Arcs::angle(double parameter) const {
  const double m = middle(parameter);
  return m + 2 * std::atan(tangent_ * (parameter - m) / half_);
}

double Arcs::slope(double parameter) const {
  const double tangent = tangent_ * (parameter - middle(parameter)) / half_;
  return 0.5 * half_ / tangent_ * (1 + tangent * tangent);
}

}}  // namespace tessera::abi_0_1
