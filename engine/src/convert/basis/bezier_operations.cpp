#include "tessera/bezier_operations.h"

#include <algorithm>
#include <string>

#include "base/text.h"
#include "convert/basis/bezier_net.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check_parameter(double t, const char* name) {
  if (t >= 0 && t <= 1) return {};
  return {std::isfinite(t) ? StatusCode::invalid_argument : StatusCode::non_finite,
          std::string("parameter ") + name + " = " + text(t) + " is not in [0, 1]"};
}

Status check_range(double from, double to, const char* name) {
  if (from >= 0 && from < to && to <= 1) return {};
  return {std::isfinite(from) && std::isfinite(to) ? StatusCode::invalid_argument : StatusCode::non_finite,
          std::string("the range of ") + name + ", [" + text(from) + ", " + text(to) +
              "], is not an interval within [0, 1]"};
}

Status check_elevation(int from, int to, const char* direction) {
  if (to >= from && to <= max_degree) return {};
  return {StatusCode::unsupported_degree, std::string("degree ") + direction + " cannot be elevated from " +
                                              std::to_string(from) + " to " + std::to_string(to) + ", the largest is " +
                                              std::to_string(max_degree)};
}

/// Return one row or one column of the net as a curve.
BezierPolygon row_of(const BezierPatch& patch, int i) {
  BezierPolygon curve;
  for (int j = 0; j <= patch.degree_v(); ++j) {
    curve.points.push_back(patch.point(i, j));
    if (patch.is_rational()) curve.weights.push_back(patch.weight(i, j));
  }
  return curve;
}
BezierPolygon column_of(const BezierPatch& patch, int j) {
  BezierPolygon curve;
  for (int i = 0; i <= patch.degree_u(); ++i) {
    curve.points.push_back(patch.point(i, j));
    if (patch.is_rational()) curve.weights.push_back(patch.weight(i, j));
  }
  return curve;
}

/// Returns the net of the derivative of the given order in u (Farin, Curves and Surfaces for CAGD, 5th ed., sec. 14.5).
BezierNet difference_u(const BezierNet& net, int order) {
  BezierNet result = net;
  for (; order > 0 && result.rows > 1; --order) {
    const int degree = result.rows - 1;
    BezierNet lower(degree, result.columns, false);
    for (int i = 0; i < degree; ++i)
      for (int j = 0; j < result.columns; ++j)
        lower.points[lower.index(i, j)] =
            degree * (result.points[result.index(i + 1, j)] - result.points[result.index(i, j)]);
    result = std::move(lower);
  }
  if (order > 0) std::fill(result.points.begin(), result.points.end(), Vec3{});
  if (result.rows > 1) return result;
  result.rows = 2;  // a constant: patches have degree 1 at least
  result.points.resize(2 * static_cast<std::size_t>(result.columns));
  std::copy_n(result.points.begin(), result.columns, result.points.begin() + result.columns);
  return result;
}

Result<std::pair<BezierPatch, BezierPatch>> pair_of(Result<BezierPatch> low, Result<BezierPatch> high) {
  if (!low) return low.status();
  if (!high) return high.status();
  return std::pair{*std::move(low), *std::move(high)};
}

void reverse_rows(BezierNet& net) {
  for (int i = 0; 2 * i < net.rows - 1; ++i)
    for (int j = 0; j < net.columns; ++j) {
      std::swap(net.points[net.index(i, j)], net.points[net.index(net.rows - 1 - i, j)]);
      if (!net.weights.empty()) std::swap(net.weights[net.index(i, j)], net.weights[net.index(net.rows - 1 - i, j)]);
    }
}

}  // namespace

Result<BezierPolygon> u_line(const BezierPatch& patch, double v) {
  return guarded([&]() -> Result<BezierPolygon> {
    if (Status status = check_parameter(v, "v"); !status.ok()) return status;
    return transform_v(evaluation_matrix(patch.degree_v(), v), BezierNet(patch)).polygon();
  });
}

Result<BezierPolygon> v_line(const BezierPatch& patch, double u) {
  return guarded([&]() -> Result<BezierPolygon> {
    if (Status status = check_parameter(u, "u"); !status.ok()) return status;
    return transform_u(evaluation_matrix(patch.degree_u(), u), BezierNet(patch)).polygon();
  });
}

Result<BezierPolygon> boundary_curve(const BezierPatch& patch, Side side) {
  return guarded([&]() -> Result<BezierPolygon> {
    switch (side) {
      case Side::u0:
        return row_of(patch, 0);
      case Side::u1:
        return row_of(patch, patch.degree_u());
      case Side::v0:
        return column_of(patch, 0);
      case Side::v1:
        return column_of(patch, patch.degree_v());
    }
    return Status(StatusCode::invalid_argument, "the side of a boundary curve must be u0, u1, v0 or v1");
  });
}

Result<BezierPatch> derivative_patch(const BezierPatch& patch, int order_u, int order_v) {
  return guarded([&]() -> Result<BezierPatch> {
    if (order_u < 0 || order_v < 0)
      return Status(StatusCode::invalid_argument, "the order of the derivative is (" + std::to_string(order_u) + ", " +
                                                      std::to_string(order_v) + "), it must not be negative");
    if (patch.is_rational())
      return Status(StatusCode::unsupported,
                    "derivatives of a rational patch are not Bezier patches on its differences");
    return transpose(difference_u(transpose(difference_u(BezierNet(patch), order_u)), order_v)).patch();
  });
}

std::array<Vec3, 4> corner_twists(const BezierPatch& patch) {
  return {evaluate_jet(patch, 0, 0).duv, evaluate_jet(patch, 0, 1).duv, evaluate_jet(patch, 1, 0).duv,
          evaluate_jet(patch, 1, 1).duv};
}

Result<std::pair<BezierPatch, BezierPatch>> split_u(const BezierPatch& patch, double t) {
  return guarded([&]() -> Result<std::pair<BezierPatch, BezierPatch>> {
    if (Status status = check_parameter(t, "u"); !status.ok()) return status;
    const BezierNet net(patch);
    return pair_of(transform_u(restriction_matrix(patch.degree_u(), 0, t), net).patch(),
                   transform_u(restriction_matrix(patch.degree_u(), t, 1), net).patch());
  });
}

Result<std::pair<BezierPatch, BezierPatch>> split_v(const BezierPatch& patch, double t) {
  return guarded([&]() -> Result<std::pair<BezierPatch, BezierPatch>> {
    if (Status status = check_parameter(t, "v"); !status.ok()) return status;
    const BezierNet net(patch);
    return pair_of(transform_v(restriction_matrix(patch.degree_v(), 0, t), net).patch(),
                   transform_v(restriction_matrix(patch.degree_v(), t, 1), net).patch());
  });
}

Result<BezierPatch> sub_patch(const BezierPatch& patch, const Domain& rectangle) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_range(rectangle.u0, rectangle.u1, "u"); !status.ok()) return status;
    if (Status status = check_range(rectangle.v0, rectangle.v1, "v"); !status.ok()) return status;
    const BezierNet along =
        transform_u(restriction_matrix(patch.degree_u(), rectangle.u0, rectangle.u1), BezierNet(patch));
    return transform_v(restriction_matrix(patch.degree_v(), rectangle.v0, rectangle.v1), along).patch();
  });
}

Result<BezierPatch> elevate_degree(const BezierPatch& patch, int degree_u, int degree_v) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_elevation(patch.degree_u(), degree_u, "u"); !status.ok()) return status;
    if (Status status = check_elevation(patch.degree_v(), degree_v, "v"); !status.ok()) return status;
    const BezierNet along = transform_u(elevation_matrix(patch.degree_u(), degree_u), BezierNet(patch));
    return transform_v(elevation_matrix(patch.degree_v(), degree_v), along).patch();
  });
}

Result<BezierPatch> transpose(const BezierPatch& patch) {
  return guarded([&] { return transpose(BezierNet(patch)).patch(); });
}

Result<BezierPatch> reverse_u(const BezierPatch& patch) {
  return guarded([&] {
    BezierNet net(patch);
    reverse_rows(net);
    return net.patch();
  });
}

Result<BezierPatch> reverse_v(const BezierPatch& patch) {
  return guarded([&] {
    BezierNet net = transpose(BezierNet(patch));
    reverse_rows(net);
    return transpose(net).patch();
  });
}

}}  // namespace tessera::abi_0_1
