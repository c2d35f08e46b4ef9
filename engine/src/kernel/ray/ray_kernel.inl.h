#pragma once
// A ray against a piece of a patch, in `Four`, vectors of the coordinates: interval Newton steps on rectangles of the
// parameters, from values, first derivatives and bounds of second ones. One rectangle is nearly always enough.
//
// The ray is x = o + tau d in the piece's coordinates, and m is the largest component of d.
// 1. The two other components of q(u,v) = r(u,v) - o give the equations F_k = q_k - (d_k / d_m) q_m = 0.
// 2. On a rectangle of middle c and half widths h, F(x) = F(c) + J (x - c) + E with |E_k| <= 1/2 sum |second
//    derivatives| h h =: R_k (Taylor), noise included.
// 3. With A = J^-1 every root lies in the image c - A F(c) +- |A| R.
// 4. T(x) = x - A F(x) maps the rectangle into the image, and contracts by 2 |A| R / h in the norm weighted by h.
// 5. So if |A| R < h / 2 there is at most one root, and exactly one if the image lies inside the rectangle (Brouwer;
//    Neumaier, Interval Methods for Systems of Equations, sec. 5.1).
//
// All rounding here is less than RayLeaf::noise and a factor of 1.001 allow for.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/four_floats.h, kernel/ray/ray_kernels.h.

/// A rectangle of parameters.
struct RayBox {
  float u0, u1, v0, v1;
};

enum class RayStep { leave, root, narrow, split, open };

template <bool Rational>
class LeafTrace {
 public:
  LeafTrace(const RayLeaf& leaf, const RayProbe& ray) : leaf_(leaf), ray_(ray) {}

  bool run(RayRoots& roots) {
    roots.count = 0;
    RayBox stack[stack_size];
    if (!start(stack[0])) return true;
    if (!(leaf_.noise < 1)) return false;
    int size = 1;
    for (int visited = 0; size > 0; ++visited) {
      if (visited == max_visits) return false;
      RayBox& box = stack[size - 1];
      switch (visit(box, roots)) {
        case RayStep::leave:
          --size;
          break;
        case RayStep::root:
          if (ray_.any && is_last_inside(roots)) return true;
          --size;
          break;
        case RayStep::narrow:
          break;
        case RayStep::split:
          if (size == stack_size) return false;
          split(box, stack[size]);
          ++size;
          break;
        case RayStep::open:
          return false;
      }
    }
    return true;
  }

 private:
  static constexpr int max_visits = 24, stack_size = 8;
  static constexpr float epsilon = 0x1p-24f;
  static constexpr int step = Rational ? 4 : 3;

  /// Makes the last root the first if it is inside.
  static bool is_last_inside(RayRoots& roots) {
    const RayRoot last = roots.root[roots.count - 1];
    if (last.at_border) return false;
    roots.root[roots.count - 1] = roots.root[0], roots.root[0] = last;
    return true;
  }

  /// Finds the ray in the piece's coordinates and the rectangle where its roots lie. Both do not depend on where the
  /// ray begins and ends, so neither does a root. Returns false if the ray misses the box.
  bool start(RayBox& box) {
    const Four from = Fours::load(leaf_.centre) - Fours::load(ray_.origin), d = Fours::load(ray_.direction);
    shift_ = Fours::sum3(from * d);
    const Four away = Fours::fms(Fours::all(shift_), d, from);  // from the centre to the ray's nearest point
    const Four x = Fours::load(leaf_.axis_x), y = Fours::load(leaf_.axis_y), z = Fours::load(leaf_.axis_z);
    const Four along = Fours::away_from_zero(
        Fours::fma(x, Fours::lane<0>(d), Fours::fma(y, Fours::lane<1>(d), z * Fours::lane<2>(d))));
    const Four inverse = Fours::all(1.0f) / along;
    origin_ = Fours::fma(x, Fours::lane<0>(away), Fours::fma(y, Fours::lane<1>(away), z * Fours::lane<2>(away)));
    const Four in = (Fours::load(leaf_.lower) - origin_) * inverse,
               out = (Fours::load(leaf_.upper) - origin_) * inverse;
    const float enter = Fours::max3(Fours::min(in, out)), leave = Fours::min3(Fours::max(in, out));
    if (!(max_of(enter, ray_.near - shift_) <= min_of(leave, ray_.far - shift_))) return false;
    const Four a = Fours::fma(Fours::all(enter), along, origin_), b = Fours::fma(Fours::all(leave), along, origin_);
    const Four spread = Fours::all(leaf_.spread), reach = Fours::all(RayLeaf::reach);
    alignas(16) float low[4], high[4];
    Fours::store(low, Fours::max(Fours::min(a, b) - spread, Fours::all(0.0f) - reach));
    Fours::store(high, Fours::min(Fours::max(a, b) + spread, reach));
    box = {low[0], high[0], low[1], high[1]};
    if (!(low[0] <= high[0] && low[1] <= high[1])) return false;
    choose_axis(along, inverse);
    return true;
  }

  void choose_axis(Four along, Four inverse) {
    alignas(16) float d[4], over[4];
    Fours::store(d, along);
    Fours::store(over, inverse);
    const float a = magnitude(d[0]), b = magnitude(d[1]), c = magnitude(d[2]);
    m_ = c >= a && c >= b ? 2 : a >= b ? 0 : 1;
    x_ = m_ == 2 ? 0 : m_ + 1;
    y_ = m_ == 0 ? 2 : m_ - 1;
    inverse_ = over[m_];
    slope_x_ = d[x_] * inverse_;
    slope_y_ = d[y_] * inverse_;
  }

  /// The point q and its derivatives at one parameter.
  struct Value {
    alignas(16) float q[4], qu[4], qv[4];
  };

  void evaluate(float u_at, float v_at, Value& out) const {
    const Four u = Fours::all(u_at), v = Fours::all(v_at);
    const float* c = leaf_.coefficients();
    Four row[4], row_v[4];
    for (int i = 0; i < 4; ++i, c += 4 * step) {
      Four p = Fours::fma(Fours::load(c + 3 * step), v, Fours::load(c + 2 * step));
      Four pv = Fours::fma(Fours::load(c + 3 * step), v, p);
      p = Fours::fma(p, v, Fours::load(c + step));
      row_v[i] = Fours::fma(pv, v, p);
      row[i] = Fours::fma(p, v, Fours::load(c));
    }
    Four p = Fours::fma(row[3], u, row[2]);
    Four pu = Fours::fma(row[3], u, p);
    p = Fours::fma(p, u, row[1]);
    pu = Fours::fma(pu, u, p);
    p = Fours::fma(p, u, row[0]);
    const Four pv = Fours::fma(Fours::fma(Fours::fma(row_v[3], u, row_v[2]), u, row_v[1]), u, row_v[0]);
    if constexpr (Rational) {  // q = r - o w, homogeneous
      Fours::store(out.q, Fours::with_last(Fours::fnma(origin_, Fours::lane<3>(p), p), p));
      Fours::store(out.qu, Fours::with_last(Fours::fnma(origin_, Fours::lane<3>(pu), pu), pu));
      Fours::store(out.qv, Fours::with_last(Fours::fnma(origin_, Fours::lane<3>(pv), pv), pv));
    } else {
      Fours::store(out.q, p - origin_);
      Fours::store(out.qu, pu);
      Fours::store(out.qv, pv);
    }
  }

  /// Computes half the second derivatives' bounds on a rectangle of half widths u, v.
  void remainder(float u, float v, float (&out)[4]) const {
    Four sum = Fours::fma(Fours::load(leaf_.bend_uu), Fours::all(0.5f * u * u),
                          Fours::fma(Fours::load(leaf_.bend_uv), Fours::all(u * v),
                                     Fours::load(leaf_.bend_vv) * Fours::all(0.5f * v * v)));
    if constexpr (Rational) sum = Fours::with_last(Fours::fma(Fours::abs(origin_), Fours::lane<3>(sum), sum), sum);
    Fours::store(out, sum);
  }

  /// F = (f, g) at the middle of a rectangle of half widths ru, rv, its derivatives, and bounds of the errors of the
  /// linear model.
  struct Model {
    float u, v, ru, rv;
    float f, g, fu, fv, gu, gv;
    float ef, eg, noise;
    float rest_m, rest_w;  ///< errors of the coordinate along the ray and of the weight
  };

  Model model_of(const RayBox& box, Value& at) const {
    Model m;
    m.u = 0.5f * (box.u0 + box.u1), m.v = 0.5f * (box.v0 + box.v1);
    m.ru = 0.5f * (box.u1 - box.u0) + 2 * epsilon, m.rv = 0.5f * (box.v1 - box.v0) + 2 * epsilon;
    alignas(16) float rest[4];
    evaluate(m.u, m.v, at);
    remainder(m.ru, m.rv, rest);
    m.f = at.q[x_] - slope_x_ * at.q[m_], m.g = at.q[y_] - slope_y_ * at.q[m_];
    m.fu = at.qu[x_] - slope_x_ * at.qu[m_], m.fv = at.qv[x_] - slope_x_ * at.qv[m_];
    m.gu = at.qu[y_] - slope_y_ * at.qu[m_], m.gv = at.qv[y_] - slope_y_ * at.qv[m_];
    m.noise = 2 * (leaf_.noise + leaf_.slope_noise * (m.ru + m.rv));
    m.ef = 1.001f * (rest[x_] + magnitude(slope_x_) * rest[m_] + m.noise + 4 * epsilon * magnitude(m.f));
    m.eg = 1.001f * (rest[y_] + magnitude(slope_y_) * rest[m_] + m.noise + 4 * epsilon * magnitude(m.g));
    m.rest_m = rest[m_], m.rest_w = rest[3];
    return m;
  }

  RayStep visit(RayBox& box, RayRoots& roots) const {
    Value at;
    const Model m = model_of(box, at);
    if (magnitude(m.f) > 1.001f * (magnitude(m.fu) * m.ru + magnitude(m.fv) * m.rv) + m.ef ||
        magnitude(m.g) > 1.001f * (magnitude(m.gu) * m.ru + magnitude(m.gv) * m.rv) + m.eg)
      return RayStep::leave;
    const float determinant = m.fu * m.gv - m.fv * m.gu;
    const float products = magnitude(m.fu * m.gv) + magnitude(m.fv * m.gu);
    if (magnitude(determinant) > 1e-4f * products) {
      const RayStep outcome = newton(m, at, determinant, products, box, roots);
      if (outcome != RayStep::split) return outcome;
    }
    if (is_off_obliquely(m)) return RayStep::leave;
    return m.ef + m.eg < 4 * m.noise ? RayStep::open : RayStep::split;  // smaller rectangles decide no more
  }

  /// Computes the image of the rectangle, in which all roots lie. Returns `split` if that decides nothing.
  RayStep newton(const Model& m, const Value& at, float determinant, float products, RayBox& box,
                 RayRoots& roots) const {
    const float inverse = 1 / determinant, size = magnitude(inverse);
    const float inexact = 16 * epsilon * products * size;  // error of A J as the identity
    const float bu = 1.001f * (size * (magnitude(m.gv) * m.ef + magnitude(m.fv) * m.eg) + inexact * m.ru) + 4 * epsilon;
    const float bv = 1.001f * (size * (magnitude(m.gu) * m.ef + magnitude(m.fu) * m.eg) + inexact * m.rv) + 4 * epsilon;
    const float du = -(m.gv * m.f - m.fv * m.g) * inverse, dv = -(m.fu * m.g - m.gu * m.f) * inverse;
    const RayBox image{m.u + du - bu, m.u + du + bu, m.v + dv - bv, m.v + dv + bv};
    const RayBox both{max_of(box.u0, image.u0), min_of(box.u1, image.u1), max_of(box.v0, image.v0),
                      min_of(box.v1, image.v1)};
    if (both.u0 > both.u1 || both.v0 > both.v1 || both.u0 > 0.5f || both.u1 < -0.5f || both.v0 > 0.5f ||
        both.v1 < -0.5f)
      return RayStep::leave;
    const bool unique = bu <= 0.45f * m.ru && bv <= 0.45f * m.rv;
    if (unique && image.u0 >= box.u0 && image.u1 <= box.u1 && image.v0 >= box.v0 && image.v1 <= box.v1) {
      const bool inside = image.u0 >= -0.5f && image.u1 <= 0.5f && image.v0 >= -0.5f && image.v1 <= 0.5f;
      const bool narrow = bu + bv < 1.0f / 128 || m.ef + m.eg < 8 * m.noise;  // a smaller one seldom crosses a border
      if (inside || narrow) return add_root(m, at, {du, dv, bu, bv}, !inside, roots);
    }
    if (!unique && m.ef + m.eg < 4 * m.noise) return RayStep::open;
    const bool narrower = both.u1 - both.u0 < 1.2f * m.ru || both.v1 - both.v0 < 1.2f * m.rv;
    box = both;
    return unique || narrower ? RayStep::narrow : RayStep::split;
  }

  /// Returns whether the ray misses a piece seen edge on, across the larger derivative.
  static bool is_off_obliquely(const Model& m) {
    const float size_u = magnitude(m.fu) + magnitude(m.gu), size_v = magnitude(m.fv) + magnitude(m.gv);
    const bool by_u = size_u * m.ru >= size_v * m.rv;
    const float nf = by_u ? -m.gu : -m.gv, ng = by_u ? m.fu : m.fv;
    const float value = magnitude(nf * m.f + ng * m.g);
    const float other = magnitude(nf * (by_u ? m.fv : m.fu) + ng * (by_u ? m.gv : m.gu)) * (by_u ? m.rv : m.ru);
    const float sizes = magnitude(nf) * m.ef + magnitude(ng) * m.eg;
    const float rounding = 8 * epsilon * (magnitude(nf) + magnitude(ng)) *
                           (magnitude(m.f) + magnitude(m.g) + size_u * m.ru + size_v * m.rv);
    return value > 1.001f * (other + sizes) + rounding;
  }

  /// Splits the box: `box` becomes the half to be visited later, `other` the one to be visited first.
  static void split(RayBox& box, RayBox& other) {
    other = box;
    if (box.u1 - box.u0 >= box.v1 - box.v0) {
      const float middle = 0.5f * (box.u0 + box.u1);
      box.u1 = middle, other.u0 = middle;
    } else {
      const float middle = 0.5f * (box.v0 + box.v1);
      box.v1 = middle, other.v0 = middle;
    }
  }

  /// The step from the middle to the root, and its error.
  struct Step {
    float du, dv, bu, bv;
  };

  RayStep add_root(const Model& m, const Value& at, const Step& to, bool at_border, RayRoots& roots) const {
    if (roots.count == RayRoots::most) return RayStep::open;
    float along = at.q[m_] + at.qu[m_] * to.du + at.qv[m_] * to.dv;
    float error = m.rest_m + magnitude(at.qu[m_]) * to.bu + magnitude(at.qv[m_]) * to.bv + 2 * leaf_.noise;
    if constexpr (Rational) {
      along /= at.q[3] + at.qu[3] * to.du + at.qv[3] * to.dv;
      error += magnitude(along) * (m.rest_w + magnitude(at.qu[3]) * to.bu + magnitude(at.qv[3]) * to.bv);
      error /= leaf_.lightest;
    }
    // The last term bounds the rounding of shift_, a sum of three products of at most 3.8 in all (4 * 2^-24 * 3.8 <
    // 1e-6), and of s, which is at most 8 (8 * 2^-24 < 5e-7).
    const float s = shift_ + along * inverse_, s_error = 1.01f * error * magnitude(inverse_) + 2e-6f;
    if (s - s_error > ray_.far || s + s_error < ray_.near) return RayStep::leave;
    roots.root[roots.count++] = {m.u + to.du, m.v + to.dv, s, to.bu, to.bv, s_error, at_border};
    return RayStep::root;
  }

  static float magnitude(float x) { return x < 0 ? -x : x; }
  static float min_of(float a, float b) { return b < a ? b : a; }
  static float max_of(float a, float b) { return a < b ? b : a; }

  const RayLeaf& leaf_;
  const RayProbe& ray_;
  Four origin_;
  float shift_ = 0, inverse_ = 0, slope_x_ = 0, slope_y_ = 0;
  int m_ = 2, x_ = 0, y_ = 1;
};

bool trace_polynomial_leaf(const RayLeaf& leaf, const RayProbe& ray, RayRoots& roots) {
  return LeafTrace<false>(leaf, ray).run(roots);
}
bool trace_rational_leaf(const RayLeaf& leaf, const RayProbe& ray, RayRoots& roots) {
  return LeafTrace<true>(leaf, ray).run(roots);
}
