#include "tessera/bezier_patch.h"

#include <array>
#include <charconv>
#include <string>

#include "base/guard.h"

namespace tessera {
namespace {

/// Weights below this share of the largest one underflow in products and ratios of them.
constexpr double smallest_weight_ratio = 1e-100;

std::string text(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string place(std::size_t index, int degree_v) {
  const std::size_t row = static_cast<std::size_t>(degree_v) + 1;
  return "[" + std::to_string(index / row) + "][" + std::to_string(index % row) + "]";
}

std::string size_text(int degree_u, int degree_v) {
  return "a patch of degree (" + std::to_string(degree_u) + ", " + std::to_string(degree_v) + ") has " +
         std::to_string(degree_u + 1) + " x " + std::to_string(degree_v + 1);
}

Status check_degree(int degree, const char* direction) {
  if (degree >= 1 && degree <= max_degree) return {};
  return {StatusCode::unsupported_degree, std::string("degree ") + direction + " is " + std::to_string(degree) +
                                              ", it must be 1 to " + std::to_string(max_degree)};
}

Status check_count(int degree_u, int degree_v, std::size_t count, const char* what) {
  if (count == static_cast<std::size_t>(degree_u + 1) * static_cast<std::size_t>(degree_v + 1)) return {};
  return {StatusCode::count_mismatch,
          size_text(degree_u, degree_v) + " " + what + ", " + std::to_string(count) + " were given"};
}

Status check_points(int degree_v, std::span<const Vec3> points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3& p = points[k];
    if (is_finite(p)) continue;
    return {StatusCode::non_finite,
            "control point " + place(k, degree_v) + " is (" + text(p.x) + ", " + text(p.y) + ", " + text(p.z) +
                "), its coordinates must be finite",
            static_cast<std::ptrdiff_t>(k)};
  }
  return {};
}

Status check_weights(int degree_v, std::span<const double> weights) {
  const auto bad = [&](std::size_t k, const std::string& wanted) {
    return Status(StatusCode::invalid_weight,
                  "weight " + place(k, degree_v) + " is " + text(weights[k]) + ", " + wanted,
                  static_cast<std::ptrdiff_t>(k));
  };
  double largest = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!(std::isfinite(weights[k]) && weights[k] > 0)) return bad(k, "it must be finite and greater than 0");
    largest = std::max(largest, weights[k]);
  }
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (weights[k] < smallest_weight_ratio * largest)
      return bad(k, "it must be at least " + text(smallest_weight_ratio) + " of the largest weight, " + text(largest));
  return {};
}

bool all_equal(std::span<const double> weights) {
  return std::all_of(weights.begin(), weights.end(), [&](double weight) { return weight == weights[0]; });
}

}  // namespace

Result<BezierPatch> BezierPatch::polynomial(int degree_u, int degree_v, std::span<const Vec3> points) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_degree(degree_u, "u"); !status.ok()) return status;
    if (Status status = check_degree(degree_v, "v"); !status.ok()) return status;
    if (Status status = check_count(degree_u, degree_v, points.size(), "control points"); !status.ok()) return status;
    if (Status status = check_points(degree_v, points); !status.ok()) return status;
    BezierPatch patch;
    patch.degree_u_ = degree_u;
    patch.degree_v_ = degree_v;
    patch.points_.assign(points.begin(), points.end());
    return patch;
  });
}

Result<BezierPatch> BezierPatch::rational(int degree_u, int degree_v, std::span<const Vec3> points,
                                          std::span<const double> weights) {
  return guarded([&]() -> Result<BezierPatch> {
    Result<BezierPatch> patch = polynomial(degree_u, degree_v, points);
    if (!patch) return patch;
    if (Status status = check_count(degree_u, degree_v, weights.size(), "weights"); !status.ok()) return status;
    if (Status status = check_weights(degree_v, weights); !status.ok()) return status;
    if (!all_equal(weights)) patch->weights_.assign(weights.begin(), weights.end());
    return patch;
  });
}

Box3 BezierPatch::hull_box() const {
  Box3 box;
  for (const Vec3& p : points_) box.extend(p);
  return box;
}

EdgeMask BezierPatch::collapsed_edges() const {
  const int m = degree_u_, n = degree_v_;
  bool u0 = true, u1 = true, v0 = true, v1 = true;
  for (int j = 1; j <= n; ++j) {
    u0 = u0 && point(0, j) == point(0, 0);
    u1 = u1 && point(m, j) == point(m, 0);
  }
  for (int i = 1; i <= m; ++i) {
    v0 = v0 && point(i, 0) == point(0, 0);
    v1 = v1 && point(i, n) == point(0, n);
  }
  EdgeMask edges;
  if (u0) edges.add(Edge::u0);
  if (u1) edges.add(Edge::u1);
  if (v0) edges.add(Edge::v0);
  if (v1) edges.add(Edge::v1);
  return edges;
}

}  // namespace tessera
