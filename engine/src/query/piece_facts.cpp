#include "query/piece_facts.h"

#include <array>

#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Axes of a piece: its coordinates are dot(axes[c], p - origin).
struct Frame {
  Vec3 origin, axes[3];
};

/// A net in the coordinates of a frame: homogeneous points and weights, `[i][j]`.
struct FrameNet {
  FrameNet(const PieceNet& net, const Frame& frame)
      : degree_u(net.degree_u), degree_v(net.degree_v), is_rational(net.is_rational) {
    for (int k = 0; k < size(); ++k) {
      const double w = net.is_rational ? net.values[3 * size() + k] : 1;
      const Vec3 p = Vec3{net.values[k], net.values[size() + k], net.values[2 * size() + k]} - w * frame.origin;
      for (int c = 0; c < 3; ++c) points[c][k] = dot(frame.axes[c], p);
      weights[k] = w;
    }
  }
  int size() const { return (degree_u + 1) * (degree_v + 1); }
  int at(int i, int j) const { return i * (degree_v + 1) + j; }
  Vec3 point(int k) const { return {points[0][k], points[1][k], points[2][k]}; }

  static constexpr int max_size = (max_degree + 1) * (max_degree + 1);
  int degree_u, degree_v;
  bool is_rational;
  double points[3][max_size], weights[max_size];  ///< without initial values, which would take longer than the rest
};

constexpr Frame plain{{}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// The middle of a piece: its point, and derivatives by the parameters.
struct Middle {
  Vec3 position, du, dv;
};

Middle middle_of(const FrameNet& net) {
  const NetBasis<0> u(net.degree_u, 0.5), v(net.degree_v, 0.5);
  Vec3 p, pu, pv;
  double w = 0, wu = 0, wv = 0;
  for (int i = 0; i <= net.degree_u; ++i) {
    for (int j = 0; j <= net.degree_v; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const Vec3 point = net.point(net.at(i, j));
      const double weight = net.weights[net.at(i, j)];
      const double value = u.value[a] * v.value[b], by_u = u.derivative[a] * v.value[b];
      const double by_v = u.value[a] * v.derivative[b];
      p += value * point, pu += by_u * point, pv += by_v * point;
      w += value * weight, wu += by_u * weight, wv += by_v * weight;
    }
  }
  const Vec3 s = (1 / w) * p;
  if (!net.is_rational) return {s, pu, pv};
  return {s, (1 / w) * (pu - wu * s), (1 / w) * (pv - wv * s)};
}

/// The hull of the differences of a net, which holds a derivative of the homogeneous piece.
struct HomogeneousRange {
  VectorRange point;
  Range weight;
};

/// Bounds the derivative of an order with du + dv = 1 or 2, rounding included: a coordinate of a frame's point is off
/// by 2^-49 at most, since coordinates and weights are at most 2.
HomogeneousRange derivative_range(const FrameNet& net, int du, int dv) {
  const int m = net.degree_u, n = net.degree_v;
  HomogeneousRange out;
  if (du > m || dv > n) return {{{0, 0}, {0, 0}, {0, 0}}, {0, 0}};
  const double scale = (du == 2 ? m * (m - 1) : du == 1 ? m : 1) * (dv == 2 ? n * (n - 1) : dv == 1 ? n : 1);
  const int row = n + 1;
  const auto difference = [&](const double* x) {
    if (du == 2) return x[2 * row] - 2 * x[row] + x[0];
    if (dv == 2) return x[2] - 2 * x[1] + x[0];
    if (du == 1 && dv == 1) return (x[row + 1] - x[row]) - (x[1] - x[0]);
    return (du == 1 ? x[row] : x[1]) - x[0];
  };
  const auto range = [&](const double* values) {
    Range found;
    for (int i = 0; i <= m - du; ++i)
      for (int j = 0; j <= n - dv; ++j) found.extend(difference(values + net.at(i, j)));
    return found;
  };
  out.point = {range(net.points[0]), range(net.points[1]), range(net.points[2])};
  out.weight = net.is_rational ? range(net.weights) : Range{0, 0};
  const double margin = net_rounding(m, n) * (1 << (du + dv));
  out.point.x = scale * out.point.x.widened(margin), out.point.y = scale * out.point.y.widened(margin);
  out.point.z = scale * out.point.z.widened(margin);
  if (net.is_rational) out.weight = scale * out.weight.widened(margin);
  return out;
}

/// The points of a net over its weights.
VectorRange hull_of(const FrameNet& net) {
  VectorRange hull;
  for (int k = 0; k < net.size(); ++k) hull.extend((1 / net.weights[k]) * net.point(k));
  return hull;
}

/// The quotient rule (Piegl and Tiller, The NURBS Book, eq. 4.20) for boxes. Points are relative to one near the piece.
DerivativeRanges derivatives_of(const FrameNet& net) {
  const HomogeneousRange u = derivative_range(net, 1, 0), v = derivative_range(net, 0, 1);
  const HomogeneousRange uu = derivative_range(net, 2, 0), uv = derivative_range(net, 1, 1),
                         vv = derivative_range(net, 0, 2);
  if (!net.is_rational) return {u.point, v.point, uu.point, uv.point, vv.point};
  const VectorRange s = hull_of(net);
  const auto [least, most] = std::minmax_element(net.weights, net.weights + net.size());
  const Range w{*least, *most};
  DerivativeRanges out;
  out.du = divided(u.point + (-1.0 * u.weight) * s, w);
  out.dv = divided(v.point + (-1.0 * v.weight) * s, w);
  out.duu = divided(uu.point + (-2.0 * u.weight) * out.du + (-1.0 * uu.weight) * s, w);
  out.duv = divided(uv.point + (-1.0 * u.weight) * out.dv + (-1.0 * v.weight) * out.du + (-1.0 * uv.weight) * s, w);
  out.dvv = divided(vv.point + (-2.0 * v.weight) * out.dv + (-1.0 * vv.weight) * s, w);
  return out;
}

/// Returns any unit vector across a unit vector.
Vec3 any_across(const Vec3& a) {
  const Vec3 other = std::abs(a.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(cross(a, other));
}

/// Returns the frame of a piece at its middle: along s_u, across it in the tangent plane, and along the normal. Without
/// a tangent plane, axes are arbitrary, and `is_regular` is false.
Frame frame_of(const Middle& middle, bool& is_regular) {
  constexpr double least_sine = 1e-6, least_length = 1e-12;
  const double u = length(middle.du), v = length(middle.dv);
  const Vec3 area = cross(middle.du, middle.dv);
  is_regular = std::min(u, v) > least_length && length(area) > least_sine * u * v;
  const Vec3 longer = u >= v ? middle.du : middle.dv;
  const Vec3 x = is_regular ? normalized(middle.du) : std::max(u, v) > 0 ? normalized(longer) : Vec3{1, 0, 0};
  const Vec3 z = is_regular ? normalized(area) : any_across(x);
  return {middle.position, {x, cross(z, x), z}};
}

/// Fills the bounds that no irregular piece has: nothing is convex or monotone.
void set_unknown(PieceFacts<double>& f) {
  constexpr double huge = 1e30;
  f.least_square = 0;
  for (int c = 0; c < 3; ++c) {
    f.off[c] = f.turn_x[c] = f.turn_y[c] = f.bend_xy[c] = huge;
    f.bend_xx[c][0] = f.bend_yy[c][0] = -huge, f.bend_xx[c][1] = f.bend_yy[c][1] = huge;
  }
}

/// Fills the facts of a regular piece, from its derivatives in its frame. By Taylor's theorem from the middle, where
/// parameters are off by 1/2 at most.
void set_regular(const DerivativeRanges& d, PieceFacts<double>& f) {
  const double u = f.length_u, v = f.length_v;
  const auto axis = [](const VectorRange& a, int c) -> const Range& { return c == 0 ? a.x : c == 1 ? a.y : a.z; };
  for (int c = 0; c < 3; ++c) {
    const Range &duu = axis(d.duu, c), &duv = axis(d.duv, c), &dvv = axis(d.dvv, c);
    const double uu = duu.magnitude(), uv = duv.magnitude(), vv = dvv.magnitude();
    f.off[c] = 0.125 * (uu + 2 * uv + vv);
    f.turn_x[c] = 0.5 * (uu + uv) / u, f.turn_y[c] = 0.5 * (uv + vv) / v;
    f.bend_xx[c][0] = duu.lower / (u * u), f.bend_xx[c][1] = duu.upper / (u * u);
    f.bend_yy[c][0] = dvv.lower / (v * v), f.bend_yy[c][1] = dvv.upper / (v * v);
    f.bend_xy[c] = uv / (u * v);
  }
  const double least =
      std::sqrt(std::max(1 - std::abs(f.cosine), 0.0)) - std::sqrt(squared(f.turn_x) + squared(f.turn_y));
  f.least_square = least > 0 ? least * least : 0;
}

}  // namespace

DerivativeRanges derivative_ranges(const PieceNet& net) {
  Frame frame = plain;
  frame.origin = middle_of(FrameNet(net, plain)).position;
  return derivatives_of(FrameNet(net, frame));
}

PieceBounds bound_piece(const PieceNet& net) {
  const FrameNet world(net, plain);
  const Middle middle = middle_of(world);
  bool is_regular = false;
  const Frame frame = frame_of(middle, is_regular);
  const FrameNet local(net, frame);
  const VectorRange hull = hull_of(local), space = hull_of(world);
  const double margin = net_rounding(net.degree_u, net.degree_v);
  PieceBounds out;
  PieceFacts<double>& f = out.facts;
  f.centre = Vec3Of<double>(middle.position);
  f.length_u = length(middle.du), f.length_v = length(middle.dv);
  const Vec3 along_y = is_regular ? normalized(middle.dv) : frame.axes[1];
  f.cosine = dot(along_y, frame.axes[0]), f.sine = dot(along_y, frame.axes[1]);
  set_unknown(f);
  if (is_regular) set_regular(derivatives_of(local), f);
  const double reach[3] = {hull.x.magnitude(), hull.y.magnitude(), hull.z.magnitude()};
  for (int c = 0; c < 3; ++c) {
    f.axes[c] = Vec3Of<double>(frame.axes[c]);
    f.reach[c] = reach[c] + margin;
    f.off[c] += margin;
  }
  const Vec3 middle_box{0.5 * (hull.x.lower + hull.x.upper), 0.5 * (hull.y.lower + hull.y.upper),
                        0.5 * (hull.z.lower + hull.z.upper)};
  out.box = {
      middle.position + middle_box.x * frame.axes[0] + middle_box.y * frame.axes[1] + middle_box.z * frame.axes[2],
      {frame.axes[0], frame.axes[1], frame.axes[2]},
      {0.5 * (hull.x.upper - hull.x.lower) + margin, 0.5 * (hull.y.upper - hull.y.lower) + margin,
       0.5 * (hull.z.upper - hull.z.lower) + margin}};
  out.axis_box = {{space.x.lower - margin, space.y.lower - margin, space.z.lower - margin},
                  {space.x.upper + margin, space.y.upper + margin, space.z.upper + margin}};
  return out;
}

PieceFacts<float> packed(const PieceFacts<double>& f) {
  constexpr double unit = 1e-6, shift = 4e-7;  // relative; and of the centre over the scene's size
  const auto up = [&](double x) { return static_cast<float>(x + unit * std::abs(x) + 1e-30); };
  const auto down = [&](double x) { return static_cast<float>(x - unit * std::abs(x) - 1e-30); };
  PieceFacts<float> out;
  out.centre = Vec3Of<float>(Vec3(f.centre));
  out.length_u = up(f.length_u), out.length_v = up(f.length_v);
  out.cosine = static_cast<float>(f.cosine), out.sine = static_cast<float>(f.sine);
  out.least_square = std::max(static_cast<float>(f.least_square - 4 * unit), 0.0f);
  // Axes are off by rounding: vectors have shares of their length along the others.
  double xx = 0, yy = 0, xy = 0;
  for (int c = 0; c < 3; ++c) {
    xx += std::abs(f.bend_xx[c][0]) + std::abs(f.bend_xx[c][1]);
    yy += std::abs(f.bend_yy[c][0]) + std::abs(f.bend_yy[c][1]);
    xy += f.bend_xy[c];
  }
  for (int c = 0; c < 3; ++c) {
    out.axes[c] = Vec3Of<float>(Vec3(f.axes[c]));
    out.off[c] = up(f.off[c] + shift), out.reach[c] = up(f.reach[c] + shift);
    out.turn_x[c] = up(f.turn_x[c] + unit), out.turn_y[c] = up(f.turn_y[c] + unit);
    out.bend_xx[c][0] = down(f.bend_xx[c][0] - unit * xx), out.bend_xx[c][1] = up(f.bend_xx[c][1] + unit * xx);
    out.bend_yy[c][0] = down(f.bend_yy[c][0] - unit * yy), out.bend_yy[c][1] = up(f.bend_yy[c][1] + unit * yy);
    out.bend_xy[c] = up(f.bend_xy[c] + unit * xy);
  }
  return out;
}

}}  // namespace tessera::abi_0_1
