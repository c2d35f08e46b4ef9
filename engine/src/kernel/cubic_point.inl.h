// A point of a bicubic patch and its derivatives in double, for the last steps of a ray's root. Needs `Triple`.

/// B_{i,3}(t) and their derivatives (Farin, Curves and Surfaces for CAGD, 5th ed., eqs. 5.2 and 5.23).
struct CubicBasis {
  double value[4], derivative[4];

  explicit CubicBasis(double t) {
    const double s = 1 - t, ss = s * s, st = s * t, tt = t * t;
    value[0] = ss * s, value[1] = 3 * ss * t, value[2] = 3 * s * tt, value[3] = tt * t;
    derivative[0] = -3 * ss, derivative[1] = 3 * ss - 6 * st, derivative[2] = 6 * st - 3 * tt, derivative[3] = 3 * tt;
  }
};

void cubic_point(const double* points, const double* origin, double u_at, double v_at, RayPoint& out) {
  const CubicBasis u(u_at), v(v_at);
  const Triple start = Triple::load(origin);
  Triple position = Triple::zero(), du = Triple::zero(), dv = Triple::zero();
  for (int i = 0; i < 4; ++i) {
    const Triple first = Triple::load(points + 12 * i) - start;
    Triple row = v.value[0] * first, row_v = v.derivative[0] * first;
    for (int j = 1; j < 4; ++j) {
      const Triple point = Triple::load(points + 12 * i + 3 * j) - start;
      row = Triple::fma(v.value[j], point, row);
      row_v = Triple::fma(v.derivative[j], point, row_v);
    }
    position = Triple::fma(u.value[i], row, position);
    du = Triple::fma(u.derivative[i], row, du);
    dv = Triple::fma(u.value[i], row_v, dv);
  }
  position.store(out.position);
  du.store(out.du);
  dv.store(out.dv);
}
