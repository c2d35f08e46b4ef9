#include "io/obj/freeform.h"

#include <algorithm>
#include <array>
#include <string>

#include "io/obj/freeform_line.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Control points and weights as the surface kinds take them; no weights if nothing is rational.
struct Net {
  std::vector<Vec3> points;
  std::vector<double> weights;

  void add(const Homogeneous& p, bool rational) {
    points.push_back(p.vector());
    if (rational) weights.push_back(p.w);
  }
  /// Adds a premultiplied point. The check of weights reports a weight that cannot divide.
  void add_projected(const Homogeneous& p, bool rational) {
    if (!rational) return points.push_back(p.vector());
    points.push_back(p.w > 0 ? p.project() : Vec3{});
    weights.push_back(p.w);
  }
  void reserve(std::size_t count, bool rational) {
    points.reserve(count);
    if (rational) weights.reserve(count);
  }
};

Homogeneous premultiplied(const Homogeneous& p, bool rational) {
  return rational ? Homogeneous{p.w * p.x, p.w * p.y, p.w * p.z, p.w} : Homogeneous{p.x, p.y, p.z, 1};
}

Result<Surface> spline_surface(int degree_u, std::span<const double> knots_u, int degree_v,
                               std::span<const double> knots_v, Net net, const Domain& domain) {
  Result<BSplineSurface> surface =
      net.weights.empty()
          ? BSplineSurface::polynomial(degree_u, knots_u, degree_v, knots_v, std::move(net.points), domain)
          : BSplineSurface::rational(degree_u, knots_u, degree_v, knots_v, std::move(net.points),
                                     std::move(net.weights), domain);
  if (!surface) return surface.status();
  return Surface(*std::move(surface));
}

Result<Surface> bezier_patch(int degree_u, int degree_v, const Net& net) {
  const Result<BezierPatch> patch = net.weights.empty()
                                        ? BezierPatch::polynomial(degree_u, degree_v, net.points)
                                        : BezierPatch::rational(degree_u, degree_v, net.points, net.weights);
  if (!patch) return patch.status();
  return Surface(*patch);
}

/// Makes the surfaces of one set of control points: one pass along u, then one along v.
class SurfaceMaker {
 public:
  SurfaceMaker(const FreeformState& state, const ControlPoints& points, const Domain& range)
      : type_(state.type), rational_(state.rational), u_(state.u), v_(state.v), points_(points), range_(range) {}

  Result<std::vector<Surface>> make() {
    if (Status status = check_counts(); !status.ok()) return status;
    degree_u_ = degree_of(type_, u_);
    degree_v_ = degree_of(type_, v_);
    if (type_ != FreeformType::bspline) {
      if (Status status = check_within(u_, 'u', range_.u0, range_.u1); !status.ok()) return status;
      if (Status status = check_within(v_, 'v', range_.v0, range_.v1); !status.ok()) return status;
    }
    if (type_ == FreeformType::taylor || type_ == FreeformType::bmatrix) return pieces();
    Result<Surface> surface = whole();
    if (!surface) return surface.status();
    return std::vector<Surface>{*std::move(surface)};
  }

 private:
  Status check_counts() {
    const Result<std::size_t> count_u = control_count(type_, u_, 'u', points_.size());
    if (!count_u) return count_u.status();
    const Result<std::size_t> count_v = control_count(type_, v_, 'v', points_.size());
    if (!count_v) return count_v.status();
    count_u_ = *count_u;
    count_v_ = *count_v;
    // Divides: the product could overflow.
    if (points_.size() / count_u_ == count_v_ && points_.size() % count_u_ == 0) return {};
    return {StatusCode::count_mismatch, "its parameters and degrees need " + std::to_string(count_u_) + " x " +
                                            std::to_string(count_v_) + " control points, found " +
                                            std::to_string(points_.size())};
  }

  const Homogeneous& at(std::size_t i, std::size_t j) const { return points_[j * count_u_ + i]; }

  Net given_net() const {
    Net net;
    net.reserve(points_.size(), rational_);
    for (std::size_t i = 0; i < count_u_; ++i)
      for (std::size_t j = 0; j < count_v_; ++j) net.add(at(i, j), rational_);
    return net;
  }

  /// Works row by row, to hold the homogeneous points of one row only.
  Net cardinal_net() const {
    const std::size_t pieces_u = count_u_ - 3, pieces_v = count_v_ - 3;
    std::vector<Homogeneous> row(count_v_);
    Net net;
    net.reserve((3 * pieces_u + 1) * (3 * pieces_v + 1), rational_);
    for (std::size_t i = 0; i <= 3 * pieces_u; ++i) {
      for (std::size_t j = 0; j < count_v_; ++j)
        row[j] = cardinal_bezier_point(i, pieces_u, [&](std::size_t k) { return premultiplied(at(k, j), rational_); });
      for (std::size_t j = 0; j <= 3 * pieces_v; ++j)
        net.add_projected(cardinal_bezier_point(j, pieces_v, [&](std::size_t k) { return row[k]; }), rational_);
    }
    return net;
  }

  Result<Surface> whole() const {
    if (type_ == FreeformType::bspline)
      return spline_surface(degree_u_, u_.parm, degree_v_, v_.parm, given_net(), range_);
    Net net = type_ == FreeformType::cardinal ? cardinal_net() : given_net();
    const Domain whole{u_.parm.front(), u_.parm.back(), v_.parm.front(), v_.parm.back()};
    if (u_.parm.size() == 2 && v_.parm.size() == 2 && whole == Domain{} && range_ == whole)
      return bezier_patch(degree_u_, degree_v_, net);
    return spline_surface(degree_u_, bezier_knots(degree_u_, u_.parm), degree_v_, bezier_knots(degree_v_, v_.parm),
                          std::move(net), range_);
  }

  Result<std::vector<Surface>> pieces() const {
    const std::size_t size = static_cast<std::size_t>((degree_u_ + 1) * (degree_v_ + 1));
    const std::size_t count = (u_.parm.size() - 1) * (v_.parm.size() - 1);
    // Pieces may share most of their points; the limit keeps a short file from taking much memory.
    constexpr std::size_t largest_growth = 64;
    if (count > largest_growth * points_.size() / size)
      return Status(StatusCode::unsupported, "its " + std::to_string(count) + " pieces have more than " +
                                                 std::to_string(largest_growth) + " times its " +
                                                 std::to_string(points_.size()) + " control points");
    const Result<BasisMatrix> basis_u = piece_basis(type_, u_), basis_v = piece_basis(type_, v_);
    if (!basis_u) return basis_u.status();
    if (!basis_v) return basis_v.status();
    std::vector<Surface> surfaces;
    for (std::size_t i = 0; i + 1 < u_.parm.size(); ++i)
      for (std::size_t j = 0; j + 1 < v_.parm.size(); ++j) {
        const Domain own{u_.parm[i], u_.parm[i + 1], v_.parm[j], v_.parm[j + 1]};
        const Domain part{std::max(own.u0, range_.u0), std::min(own.u1, range_.u1), std::max(own.v0, range_.v0),
                          std::min(own.v1, range_.v1)};
        if (!(part.u0 < part.u1 && part.v0 < part.v1)) continue;
        Result<Surface> surface =
            piece(i * piece_step(type_, u_), j * piece_step(type_, v_), *basis_u, *basis_v, own, part);
        if (!surface) return surface.status();
        surfaces.push_back(*std::move(surface));
      }
    return surfaces;
  }

  /// The surface of the control points [i0 ..][j0 ..] over `own`, restricted to `part`.
  Result<Surface> piece(std::size_t i0, std::size_t j0, const BasisMatrix& basis_u, const BasisMatrix& basis_v,
                        const Domain& own, const Domain& part) const {
    if (!rational_ && part == own) {
      Net net;
      for (int i = 0; i <= degree_u_; ++i)
        for (int j = 0; j <= degree_v_; ++j) net.add(at(i0 + std::size_t(i), j0 + std::size_t(j)), false);
      const Result<TensorPatch> patch = TensorPatch::make(basis_u, basis_v, net.points, own);
      if (!patch) return patch.status();
      return Surface(*patch);
    }
    Net net = piece_net(i0, j0, basis_u, basis_v);
    const std::array ends_u{own.u0, own.u1}, ends_v{own.v0, own.v1};
    return spline_surface(degree_u_, bezier_knots(degree_u_, ends_u), degree_v_, bezier_knots(degree_v_, ends_v),
                          std::move(net), part);
  }

  /// The Bezier points of a piece: C_u G C_v^T, with C from BasisMatrix::bernstein_coefficient.
  Net piece_net(std::size_t i0, std::size_t j0, const BasisMatrix& basis_u, const BasisMatrix& basis_v) const {
    Net net;
    for (int k = 0; k <= degree_u_; ++k)
      for (int l = 0; l <= degree_v_; ++l) {
        Homogeneous sum{0, 0, 0, 0};
        for (int i = 0; i <= degree_u_; ++i)
          for (int j = 0; j <= degree_v_; ++j)
            sum = sum + basis_u.bernstein_coefficient(k, i) * basis_v.bernstein_coefficient(l, j) *
                            premultiplied(at(i0 + std::size_t(i), j0 + std::size_t(j)), rational_);
        net.add_projected(sum, rational_);
      }
    return net;
  }

  FreeformType type_;
  bool rational_;
  const FreeformLine &u_, &v_;
  ControlPoints points_;
  Domain range_;
  int degree_u_ = 0, degree_v_ = 0;
  std::size_t count_u_ = 0, count_v_ = 0;
};

Result<std::vector<Curve>> one_curve(int degree, std::span<const double> knots, const Net& net) {
  const Result<Curve> curve = net.weights.empty() ? Curve::b_spline(degree, net.points, knots)
                                                  : Curve::nurbs(degree, net.points, net.weights, knots);
  if (!curve) return curve.status();
  return std::vector<Curve>{*curve};
}

Net cardinal_curve_net(const ControlPoints& points, bool rational) {
  const std::size_t pieces = points.size() - 3;
  Net net;
  for (std::size_t r = 0; r <= 3 * pieces; ++r)
    net.add_projected(
        cardinal_bezier_point(r, pieces, [&](std::size_t k) { return premultiplied(points[k], rational); }), rational);
  return net;
}

Result<std::vector<Curve>> curve_pieces(const FreeformState& state, const ControlPoints& points) {
  const Result<BasisMatrix> basis = piece_basis(state.type, state.u);
  if (!basis) return basis.status();
  const std::size_t step = piece_step(state.type, state.u);
  const int degree = basis->degree();
  std::vector<Curve> curves;
  for (std::size_t piece = 0; piece + 1 < state.u.parm.size(); ++piece) {
    Net net;
    for (int k = 0; k <= degree; ++k) {
      Homogeneous sum{0, 0, 0, 0};
      for (int i = 0; i <= degree; ++i)
        sum = sum +
              basis->bernstein_coefficient(k, i) * premultiplied(points[piece * step + std::size_t(i)], state.rational);
      net.add_projected(sum, state.rational);
    }
    Result<std::vector<Curve>> curve =
        one_curve(degree, bezier_knots(degree, std::span(state.u.parm).subspan(piece, 2)), net);
    if (!curve) return curve;
    curves.push_back(curve->front());
  }
  return curves;
}

}  // namespace

Result<std::vector<Surface>> freeform_surfaces(const FreeformState& state, const ControlPoints& points,
                                               const Domain& range) {
  return SurfaceMaker(state, points, range).make();
}

Result<std::vector<Curve>> freeform_curves(const FreeformState& state, const ControlPoints& points) {
  const Result<std::size_t> count = control_count(state.type, state.u, 'u', points.size());
  if (!count) return count.status();
  if (*count != points.size())
    return Status(StatusCode::count_mismatch, "its parameters and degree need " + std::to_string(*count) +
                                                  " control points, found " + std::to_string(points.size()));
  if (state.type == FreeformType::taylor || state.type == FreeformType::bmatrix) return curve_pieces(state, points);
  const int degree = degree_of(state.type, state.u);
  if (state.type == FreeformType::cardinal)
    return one_curve(degree, bezier_knots(degree, state.u.parm), cardinal_curve_net(points, state.rational));
  Net net;
  for (std::size_t k = 0; k < points.size(); ++k) net.add(points[k], state.rational);
  if (state.type == FreeformType::bspline) return one_curve(degree, state.u.parm, net);
  return one_curve(degree, bezier_knots(degree, state.u.parm), net);
}

}}  // namespace tessera::abi_0_1
