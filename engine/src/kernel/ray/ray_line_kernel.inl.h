#pragma once
// Lines of rays, lanes = rays in double, by the operations of line_of (ray/line/ray_line.cpp) in their order: the same
// numbers. Needs Lanes<double> with a true fused multiply-add.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/four_floats.h, kernel/ray/ray_kernels.h.

class RayLineLanes {
  using L = Lanes<double>;
  using Batch = L::Batch;
  using Where = decltype(Batch() < Batch());

 public:
  RayLineLanes(const RayBundle& rays, const RayRoom& room, int first, RayLines& lines)
      : rays_(rays), room_(room), first_(first), lines_(lines) {}

  void run() {
    for (int i = 0; i < 3; ++i) given_[i] = load(rays_.direction[i]), origin_[i] = load(rays_.origin[i]);
    const Batch scale(room_.scale);
    const Batch stretch = xsimd::sqrt(dot(given_, given_)), inverse = Batch(1.0) / stretch;
    Batch from[3];
    for (int i = 0; i < 3; ++i) {
      direction_[i] = inverse * given_[i];
      from[i] = scale * (origin_[i] - Batch(room_.centre[i]));
    }
    const Batch speed = stretch * scale, base = -dot(from, direction_) / speed;
    for (int i = 0; i < 3; ++i) start_[i] = scale * near_centre(origin_[i], base, given_[i], Batch(room_.centre[i]));
    const Batch shift = -dot(start_, direction_);
    for (int i = 0; i < 3; ++i) start_[i] = start_[i] + shift * direction_[i];
    const Batch slack = Batch(8 * 0x1p-52) * (Batch(1.0) + xsimd::abs(base) * speed);
    const Batch near = (load(rays_.near) - base) * speed - shift, far = (load(rays_.far) - base) * speed - shift;
    for (int i = 0; i < 3; ++i) {
      store(lines_.start[i], start_[i]);
      store(lines_.direction[i], direction_[i]);
    }
    store(lines_.base, base);
    store(lines_.shift, shift);
    store(lines_.speed, speed);
    store(lines_.slack, slack);
    store(lines_.near, near);
    store(lines_.far, far);
    clip(near - slack, far + slack);
    set_across();
    constexpr double finite = std::numeric_limits<double>::max();
    store(lines_.plain, xsimd::select(is_plain() & (speed > Batch(0.0)) & (xsimd::abs(base) <= Batch(finite)),
                                      Batch(1.0), Batch(0.0)));
  }

 private:
  static Batch dot(const Batch (&a)[3], const Batch (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  Batch load(const double* from) const { return L::load(from + first_); }
  void store(double* to, Batch x) const { L::store(to + first_, x); }

  /// Returns origin + t d - centre, rounded as if all but the last sum were exact to twice the precision.
  static Batch near_centre(Batch origin, Batch t, Batch d, Batch centre) {
    const Batch product = t * d, rest = L::fms(t, d, product);
    const Batch from = origin - centre, from_part = from - origin;
    const Batch from_low = (origin - (from - from_part)) + (-centre - from_part);
    const Batch sum = from + product, sum_part = sum - from;
    const Batch sum_low = (from - (sum - sum_part)) + (product - sum_part);
    return sum + (sum_low + (from_low + rest));
  }

  /// Returns whether the ray is valid (is_valid, ray/line/ray_segment.cpp) and no number of it needs care. NaN fails.
  Where is_plain() const {
    constexpr double smallest = 1e-100, parallel = 1e-300;
    const Batch most(RayBundle::max_component), near = load(rays_.near);
    Where yes = (near >= Batch(0.0)) & (near <= load(rays_.far));
    Batch largest(0.0);
    for (int i = 0; i < 3; ++i) {
      yes = yes & (xsimd::abs(origin_[i]) <= most) & (xsimd::abs(given_[i]) <= most) &
            (xsimd::abs(direction_[i]) >= Batch(parallel));
      largest = xsimd::max(largest, xsimd::abs(given_[i]));
    }
    return yes & (largest > Batch(smallest));
  }

  void clip(Batch enter, Batch leave) const {
    for (int i = 0; i < 3; ++i) {
      const Batch inverse = Batch(1.0) / direction_[i];
      const Batch a = (Batch(room_.lower[i]) - start_[i]) * inverse, b = (Batch(room_.upper[i]) - start_[i]) * inverse;
      enter = xsimd::max(enter, xsimd::min(a, b)), leave = xsimd::min(leave, xsimd::max(a, b));
    }
    store(lines_.enter, enter);
    store(lines_.leave, leave);
  }

  void set_across() const {
    const Batch &x = direction_[0], &y = direction_[1], &z = direction_[2], one(1.0);
    const Batch sign = xsimd::select(z < Batch(0.0), -one, one), a = -one / (sign + z), b = x * y * a;
    store(lines_.across[0][0], one + sign * x * x * a);
    store(lines_.across[0][1], sign * b);
    store(lines_.across[0][2], -sign * x);
    store(lines_.across[1][0], b);
    store(lines_.across[1][1], sign + y * y * a);
    store(lines_.across[1][2], -y);
  }

  const RayBundle& rays_;
  const RayRoom& room_;
  int first_;
  RayLines& lines_;
  Batch given_[3], origin_[3], direction_[3], start_[3];
};

void ray_lines(const RayBundle& rays, const RayRoom& room, RayLines& lines) {
  for (int first = 0; first < RayBundle::size; first += Lanes<double>::width)
    RayLineLanes(rays, room, first, lines).run();
}
