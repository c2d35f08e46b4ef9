#pragma once
// A packet of rays against a piece, lanes = rays in float: LeafTrace (ray_kernel.inl.h) as long as each ray has one
// rectangle, by the same operations in the same order, so that a ray hits what it hits alone. Needs Lanes<float>.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/four_floats.h, kernel/ray/ray_kernels.h.

#include "kernel/ray/ray_kernel.inl.h"

template <bool Rational>
class PacketTrace {
  using L = Lanes<float>;
  using Batch = L::Batch;
  using Where = decltype(Batch() < Batch());

 public:
  PacketTrace(const RayLeaf& leaf, RayPacket& rays, int first) : leaf_(leaf), rays_(rays), first_(first) {}

  void run() {
    Where open = start();
    state_ = xsimd::select(open, Batch(RayPacket::undecided), Batch(RayPacket::nothing));
    if (leaf_.noise < 1) {
      for (int k = 0; k < max_rectangles && xsimd::any(open); ++k) open = visit(open);
    }
    L::store(rays_.state + first_, state_);
  }

 private:
  static constexpr int max_rectangles = 4;
  static constexpr float epsilon = 0x1p-24f;
  static constexpr int step = Rational ? 4 : 3;

  Batch load(const float* from) const { return L::load(from + first_); }
  void keep(Where where, float* to, Batch x) const { L::store(to + first_, xsimd::select(where, x, load(to))); }

  Where start() {
    Batch d[3], from[3], away[3];
    for (int i = 0; i < 3; ++i) {
      d[i] = load(rays_.direction[i]);
      from[i] = Batch(leaf_.centre[i]) - load(rays_.origin[i]);
    }
    shift_ = from[0] * d[0] + from[1] * d[1] + from[2] * d[2];
    for (int i = 0; i < 3; ++i) away[i] = L::fms(shift_, d[i], from[i]);
    Batch along[3], inverse[3], nearest[3], farthest[3];
    for (int c = 0; c < 3; ++c) {
      const Batch x(leaf_.axis_x[c]), y(leaf_.axis_y[c]), z(leaf_.axis_z[c]);
      const Batch slope = L::fma(x, d[0], L::fma(y, d[1], z * d[2]));
      along[c] = xsimd::copysign(xsimd::max(xsimd::abs(slope), Batch(1e-18f)), slope);
      inverse[c] = Batch(1.0f) / along[c];
      origin_[c] = L::fma(x, away[0], L::fma(y, away[1], z * away[2]));
      const Batch in = (Batch(leaf_.lower[c]) - origin_[c]) * inverse[c],
                  out = (Batch(leaf_.upper[c]) - origin_[c]) * inverse[c];
      nearest[c] = xsimd::min(in, out), farthest[c] = xsimd::max(in, out);
    }
    const Batch enter = xsimd::max(xsimd::max(nearest[0], nearest[1]), nearest[2]);
    const Batch leave = xsimd::min(xsimd::min(farthest[0], farthest[1]), farthest[2]);
    Where touches = xsimd::max(enter, load(rays_.near) - shift_) <= xsimd::min(leave, load(rays_.far) - shift_);
    const Batch spread(leaf_.spread), reach(RayLeaf::reach);
    for (int c = 0; c < 2; ++c) {
      const Batch a = L::fma(enter, along[c], origin_[c]), b = L::fma(leave, along[c], origin_[c]);
      low_[c] = xsimd::max(xsimd::min(a, b) - spread, -reach);
      high_[c] = xsimd::min(xsimd::max(a, b) + spread, reach);
      touches = touches & (low_[c] <= high_[c]);
    }
    const Batch a = xsimd::abs(along[0]), b = xsimd::abs(along[1]), c = xsimd::abs(along[2]);
    third_ = (c >= a) & (c >= b);
    first_largest_ = a >= b;
    inverse_ = largest(inverse);
    slope_x_ = one_after(along) * inverse_;
    slope_y_ = two_after(along) * inverse_;
    return touches;
  }

  // Select from three components the one along which the ray runs most, and the two others as LeafTrace orders them.
  Batch largest(const Batch* x) const { return xsimd::select(third_, x[2], xsimd::select(first_largest_, x[0], x[1])); }
  Batch one_after(const Batch* x) const {
    return xsimd::select(third_, x[0], xsimd::select(first_largest_, x[1], x[2]));
  }
  Batch two_after(const Batch* x) const {
    return xsimd::select(third_, x[1], xsimd::select(first_largest_, x[2], x[0]));
  }

  /// Values by component, the weight last.
  struct Value {
    Batch q[step], qu[step], qv[step];
  };

  void evaluate(Batch u, Batch v, Value& out) const {
    const float* const c = leaf_.coefficients();
    for (int k = 0; k < step; ++k) {
      Batch row[4], row_v[4];
      for (int i = 0; i < 4; ++i) {
        const auto at = [&](int j) { return Batch(c[(4 * i + j) * step + k]); };
        Batch p = L::fma(at(3), v, at(2));
        const Batch pv = L::fma(at(3), v, p);
        p = L::fma(p, v, at(1));
        row_v[i] = L::fma(pv, v, p);
        row[i] = L::fma(p, v, at(0));
      }
      Batch p = L::fma(row[3], u, row[2]);
      Batch pu = L::fma(row[3], u, p);
      p = L::fma(p, u, row[1]);
      pu = L::fma(pu, u, p);
      out.q[k] = L::fma(p, u, row[0]);
      out.qu[k] = pu;
      out.qv[k] = L::fma(L::fma(L::fma(row_v[3], u, row_v[2]), u, row_v[1]), u, row_v[0]);
    }
    for (int k = 0; k < 3; ++k) {
      if constexpr (Rational) {  // q = r - o w, homogeneous
        out.q[k] = L::fnma(origin_[k], out.q[3], out.q[k]);
        out.qu[k] = L::fnma(origin_[k], out.qu[3], out.qu[k]);
        out.qv[k] = L::fnma(origin_[k], out.qv[3], out.qv[k]);
      } else {
        out.q[k] = out.q[k] - origin_[k];
      }
    }
  }

  void remainder(Batch u, Batch v, Batch (&out)[step]) const {
    const Batch half(0.5f), uu = half * u * u, uv = u * v, vv = half * v * v;
    for (int k = 0; k < step; ++k)
      out[k] = L::fma(Batch(leaf_.bend_uu[k]), uu, L::fma(Batch(leaf_.bend_uv[k]), uv, Batch(leaf_.bend_vv[k]) * vv));
    if constexpr (Rational) {
      for (int k = 0; k < 3; ++k) out[k] = L::fma(xsimd::abs(origin_[k]), out[3], out[k]);
    }
  }

  static Batch size(Batch x) { return xsimd::abs(x); }

  /// LeafTrace::Model for several rays.
  struct Model {
    Batch u, v, ru, rv;
    Batch f, g, fu, fv, gu, gv;
    Batch ef, eg, noise;
    Batch qm, qum, qvm, rest_m;  ///< for the coordinate along the ray
    Value at;
    Batch rest[step];
  };

  void set_model(Model& m) const {
    const Batch half(0.5f), loose(1.001f), tiny(2 * epsilon);
    m.u = half * (low_[0] + high_[0]), m.v = half * (low_[1] + high_[1]);
    m.ru = half * (high_[0] - low_[0]) + tiny, m.rv = half * (high_[1] - low_[1]) + tiny;
    evaluate(m.u, m.v, m.at);
    remainder(m.ru, m.rv, m.rest);
    m.qm = largest(m.at.q), m.qum = largest(m.at.qu), m.qvm = largest(m.at.qv);
    m.rest_m = largest(m.rest);
    m.f = one_after(m.at.q) - slope_x_ * m.qm, m.g = two_after(m.at.q) - slope_y_ * m.qm;
    m.fu = one_after(m.at.qu) - slope_x_ * m.qum, m.fv = one_after(m.at.qv) - slope_x_ * m.qvm;
    m.gu = two_after(m.at.qu) - slope_y_ * m.qum, m.gv = two_after(m.at.qv) - slope_y_ * m.qvm;
    m.noise = Batch(2.0f) * (Batch(leaf_.noise) + Batch(leaf_.slope_noise) * (m.ru + m.rv));
    m.ef = loose * (one_after(m.rest) + size(slope_x_) * m.rest_m + m.noise + Batch(4 * epsilon) * size(m.f));
    m.eg = loose * (two_after(m.rest) + size(slope_y_) * m.rest_m + m.noise + Batch(4 * epsilon) * size(m.g));
  }

  /// Visits one rectangle, as LeafTrace::visit and newton. Returns the lanes where a smaller one is to be visited.
  Where visit(Where open) {
    const Batch half(0.5f), loose(1.001f), tiny(4 * epsilon);
    Model m;
    set_model(m);
    const Where off = (size(m.f) > loose * (size(m.fu) * m.ru + size(m.fv) * m.rv) + m.ef) |
                      (size(m.g) > loose * (size(m.gu) * m.ru + size(m.gv) * m.rv) + m.eg);
    const Batch determinant = m.fu * m.gv - m.fv * m.gu, products = size(m.fu * m.gv) + size(m.fv * m.gu);
    const Where regular = size(determinant) > Batch(1e-4f) * products;
    const Batch inverse = Batch(1.0f) / determinant, over = size(inverse);
    const Batch inexact = Batch(16 * epsilon) * products * over;
    const Batch bu = loose * (over * (size(m.gv) * m.ef + size(m.fv) * m.eg) + inexact * m.ru) + tiny;
    const Batch bv = loose * (over * (size(m.gu) * m.ef + size(m.fu) * m.eg) + inexact * m.rv) + tiny;
    const Batch du = -(m.gv * m.f - m.fv * m.g) * inverse, dv = -(m.fu * m.g - m.gu * m.f) * inverse;
    const Batch u0 = m.u + du - bu, u1 = m.u + du + bu, v0 = m.v + dv - bv, v1 = m.v + dv + bv;
    const Where unique = (bu <= Batch(0.45f) * m.ru) & (bv <= Batch(0.45f) * m.rv);
    const Where proven = unique & (u0 >= low_[0]) & (u1 <= high_[0]) & (v0 >= low_[1]) & (v1 <= high_[1]);
    const Where inside = proven & (u0 >= -half) & (u1 <= half) & (v0 >= -half) & (v1 <= half);
    const Where narrow = (bu + bv < Batch(1.0f / 128)) | (m.ef + m.eg < Batch(8.0f) * m.noise);
    const Where at_border = proven & !inside & narrow;  // decided in double for each ray alone
    low_[0] = xsimd::max(low_[0], u0), high_[0] = xsimd::min(high_[0], u1);
    low_[1] = xsimd::max(low_[1], v0), high_[1] = xsimd::min(high_[1], v1);
    const Where outside = (low_[0] > high_[0]) | (low_[1] > high_[1]) | (low_[0] > half) | (high_[0] < -half) |
                          (low_[1] > half) | (high_[1] < -half);
    const Where leaves = off | (regular & outside), ends = open & regular & !leaves & inside;
    state_ = xsimd::select((open & leaves) | ends, Batch(RayPacket::nothing), state_);
    add_roots(m, ends, du, dv, bu, bv);
    const Where narrower = (high_[0] - low_[0] < Batch(1.2f) * m.ru) | (high_[1] - low_[1] < Batch(1.2f) * m.rv);
    const Where resolves = m.ef + m.eg >= Batch(4.0f) * m.noise;  // otherwise smaller rectangles decide no more
    return open & regular & !leaves & !inside & !at_border & (unique | (narrower & resolves));
  }

  void add_roots(const Model& m, Where where, Batch du, Batch dv, Batch bu, Batch bv) {
    Batch along = m.qm + m.qum * du + m.qvm * dv;
    Batch error = m.rest_m + size(m.qum) * bu + size(m.qvm) * bv + Batch(2 * leaf_.noise);
    if constexpr (Rational) {
      along = along / (m.at.q[3] + m.at.qu[3] * du + m.at.qv[3] * dv);
      error = error + size(along) * (m.rest[3] + size(m.at.qu[3]) * bu + size(m.at.qv[3]) * bv);
      error = error / Batch(leaf_.lightest);
    }
    const Batch s = shift_ + along * inverse_;
    // The last term is that of LeafTrace::add_root().
    const Batch s_error = Batch(1.01f) * error * size(inverse_) + Batch(2e-6f);
    const Where root = where & (s - s_error <= load(rays_.far)) & (s + s_error >= load(rays_.near));
    state_ = xsimd::select(root, Batch(RayPacket::root), state_);
    keep(root, rays_.u, m.u + du);
    keep(root, rays_.v, m.v + dv);
    keep(root, rays_.s, s);
    keep(root, rays_.radius_u, bu);
    keep(root, rays_.radius_v, bv);
    keep(root, rays_.s_error, s_error);
  }

  const RayLeaf& leaf_;
  RayPacket& rays_;
  int first_;
  Batch origin_[3], shift_, inverse_, slope_x_, slope_y_;
  Batch low_[2], high_[2];
  Batch state_;
  Where third_, first_largest_;
};

template <bool Rational>
void trace_packet(const RayLeaf& leaf, RayPacket& rays, unsigned lanes) {
  constexpr int width = Lanes<float>::width;
  for (int first = 0; first < RayPacket::size; first += width) {
    if ((lanes >> first & ((1u << width) - 1u)) != 0) PacketTrace<Rational>(leaf, rays, first).run();
  }
}
