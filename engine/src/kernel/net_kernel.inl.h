// Control nets of a block's patches, `[number]` in the memory of each, taken as `[number][lane]`. Included by isa_*.cpp as
// grid_kernel.inl.h is.

/// use(number, component, values of the lanes) for each number of L::width nets; the component is known when compiled.
template <class L, class Use>
inline void for_numbers(const double* const* nets, std::size_t count, Use use) {
  constexpr std::size_t width = L::width, run = 3 * width;
  typename L::Batch tile[width];
  std::size_t k = 0;
  for (; k + run <= count; k += run) {
#pragma GCC unroll 3
    for (std::size_t t = 0; t < run; t += width) {
      for (std::size_t l = 0; l < width; ++l) tile[l] = L::Batch::load_unaligned(nets[l] + k + t);
      L::transpose(tile);
#pragma GCC unroll 8
      for (std::size_t r = 0; r < width; ++r) use(k + t + r, (t + r) % 3, tile[r]);
    }
  }
  alignas(64) double values[width];
  for (; k < count; k += 3) {
#pragma GCC unroll 3
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t l = 0; l < width; ++l) values[l] = nets[l][k + c];
      use(k + c, c, L::load(values));
    }
  }
}

/// The same bits on every ISA: a sum of doubles, rounded to T.
template <class T>
void pack_nets(const PackJob<T>& job) {
  using L = Lanes<double>;
  const typename L::Batch shift[3] = {L::broadcast(job.shift[0]), L::broadcast(job.shift[1]), L::broadcast(job.shift[2])};
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

/// The box of points that lie together.
inline void bound_points(const double* points, std::size_t count, double (&lower)[3], double (&upper)[3]) {
  using L = Lanes<double>;
  using Batch = L::Batch;
  constexpr std::size_t width = L::width, run = 3 * width;
  const auto extend = [&](std::size_t c, double value) {
    lower[c] = value < lower[c] ? value : lower[c];
    upper[c] = value > upper[c] ? value : upper[c];
  };
  std::size_t k = 0;
  if (count >= run) {
    Batch low[3], high[3];
    for (std::size_t t = 0; t < 3; ++t) low[t] = high[t] = Batch::load_unaligned(points + t * width);
    for (k = run; k + run <= count; k += run) {
#pragma GCC unroll 3
      for (std::size_t t = 0; t < 3; ++t) {
        const Batch values = Batch::load_unaligned(points + k + t * width);
        low[t] = xsimd::min(low[t], values);
        high[t] = xsimd::max(high[t], values);
      }
    }
    alignas(64) double values[2][run];
    for (std::size_t t = 0; t < 3; ++t) {
      L::store(values[0] + t * width, low[t]);
      L::store(values[1] + t * width, high[t]);
    }
    for (std::size_t n = 0; n < run; ++n) {
      extend(n % 3, values[0][n]);
      extend(n % 3, values[1][n]);
    }
  }
  for (; k < count; ++k) extend(k % 3, points[k]);
}

/// Products and sums rounded one by one, in order: the same bits on every ISA.
inline void combine_rows(const CombineJob& job) {
  using L = Lanes<double>;
  using Batch = L::Batch;
  std::size_t x = 0;
  for (; x + L::width <= job.width; x += L::width) {
    const double* row = job.rows + x;
    Batch sum = L::broadcast(job.weights[0]) * Batch::load_unaligned(row);
    for (std::size_t k = 1; k < job.count; ++k)
      sum = sum + L::broadcast(job.weights[k]) * Batch::load_unaligned(row + k * job.stride);
    sum.store_unaligned(job.out + x);
  }
  for (; x < job.width; ++x) {
    double sum = job.weights[0] * job.rows[x];
    for (std::size_t k = 1; k < job.count; ++k) sum += job.weights[k] * job.rows[k * job.stride + x];
    job.out[x] = sum;
  }
}
