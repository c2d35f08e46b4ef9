#pragma once
// A point of a patch of degree up to 3 and its derivatives in double, one coordinate per lane of `Triple`, for the last
// steps of a ray's root.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/four_floats.h, kernel/ray/ray_kernels.h.

/// The polynomials B_{i,3}(t) and their derivatives (Farin, Curves and Surfaces for CAGD, 5th ed., eqs. 5.2 and 5.23).
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

/// The Bernstein polynomials of any degree up to three and their derivatives, raised from the degree below. `Fixed` is
/// the degree if it is known, else 0.
template <int Fixed>
struct LowBasis {
  double value[4] = {1, 0, 0, 0}, derivative[4] = {0, 0, 0, 0};

  LowBasis(int any_degree, double t) {
    const int degree = Fixed ? Fixed : any_degree;
    for (int n = 1; n < degree; ++n) raise(n, t);
    double before = 0;
    for (int i = 0; i < degree; ++i) {
      derivative[i] = degree * (before - value[i]);
      before = value[i];
    }
    derivative[degree] = degree * before;
    raise(degree, t);
  }

 private:
  void raise(int n, double t) {
    value[n] = t * value[n - 1];
    for (int i = n - 1; i > 0; --i) value[i] = (1 - t) * value[i] + t * value[i - 1];
    value[0] *= 1 - t;
  }
};

/// Uses the quotient rule r_u = (A_u - w_u r) / w (Piegl and Tiller, The NURBS Book, eq. 4.20).
template <int Fixed>
void rational_point(const double* points, const double* weights, int any_m, int any_n, const double* origin,
                    double u_at, double v_at, RayPoint& out) {
  const int m = Fixed ? Fixed : any_m, n = Fixed ? Fixed : any_n;
  const LowBasis<Fixed> u(m, u_at), v(n, v_at);
  const Triple start = Triple::load(origin);
  Triple position = Triple::zero(), du = Triple::zero(), dv = Triple::zero();
  double w = 0, wu = 0, wv = 0;
  for (int i = 0; i <= m; ++i) {
    Triple row = Triple::zero(), row_v = Triple::zero();
    double weight = 0, weight_v = 0;
    for (int j = 0; j <= n; ++j, points += 3, ++weights) {
      const Triple point = Triple::load(points) - start;
      const double b = v.value[j] * *weights, d = v.derivative[j] * *weights;
      row = Triple::fma(b, point, row);
      row_v = Triple::fma(d, point, row_v);
      weight += b, weight_v += d;
    }
    position = Triple::fma(u.value[i], row, position);
    du = Triple::fma(u.derivative[i], row, du);
    dv = Triple::fma(u.value[i], row_v, dv);
    w += u.value[i] * weight, wu += u.derivative[i] * weight, wv += u.value[i] * weight_v;
  }
  const double inverse = 1 / w;
  position = inverse * position;
  position.store(out.position);
  (inverse * Triple::fma(-wu, position, du)).store(out.du);
  (inverse * Triple::fma(-wv, position, dv)).store(out.dv);
}

void low_rational_point(const double* points, const double* weights, int m, int n, const double* origin, double u,
                        double v, RayPoint& out) {
  if (m == 3 && n == 3) return rational_point<3>(points, weights, m, n, origin, u, v, out);
  rational_point<0>(points, weights, m, n, origin, u, v, out);
}
