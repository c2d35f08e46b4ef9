#pragma once
// Control nets of a block's patches, lanes = patches: `[number]` in each patch's memory becomes `[number][lane]`.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h, kernel/net/net_kernels.h.

/// Calls use(number, component, values of the lanes) for each number of L::width nets. The component is known at
/// compile time. `copies`: as in PackJob.
template <class L, class Use>
inline void for_numbers(const double* const* nets, double* const* copies, std::size_t count, Use use) {
  constexpr std::size_t width = L::width, run = 3 * width;
  typename L::Batch tile[width];
  std::size_t k = 0;
  const auto use_tile = [&](std::size_t t) __attribute__((always_inline)) {
    for (std::size_t l = 0; l < width; ++l) tile[l] = L::Batch::load_unaligned(nets[l] + k + t);
    if (copies)
      for (std::size_t l = 0; l < width; ++l) tile[l].store_unaligned(copies[l] + k + t);
    L::transpose(tile);
#pragma GCC unroll 8
    for (std::size_t r = 0; r < width; ++r) use(k + t + r, (t + r) % 3, tile[r]);
  };
  for (; k + run <= count; k += run) {
    use_tile(0);
    use_tile(width);
    use_tile(2 * width);
  }
  alignas(64) double values[width];
  const auto use_rest = [&](std::size_t c) __attribute__((always_inline)) {
    for (std::size_t l = 0; l < width; ++l) values[l] = nets[l][k + c];
    if (copies)
      for (std::size_t l = 0; l < width; ++l) copies[l][k + c] = values[l];
    use(k + c, c, L::load(values));
  };
  for (; k < count; k += 3) {
    use_rest(0);
    use_rest(1);
    use_rest(2);
  }
}

/// The box of each of L::width nets, from `lane` on.
template <class L>
class BoxesOfLanes {
 public:
  using Batch = typename L::Batch;

  void extend(std::size_t component, Batch values) {
    lower_[component] = xsimd::min(lower_[component], values);
    upper_[component] = xsimd::max(upper_[component], values);
  }
  void store(NetBoxes& boxes, int lane) const {
    for (int c = 0; c < 3; ++c) {
      L::store(boxes.lower[c] + lane, lower_[c]);
      L::store(boxes.upper[c] + lane, upper_[c]);
    }
  }
  /// Returns the largest |x|, |y|, |z| in the box relative to the origin; rounding keeps the order of values.
  Batch largest(const double (&origin)[3]) const {
    Batch result = L::broadcast(0);
    for (int c = 0; c < 3; ++c) {
      const Batch low = xsimd::abs(lower_[c] - L::broadcast(origin[c]));
      const Batch high = xsimd::abs(upper_[c] - L::broadcast(origin[c]));
      result = xsimd::max(result, xsimd::max(low, high));
    }
    return result;
  }
  Batch diagonal() const {
    const Batch x = upper_[0] - lower_[0], y = upper_[1] - lower_[1], z = upper_[2] - lower_[2];
    return xsimd::sqrt(x * x + y * y + z * z);
  }

 private:
  const Batch infinity_ = L::broadcast(std::numeric_limits<double>::infinity());
  Batch lower_[3] = {infinity_, infinity_, infinity_}, upper_[3] = {-infinity_, -infinity_, -infinity_};
};

/// Returns whether an edge of some lane begins with two equal points; if none does, no edge is a point. Equal doubles
/// are equal in T too.
template <class T>
inline bool may_have_pointed_edge(const PackJob<T>& job) {
  using L = Lanes<T>;
  const int m = job.degree_u, n = job.degree_v, row = n + 1;
  const int first[] = {0, m * row, 0, n}, second[] = {1, m * row + 1, row, n + row};
  for (int edge = 0; edge < 4; ++edge) {
    const T *a = job.out + 3 * block_lanes * first[edge], *b = job.out + 3 * block_lanes * second[edge];
    for (int lane = 0; lane < block_lanes; lane += L::width) {
      auto equal = L::load(a + lane) == L::load(b + lane);
      for (int c = 1; c < 3; ++c)
        equal = equal & (L::load(a + c * block_lanes + lane) == L::load(b + c * block_lanes + lane));
      if (xsimd::any(equal)) return true;
    }
  }
  return false;
}

/// Writes PackJob::thresholds.
template <class T, class L>
inline void write_thresholds(const PackJob<T>& job, typename L::Batch largest, typename L::Batch diagonal, int lane) {
  const auto most = L::broadcast(double{std::numeric_limits<T>::max()});
  const auto noise = L::broadcast(job.noise) * largest, longest = L::broadcast(job.longest) * diagonal;
  const auto length = L::broadcast(4) * noise * longest;
  const auto threshold = xsimd::max(length * length, L::broadcast(job.min_threshold));
  L::store_as(job.thresholds + lane, xsimd::min(threshold, most));
  L::store_as(job.thresholds + block_lanes + lane, xsimd::min(noise, most));
}

/// Gives the same bits on every ISA: a sum of doubles, rounded to T.
template <class T>
void pack_nets(const PackJob<T>& job, PackedNets& found) {
  using L = Lanes<double>;
  typename L::Batch shift[3];  // 0 - x is never -0, nor is a sum with it
  for (int c = 0; c < 3; ++c) shift[c] = L::broadcast(0) - L::broadcast(job.origin[c]);
  const std::size_t count = 3 * static_cast<std::size_t>((job.degree_u + 1) * (job.degree_v + 1));
  for (int lane = 0; lane < block_lanes; lane += L::width) {
    BoxesOfLanes<L> box;
    for_numbers<L>(job.nets + lane, job.copies ? job.copies + lane : nullptr, count,
                   [&](std::size_t k, std::size_t c, typename L::Batch values) {
                     box.extend(c, values);
                     L::store_as(job.out + k * block_lanes + static_cast<std::size_t>(lane), values + shift[c]);
                   });
    box.store(found.boxes, lane);
    const auto largest = box.largest(job.origin);
    L::store(found.largest + lane, largest);
    write_thresholds<T, L>(job, largest, box.diagonal(), lane);
  }
  found.edges_may_be_points = may_have_pointed_edge(job);
}

inline void bound_nets(const double* const* nets, std::size_t count, NetBoxes& boxes) {
  using L = Lanes<double>;
  for (int lane = 0; lane < block_lanes; lane += L::width) {
    BoxesOfLanes<L> box;
    for_numbers<L>(nets + lane, nullptr, count,
                   [&](std::size_t, std::size_t c, typename L::Batch values) { box.extend(c, values); });
    box.store(boxes, lane);
  }
}

/// Extends the bounds by points that lie together.
inline void bound_points(const double* points, std::size_t count, PointBounds& bounds) {
  using L = Lanes<double>;
  using Batch = L::Batch;
  constexpr std::size_t run = PointBounds::run, parts = run / L::width;
  Batch lower[parts], upper[parts];
  for (std::size_t t = 0; t < parts; ++t) {
    lower[t] = L::load(bounds.lower + t * L::width);
    upper[t] = L::load(bounds.upper + t * L::width);
  }
  std::size_t k = 0;
  for (; k + run <= count; k += run)
#pragma GCC unroll 12
    for (std::size_t t = 0; t < parts; ++t) {
      const Batch values = Batch::load_unaligned(points + k + t * L::width);
      lower[t] = xsimd::min(lower[t], values);
      upper[t] = xsimd::max(upper[t], values);
    }
  for (std::size_t t = 0; t < parts; ++t) {
    L::store(bounds.lower + t * L::width, lower[t]);
    L::store(bounds.upper + t * L::width, upper[t]);
  }
  for (std::size_t n = 0; k + n < count; ++n) {
    const double value = points[k + n];
    bounds.lower[n] = value < bounds.lower[n] ? value : bounds.lower[n];
    bounds.upper[n] = value > bounds.upper[n] ? value : bounds.upper[n];
  }
}

inline bool all_within(const double* numbers, std::size_t count, double limit) {
  using L = Lanes<double>;
  using Batch = L::Batch;
  constexpr std::size_t together = 4, run = together * L::width;
  const Batch most = L::broadcast(limit);
  std::size_t k = 0;
  for (; k + run <= count; k += run) {
    auto within = xsimd::abs(Batch::load_unaligned(numbers + k)) <= most;
    for (std::size_t t = 1; t < together; ++t)
      within = within & (xsimd::abs(Batch::load_unaligned(numbers + k + t * L::width)) <= most);
    if (!xsimd::all(within)) return false;
  }
  for (; k < count; ++k)
    if (!(numbers[k] <= limit && numbers[k] >= -limit)) return false;
  return true;
}

/// Combines rows; products and sums are rounded one by one, in order: the same bits on every ISA. Count is std::size_t
/// or a constant.
template <class Count>
inline void combine_rows(const CombineJob& job, Count count) {
  using L = Lanes<double>;
  using Batch = L::Batch;
  std::size_t x = 0;
  for (; x + L::width <= job.width; x += L::width) {
    const double* row = job.rows + x;
    Batch sum = L::broadcast(job.weights[0]) * Batch::load_unaligned(row);
    for (std::size_t k = 1; k < count; ++k)
      sum = sum + L::broadcast(job.weights[k]) * Batch::load_unaligned(row + k * job.stride);
    sum.store_unaligned(job.out + x);
  }
  for (; x < job.width; ++x) {
    double sum = job.weights[0] * job.rows[x];
    for (std::size_t k = 1; k < count; ++k) sum += job.weights[k] * job.rows[k * job.stride + x];
    job.out[x] = sum;
  }
}

inline void combine_rows(const CombineJob& job) {
  switch (job.count) {  // constants for degrees 1 to 3
    case 2:
      return combine_rows(job, std::integral_constant<std::size_t, 2>{});
    case 3:
      return combine_rows(job, std::integral_constant<std::size_t, 3>{});
    case 4:
      return combine_rows(job, std::integral_constant<std::size_t, 4>{});
    default:
      return combine_rows(job, job.count);
  }
}
