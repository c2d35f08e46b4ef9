#pragma once
// Distances of a point from boxes in float, and points of bicubic patches with second derivatives in double.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/four_floats.h, kernel/ray/nearest_kernels.h.

#include "kernel/ray/cubic_point.inl.h"

unsigned node_squares(const NodeBoxes& boxes, const float* point, float limit, float* squares) {
  unsigned near = 0;
  for (int k = 0; k < NodeBoxes::size; k += 4) {
    Four sum = Fours::all(0);
    for (int c = 0; c < 3; ++c) {
      const Four at = Fours::all(point[c]);
      const Four below = Fours::load(boxes.lower[c] + k) - at, above = at - Fours::load(boxes.upper[c] + k);
      const Four beyond = Fours::max(Fours::max(below, above), Fours::all(0));
      sum = Fours::fma(beyond, beyond, sum);
    }
    Fours::store(squares + k, sum);
    near |= Fours::at_most(sum, Fours::all(limit)) << k;
  }
  return near;
}

unsigned block_squares(const BlockBoxes& boxes, const float* point, float limit, float* squares) {
  unsigned near = 0;
  for (int k = 0; k < BlockBoxes::size; k += 4) {
    Four from[3];
    for (int c = 0; c < 3; ++c) from[c] = Fours::all(point[c]) - Fours::load(boxes.centre[c] + k);
    Four sum = Fours::all(0);
    for (int a = 0; a < 3; ++a) {
      Four along = from[0] * Fours::load(boxes.axes[a][0] + k);
      along = Fours::fma(from[1], Fours::load(boxes.axes[a][1] + k), along);
      along = Fours::fma(from[2], Fours::load(boxes.axes[a][2] + k), along);
      const Four beyond = Fours::max(Fours::abs(along) - Fours::load(boxes.half[a] + k), Fours::all(0));
      sum = Fours::fma(beyond, beyond, sum);
    }
    Fours::store(squares + k, sum);
    near |= Fours::at_most(sum, Fours::all(limit)) << k;
  }
  return near;
}

/// The second derivatives of B_{i,3}(t) (Farin, Curves and Surfaces for CAGD, 5th ed., eq. 5.23).
struct CubicBends {
  double value[4];
  explicit CubicBends(double t) : value{6 - 6 * t, 18 * t - 12, 6 - 18 * t, 6 * t} {}
};

void cubic_second_order(const double* points, const double* origin, double u_at, double v_at, SecondOrder& out) {
  const CubicBasis u(u_at), v(v_at);
  const CubicBends u_bends(u_at), v_bends(v_at);
  const Triple start = Triple::load(origin), zero = Triple::zero();
  Triple position = zero, du = zero, dv = zero, duu = zero, duv = zero, dvv = zero;
  for (int i = 0; i < 4; ++i) {
    Triple row = zero, row_v = zero, row_vv = zero;
    for (int j = 0; j < 4; ++j) {
      const Triple point = Triple::load(points + 12 * i + 3 * j) - start;
      row = Triple::fma(v.value[j], point, row);
      row_v = Triple::fma(v.derivative[j], point, row_v);
      row_vv = Triple::fma(v_bends.value[j], point, row_vv);
    }
    position = Triple::fma(u.value[i], row, position);
    du = Triple::fma(u.derivative[i], row, du);
    duu = Triple::fma(u_bends.value[i], row, duu);
    dv = Triple::fma(u.value[i], row_v, dv);
    duv = Triple::fma(u.derivative[i], row_v, duv);
    dvv = Triple::fma(u.value[i], row_vv, dvv);
  }
  // Each writes a fourth number, over which the next one writes.
  position.store(out.position), du.store(out.du), dv.store(out.dv);
  duu.store(out.duu), duv.store(out.duv), dvv.store(out.dvv);
}

/// The Bernstein polynomials of a degree of 1 to 3 and two derivatives.
struct LowSecondBasis {
  double value[4], first[4], second[4] = {0, 0, 0, 0};

  LowSecondBasis(int degree, double t) {
    const double s = 1 - t;
    if (degree == 1) {
      value[0] = s, value[1] = t, first[0] = -1, first[1] = 1;
    } else if (degree == 2) {
      value[0] = s * s, value[1] = 2 * s * t, value[2] = t * t;
      first[0] = -2 * s, first[1] = 2 - 4 * t, first[2] = 2 * t;
      second[0] = 2, second[1] = -4, second[2] = 2;
    } else {
      const CubicBasis cubic(t);
      const CubicBends bends(t);
      for (int i = 0; i < 4; ++i) value[i] = cubic.value[i], first[i] = cubic.derivative[i], second[i] = bends.value[i];
    }
  }
};

/// Sums of homogeneous coordinates w (x - origin), w.
struct WeightedTriple {
  Triple point = Triple::zero();
  double weight = 0;

  void add(double b, const WeightedTriple& a) { point = Triple::fma(b, a.point, point), weight += b * a.weight; }
};

/// Uses r_ij = (A_ij - .. - w_ij r) / w (Piegl and Tiller, The NURBS Book, eq. 4.20).
void low_rational_second_order(const double* points, const double* weights, int m, int n, const double* origin,
                               double u_at, double v_at, SecondOrder& out) {
  const LowSecondBasis u(m, u_at), v(n, v_at);
  const Triple start = Triple::load(origin);
  WeightedTriple a, au, av, auu, auv, avv;
  for (int i = 0; i <= m; ++i) {
    WeightedTriple row, row_v, row_vv;
    for (int j = 0; j <= n; ++j, points += 3, ++weights) {
      const WeightedTriple from{*weights * (Triple::load(points) - start), *weights};
      row.add(v.value[j], from), row_v.add(v.first[j], from), row_vv.add(v.second[j], from);
    }
    a.add(u.value[i], row), au.add(u.first[i], row), auu.add(u.second[i], row);
    av.add(u.value[i], row_v), auv.add(u.first[i], row_v), avv.add(u.value[i], row_vv);
  }
  const double inverse = 1 / a.weight;
  const Triple position = inverse * a.point;
  const Triple du = inverse * Triple::fma(-au.weight, position, au.point);
  const Triple dv = inverse * Triple::fma(-av.weight, position, av.point);
  const auto second = [&](const WeightedTriple& of, double wu, const Triple& by_u, double wv, const Triple& by_v) {
    return inverse * Triple::fma(-of.weight, position, Triple::fma(-wu, by_u, Triple::fma(-wv, by_v, of.point)));
  };
  const Triple duu = second(auu, au.weight, du, au.weight, du), dvv = second(avv, av.weight, dv, av.weight, dv);
  const Triple duv = second(auv, au.weight, dv, av.weight, du);
  // Each writes a fourth number, over which the next one writes.
  position.store(out.position), du.store(out.du), dv.store(out.dv);
  duu.store(out.duu), duv.store(out.duv), dvv.store(out.dvv);
}

inline double dot3(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// With r from the point: the gradient is (r . s_u, r . s_v), the Hessian s_i . s_j + r . s_ij.
void half_square(const SecondOrder& at, const double* point, HalfSquare& out) {
  const double r[3] = {at.position[0] - point[0], at.position[1] - point[1], at.position[2] - point[2]};
  out.value = 0.5 * dot3(r, r);
  out.gu = dot3(r, at.du), out.gv = dot3(r, at.dv);
  out.du_du = dot3(at.du, at.du), out.dv_dv = dot3(at.dv, at.dv);
  out.uu = out.du_du + dot3(r, at.duu), out.vv = out.dv_dv + dot3(r, at.dvv);
  out.uv = dot3(at.du, at.dv) + dot3(r, at.duv);
}
