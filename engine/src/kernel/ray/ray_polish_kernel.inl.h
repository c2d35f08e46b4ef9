#pragma once
// Newton's method in double for roots of one patch, lanes = rays, by the operations of polish()
// (ray/leaf/polished_root.cpp), cubic_point and low_rational_point in their order: the same numbers. Needs
// Lanes<double>.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/four_floats.h, kernel/ray/ray_kernels.h.

#include "kernel/ray/cubic_point.inl.h"

/// Polishes roots of bicubic patches, or of rational ones of degrees up to three.
template <bool Rational>
class RootPolish {
  using L = Lanes<double>;
  using Batch = L::Batch;
  using Where = decltype(Batch() < Batch());

 public:
  RootPolish(const PolishJob& job, PolishedRays& rays, int first) : job_(job), rays_(rays), first_(first) {}

  void run() {
    const Batch start_u = load(rays_.u), start_v = load(rays_.v);
    const Batch reach_u = load(rays_.reach_u), reach_v = load(rays_.reach_v);
    Where open = load(rays_.state) == Batch(PolishedRays::asked);
    Batch u = start_u, v = start_v, state = load(rays_.state);
    for (int step = 0; step < PolishJob::max_steps && xsimd::any(open); ++step) {
      Batch position[3], at_du[3], at_dv[3];
      evaluate(u, v, position, at_du, at_dv);
      Batch from[3];
      for (int i = 0; i < 3; ++i) from[i] = position[i] - load(rays_.start[i]);
      const Batch x = across(0, from), y = across(1, from);
      const Batch xu = across(0, at_du), xv = across(0, at_dv), yu = across(1, at_du), yv = across(1, at_dv);
      const Batch inverse = Batch(1.0) / (xu * yv - xv * yu);
      const Batch du = -(x * yv - y * xv) * inverse, dv = -(y * xu - x * yu) * inverse;
      u = u + du, v = v + dv;
      const Where inside = (xsimd::abs(u - start_u) <= reach_u) & (xsimd::abs(v - start_v) <= reach_v) &
                           (u >= Batch(job_.u0)) & (u <= Batch(job_.u1)) & (v >= Batch(job_.v0)) &
                           (v <= Batch(job_.v1));
      const Where last = !((xsimd::abs(du) > Batch(job_.linear)) | (xsimd::abs(dv) > Batch(job_.linear)));
      const Where done = open & inside & last;
      state = xsimd::select(open & !inside, Batch(PolishedRays::failed), state);
      state = xsimd::select(done, Batch(PolishedRays::found), state);
      keep(done, rays_.root_u, u);
      keep(done, rays_.root_v, v);
      Batch direction[3];
      for (int i = 0; i < 3; ++i) direction[i] = load(rays_.direction[i]);
      keep(done, rays_.s, dot(direction, from) + (du * dot(direction, at_du) + dv * dot(direction, at_dv)));
      for (int i = 0; i < 3; ++i) {
        keep(done, rays_.position[i], position[i] + (du * at_du[i] + dv * at_dv[i]));
        keep(done, rays_.du[i], at_du[i]);
        keep(done, rays_.dv[i], at_dv[i]);
      }
      open = open & inside & !last;
    }
    L::store(rays_.state + first_, xsimd::select(open, Batch(PolishedRays::failed), state));
  }

 private:
  Batch load(const double* from) const { return L::load(from + first_); }
  void keep(Where where, double* to, Batch x) const { L::store(to + first_, xsimd::select(where, x, load(to))); }
  static Batch dot(const Batch (&a)[3], const Batch (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  Batch across(int which, const Batch (&x)[3]) const {
    return load(rays_.across[which][0]) * x[0] + load(rays_.across[which][1]) * x[1] +
           load(rays_.across[which][2]) * x[2];
  }

  /// CubicBasis for several rays.
  struct Cubic {
    Batch value[4], derivative[4];
    Cubic(int, Batch t) {
      const Batch s = Batch(1.0) - t, ss = s * s, st = s * t, tt = t * t, three(3.0), six(6.0);
      value[0] = ss * s, value[1] = three * ss * t, value[2] = three * s * tt, value[3] = tt * t;
      derivative[0] = Batch(-3.0) * ss, derivative[1] = three * ss - six * st, derivative[2] = six * st - three * tt;
      derivative[3] = three * tt;
    }
  };
  /// LowBasis for several rays.
  struct Low {
    Batch value[4], derivative[4];
    Low(int degree, Batch t) {
      value[0] = Batch(1.0);
      for (int n = 1; n < degree; ++n) raise(n, t);
      const Batch times(static_cast<double>(degree));
      Batch before(0.0);
      for (int i = 0; i < degree; ++i) {
        derivative[i] = times * (before - value[i]);
        before = value[i];
      }
      derivative[degree] = times * before;
      raise(degree, t);
    }
    void raise(int n, Batch t) {
      const Batch s = Batch(1.0) - t;
      value[n] = t * value[n - 1];
      for (int i = n - 1; i > 0; --i) value[i] = s * value[i] + t * value[i - 1];
      value[0] = value[0] * s;
    }
  };

  Batch coordinate(int point, int c) const { return Batch(job_.points[3 * point + c] - job_.centre[c]); }

  void evaluate(Batch u_at, Batch v_at, Batch (&position)[3], Batch (&du)[3], Batch (&dv)[3]) const {
    if constexpr (Rational) {
      evaluate_rational(u_at, v_at, position, du, dv);
    } else {
      evaluate_cubic(u_at, v_at, position, du, dv);
    }
    const Batch scale(job_.scale);
    for (int c = 0; c < 3; ++c) position[c] = scale * position[c], du[c] = scale * du[c], dv[c] = scale * dv[c];
  }

  void evaluate_cubic(Batch u_at, Batch v_at, Batch (&position)[3], Batch (&du)[3], Batch (&dv)[3]) const {
    const Cubic u(3, u_at), v(3, v_at);
    for (int c = 0; c < 3; ++c) {
      position[c] = du[c] = dv[c] = Batch(0.0);
      for (int i = 0; i < 4; ++i) {
        const Batch first = coordinate(4 * i, c);
        Batch row = v.value[0] * first, row_v = v.derivative[0] * first;
        for (int j = 1; j < 4; ++j) {
          const Batch point = coordinate(4 * i + j, c);
          row = L::fma(v.value[j], point, row);
          row_v = L::fma(v.derivative[j], point, row_v);
        }
        position[c] = L::fma(u.value[i], row, position[c]);
        du[c] = L::fma(u.derivative[i], row, du[c]);
        dv[c] = L::fma(u.value[i], row_v, dv[c]);
      }
    }
  }

  void evaluate_rational(Batch u_at, Batch v_at, Batch (&position)[3], Batch (&du)[3], Batch (&dv)[3]) const {
    const Low u(job_.degree_u, u_at), v(job_.degree_v, v_at);
    const Batch zero(0.0);
    Batch w = zero, wu = zero, wv = zero;
    for (int c = 0; c < 3; ++c) position[c] = du[c] = dv[c] = zero;
    for (int i = 0, point = 0; i <= job_.degree_u; ++i) {
      Batch row[3] = {zero, zero, zero}, row_v[3] = {zero, zero, zero}, weight = zero, weight_v = zero;
      for (int j = 0; j <= job_.degree_v; ++j, ++point) {
        const Batch by(job_.weights[point]), b = v.value[j] * by, d = v.derivative[j] * by;
        for (int c = 0; c < 3; ++c) {
          const Batch x = coordinate(point, c);
          row[c] = L::fma(b, x, row[c]);
          row_v[c] = L::fma(d, x, row_v[c]);
        }
        weight = weight + b, weight_v = weight_v + d;
      }
      for (int c = 0; c < 3; ++c) {
        position[c] = L::fma(u.value[i], row[c], position[c]);
        du[c] = L::fma(u.derivative[i], row[c], du[c]);
        dv[c] = L::fma(u.value[i], row_v[c], dv[c]);
      }
      w = w + u.value[i] * weight, wu = wu + u.derivative[i] * weight, wv = wv + u.value[i] * weight_v;
    }
    const Batch inverse = Batch(1.0) / w;
    for (int c = 0; c < 3; ++c) {
      position[c] = inverse * position[c];
      du[c] = inverse * L::fma(-wu, position[c], du[c]);
      dv[c] = inverse * L::fma(-wv, position[c], dv[c]);
    }
  }

  const PolishJob& job_;
  PolishedRays& rays_;
  int first_;
};

template <bool Rational>
void polish_roots(const PolishJob& job, PolishedRays& rays, unsigned lanes) {
  constexpr int width = Lanes<double>::width;
  for (int first = 0; first < PolishedRays::size; first += width) {
    if ((lanes >> first & ((1u << width) - 1u)) != 0) RootPolish<Rational>(job, rays, first).run();
  }
}
