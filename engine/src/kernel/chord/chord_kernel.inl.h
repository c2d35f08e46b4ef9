#pragma once
// Bounds on the second derivatives of polynomial patches, lanes = patches of a block, for the rates that keep a
// distance (tess/bounds/chord_bound.h). No multiply-add is fused, so that every instruction set finds the same rates.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

/// Cuts the curve of `count` points, `step` apart, at 1/2. cut[0 .. 2 count - 2] are the points of its lower half and
/// then, from the shared one on, of its upper half.
template <class L>
[[gnu::always_inline]] inline void cut_curve(const typename L::Batch* points, int step, int count,
                                             typename L::Batch* cut, int cut_step) {
  const auto half = L::broadcast(static_cast<float>(0.5));
  typename L::Batch high[max_order];
  for (int i = 0; i < count; ++i) high[i] = points[i * step];
  for (int k = 0; k < count; ++k) {
    cut[k * cut_step] = high[0];
    for (int i = 0; i + 1 < count - k; ++i) high[i] = half * (high[i] + high[i + 1]);
  }
  for (int i = 1; i < count; ++i) cut[(count - 1 + i) * cut_step] = high[i];
}

/// Finds the largest squared lengths of a net's vectors, `[component][i][j]`, rows x columns, in each quarter [2 i +
/// j].
template <class L, int Rows, int Columns>
[[gnu::always_inline]] inline void largest_in_quarters(const typename L::Batch* net, int rows, int columns,
                                                       typename L::Batch (&quarter)[4]) {
  using Batch = typename L::Batch;
  constexpr int max_rows = Rows > 0 ? 2 * Rows - 1 : 2 * max_order,
                max_columns = Columns > 0 ? 2 * Columns - 1 : 2 * max_order;
  if (Rows > 0) rows = Rows, columns = Columns;
  Batch squared[max_rows][max_columns];
  const int cut_rows = 2 * rows - 1, cut_columns = 2 * columns - 1;
  for (int c = 0; c < 3; ++c) {
    Batch by_row[max_rows * (Columns > 0 ? Columns : max_order)];
    const Batch* component = net + c * rows * columns;
    for (int j = 0; j < columns; ++j) cut_curve<L>(component + j, columns, rows, by_row + j, columns);
    for (int i = 0; i < cut_rows; ++i) {
      Batch cut[max_columns];
      cut_curve<L>(by_row + i * columns, 1, columns, cut, 1);
      for (int j = 0; j < cut_columns; ++j) squared[i][j] = c == 0 ? cut[j] * cut[j] : squared[i][j] + cut[j] * cut[j];
    }
  }
  for (int half_u = 0; half_u < 2; ++half_u)
    for (int half_v = 0; half_v < 2; ++half_v) {
      Batch most = L::broadcast(0);
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
          most = xsimd::max(most, squared[half_u * (rows - 1) + i][half_v * (columns - 1) + j]);
      quarter[2 * half_u + half_v] = most;
    }
}

/// Stores one kind of second derivative in all pieces: the whole, the halves of u, the halves of v, the quarters.
template <class L>
[[gnu::always_inline]] inline void store_pieces(const ChordJob& job, int kind, int lane, float factor,
                                                const typename L::Batch (&squared)[4]) {
  typename L::Batch q[4];
  // Covers the rounding of differences of numbers below 1 and of halving them, in three components. The factor 1 +
  // 2^-20 covers the rounding in this function.
  const float rounding = static_cast<float>(0x1p-24 * 1.7321 * (12 + 4 * (job.degree_u + job.degree_v)));
  for (int k = 0; k < 4; ++k)
    q[k] = L::broadcast(factor * static_cast<float>(1 + 0x1p-20)) * (xsimd::sqrt(squared[k]) + L::broadcast(rounding));
  const auto u0 = xsimd::max(q[0], q[1]), u1 = xsimd::max(q[2], q[3]), v0 = xsimd::max(q[0], q[2]),
             v1 = xsimd::max(q[1], q[3]);
  const typename L::Batch pieces[9] = {xsimd::max(u0, u1), u0, u1, v0, v1, q[0], q[1], q[2], q[3]};
  for (int k = 0; k < 9; ++k) L::store(job.pieces + (k * 3 + kind) * block_lanes + lane, pieces[k]);
}

/// Returns the inverse of the power of two above `size`, at least 2^-120, and stores that power in job.unit.
template <class L>
[[gnu::always_inline]] inline typename L::Batch inverse_unit(const ChordJob& job, int lane,
                                                             const typename L::Batch& size) {
  alignas(64) float sizes[L::width], inverse[L::width];
  L::store(sizes, size);
  for (int l = 0; l < L::width; ++l) {
    // The exponent's bits alone are the power of two at or below; 2^k has the inverse 2^-k.
    std::uint32_t bits = __builtin_bit_cast(std::uint32_t, sizes[l]) >> 23;
    if (bits > 252) bits = 252;
    job.unit[lane + l] = __builtin_bit_cast(float, (bits + 1) << 23);
    inverse[l] = __builtin_bit_cast(float, (253 - bits) << 23);
  }
  return L::load(inverse);
}

/// Loads control points in units of the power of two above the largest, so that squares stay in range, and stores this
/// unit in job.unit.
template <class L, int Degree>
[[gnu::always_inline]] inline void scaled_net(const ChordJob& job, int lane, typename L::Batch* net) {
  using Batch = typename L::Batch;
  const int points = Degree > 0 ? (Degree + 1) * (Degree + 1) : (job.degree_u + 1) * (job.degree_v + 1);
  Batch size = L::broadcast(static_cast<float>(0x1p-120));
  for (int k = 0; k < points; ++k)
    for (int c = 0; c < 3; ++c) {
      const Batch value = L::load(job.net + (k * 3 + c) * block_lanes + lane);
      net[c * points + k] = value;
      size = xsimd::max(size, xsimd::abs(value));
    }
  L::store(job.size + lane, size);
  const Batch scale = inverse_unit<L>(job, lane, size);
  for (int k = 0; k < 3 * points; ++k) net[k] = net[k] * scale;
}

/// Writes the hints of patches with the corners (0, 0), (1, 0), (1, 1), (0, 1), in units of the block. The bounds must
/// be written before.
template <class L, bool Rational>
void store_hints(const ChordJob& job, int lane, const typename L::Batch (&corner)[4][3]) {
  using Batch = typename L::Batch;
  struct Vector {
    Batch x, y, z;
  };
  const auto from = [&](int a, int b) {
    return Vector{corner[b][0] - corner[a][0], corner[b][1] - corner[a][1], corner[b][2] - corner[a][2]};
  };
  const auto product = [](const Vector& a, const Vector& b) {
    return Vector{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  };
  const auto dot = [](const Vector& a, const Vector& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; };
  const auto rounding = [](double x) { return L::broadcast(static_cast<float>(x)); };
  const auto kind = [&](int which) { return L::load(job.pieces + which * block_lanes + lane); };
  const Batch others = kind(0) + kind(2), mixed = kind(1), zero = L::broadcast(0);
  const Vector bottom = from(0, 1), top = from(3, 2), left = from(0, 3), right = from(1, 2), diagonal = from(0, 2);
  const auto are_parallel = [&](const Vector& a, const Vector& b) {
    const Vector across = product(a, b);
    return dot(across, across) <= rounding(0x1p-38) * (dot(a, a) + dot(b, b));
  };
  // A mixed derivative that is small beside the others costs a polynomial patch nearly nothing.
  const auto matters = mixed > rounding(Rational ? -1 : 0x1p-6) * others;
  const auto is_sweep = matters & (are_parallel(bottom, top) | are_parallel(left, right));
  const auto is_flat =
      (mixed + others > rounding(0x1p-12)) & (xsimd::abs(dot(product(bottom, left), diagonal)) <=
                                              rounding(0x1p-18) * (dot(bottom, bottom) + dot(diagonal, diagonal)));
  const auto extent = [](const Vector& a) {
    return xsimd::max(xsimd::max(xsimd::abs(a.x), xsimd::abs(a.y)), xsimd::abs(a.z));
  };
  const Batch shortest = xsimd::min(xsimd::min(extent(bottom), extent(top)), xsimd::min(extent(left), extent(right)));
  // Control points are below 1 in units of the block; packing and dividing moves two of them by far less than this.
  const Batch moved = rounding(0x1p-22 * (Rational ? 2 : 1) * (job.degree_u + job.degree_v + 6));
  const auto is_short = (shortest - moved) * L::load(job.unit + lane) <= L::broadcast(job.reach);
  L::store(job.hints + lane, (xsimd::select(is_sweep, L::broadcast(may_be_sweep), zero) +
                              xsimd::select(is_flat, L::broadcast(may_be_flat), zero)) +
                                 xsimd::select(is_short, L::broadcast(may_be_point), zero));
}

template <class L, int Degree>
void bound_lanes(const ChordJob& job, int lane) {
  using Batch = typename L::Batch;
  constexpr int capacity = Degree > 0 ? Degree + 1 : max_order;
  const int m = Degree > 0 ? Degree : job.degree_u, n = Degree > 0 ? Degree : job.degree_v;
  Batch net[3 * capacity * capacity], d[3 * capacity * capacity], quarters[4];
  scaled_net<L, Degree>(job, lane, net);
  const int columns = n + 1, points = (m + 1) * columns;
  const auto at = [&](int c, int i, int j) -> const Batch& { return net[c * points + i * columns + j]; };
  const auto none = [&] {
    for (Batch& quarter : quarters) quarter = L::broadcast(0);
  };
  none();
  int next = 0;
  if (m > 1) {
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i <= m - 2; ++i)
        for (int j = 0; j <= n; ++j) d[next++] = (at(c, i + 2, j) - at(c, i + 1, j)) - (at(c, i + 1, j) - at(c, i, j));
    largest_in_quarters<L, (Degree > 1 ? Degree - 1 : 0), (Degree > 1 ? Degree + 1 : 0)>(d, m - 1, n + 1, quarters);
  }
  store_pieces<L>(job, 0, lane, static_cast<float>(m * (m - 1)), quarters);
  next = 0;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < n; ++j) d[next++] = (at(c, i + 1, j + 1) - at(c, i + 1, j)) - (at(c, i, j + 1) - at(c, i, j));
  largest_in_quarters<L, Degree, Degree>(d, m, n, quarters);
  store_pieces<L>(job, 1, lane, static_cast<float>(m * n), quarters);
  next = 0;
  none();
  if (n > 1) {
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= n - 2; ++j)
          d[next++] = (at(c, i, j + 2) - at(c, i, j + 1)) - (at(c, i, j + 1) - at(c, i, j));
    largest_in_quarters<L, (Degree > 1 ? Degree + 1 : 0), (Degree > 1 ? Degree - 1 : 0)>(d, m + 1, n - 1, quarters);
  }
  store_pieces<L>(job, 2, lane, static_cast<float>(n * (n - 1)), quarters);
  if (!job.hints) return;
  Batch corner[4][3];
  for (int c = 0; c < 3; ++c) {
    corner[0][c] = at(c, 0, 0), corner[1][c] = at(c, m, 0);
    corner[2][c] = at(c, m, n), corner[3][c] = at(c, 0, n);
  }
  store_hints<L, false>(job, lane, corner);
}

template <class L, int Degree>
void bound_chords(const ChordJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) bound_lanes<L, Degree>(job, lane);
}
