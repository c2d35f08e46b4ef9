// Control nets of a block's patches, `[number]` in the memory of each, taken as `[number][lane]`. Included by the units as
// grid_kernel.inl.h is.

/// use(number, component, values of the lanes) for each number of L::width nets; the component is known when compiled.
template <class L, class Use>
inline void for_numbers(const double* const* nets, std::size_t count, Use use) {
  constexpr std::size_t width = L::width, run = 3 * width;
  typename L::Batch tile[width];
  std::size_t k = 0;
  const auto use_tile = [&](std::size_t t) __attribute__((always_inline)) {
    for (std::size_t l = 0; l < width; ++l) tile[l] = L::Batch::load_unaligned(nets[l] + k + t);
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
    use(k + c, c, L::load(values));
  };
  for (; k < count; k += 3) {
    use_rest(0);
    use_rest(1);
    use_rest(2);
  }
}

/// The same bits on every ISA: a sum of doubles, rounded to T.
template <class T>
void pack_nets(const PackJob<T>& job) {
  using L = Lanes<double>;
  const typename L::Batch shift[3] = {L::broadcast(job.shift[0]), L::broadcast(job.shift[1]),
                                      L::broadcast(job.shift[2])};
  for (int lane = 0; lane < block_lanes; lane += L::width)
    for_numbers<L>(job.nets + lane, job.count, [&](std::size_t k, std::size_t c, typename L::Batch values) {
      L::store_as(job.out + k * block_lanes + static_cast<std::size_t>(lane), values + shift[c]);
    });
}

inline void bound_nets(const double* const* nets, std::size_t count, NetBoxes& boxes) {
  using L = Lanes<double>;
  using Batch = L::Batch;
  for (int lane = 0; lane < block_lanes; lane += L::width) {
    const Batch infinity = L::broadcast(std::numeric_limits<double>::infinity());
    Batch lower[3] = {infinity, infinity, infinity}, upper[3] = {-infinity, -infinity, -infinity};
    for_numbers<L>(nets + lane, count, [&](std::size_t, std::size_t c, Batch values) {
      lower[c] = xsimd::min(lower[c], values);
      upper[c] = xsimd::max(upper[c], values);
    });
    for (int c = 0; c < 3; ++c) {
      L::store(boxes.lower[c] + lane, lower[c]);
      L::store(boxes.upper[c] + lane, upper[c]);
    }
  }
}

/// The bounds of points that lie together.
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

/// Products and sums rounded one by one, in order: the same bits on every ISA. Count: std::size_t, or a constant.
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
  switch (job.count) {  // those of degrees 1 to 3
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
