// Bounds on the second derivatives of rational patches (tess/chord_bound.h), lanes = patches of a block. Included by the
// units after chord_kernel.inl.h. No multiply-add is fused, so that every instruction set finds the same bounds.
//
// Over a piece whose points lie within R of c and whose weights are at least w_min, with A the points times their weights
// relative to the patch's centre, a bound is max |A'' - c w''| + R max |w''|, over w_min: the second derivatives at the
// control points of the piece's quarters.
//
// Rounding, in units of u = 2^-24 and of the job's unit, in which coefficients and points are below 1, as are the weights;
// k = m + n: A, packed and made relative, is off by at most 5 and its second differences, cut, by 36 + 8 k; those of w by
// 8 + 2 k; A'' - c w'', c below 2, by (36 + 8 k) + 2 (8 + 2 k) + 16; cut weights by 1 + k and points by (13 + 4 k) / w_min.

template <class L>
class RationalChords {
 public:
  RationalChords(const ChordJob& job, int lane)
      : job_(job),
        lane_(lane),
        m_(job.degree_u),
        n_(job.degree_v),
        slope_(static_cast<float>(8 + 2 * (m_ + n_)) * rounding),
        slack_(static_cast<float>(1.7321) * static_cast<float>(68 + 12 * (m_ + n_)) * rounding) {}

  void run() {
    const Batch size = scaled_net();
    find_parts();
    Batch sum = L::broadcast(0), unsure = sum;  // of the bounds of the whole, and how much of that is rounding
    const auto at = [&](int c, int i, int j) -> const Batch& { return net_[c][i * (n_ + 1) + j]; };
    const auto bound = [&](int kind, int rows, int columns, int factor) {
      Batch pieces[9];
      largest(rows, columns, pieces);
      for (int k = 0; k < 9; ++k) {
        pieces[k] = pieces[k] * L::broadcast(static_cast<float>(factor));
        L::store(job_.pieces + (k * 3 + kind) * block_lanes + lane_, pieces[k]);
      }
      sum = sum + pieces[0];
      unsure = unsure + L::broadcast(static_cast<float>(factor)) *
                            (L::broadcast(slack_) + parts_[0].radius * L::broadcast(slope_)) * parts_[0].inverse;
    };
    for (int c = 0; c < 4; ++c)
      for (int i = 0, next = 0; i + 2 <= m_; ++i)
        for (int j = 0; j <= n_; ++j)
          d_[c][next++] = (at(c, i + 2, j) - at(c, i + 1, j)) - (at(c, i + 1, j) - at(c, i, j));
    bound(0, m_ - 1, n_ + 1, m_ * (m_ - 1));
    for (int c = 0; c < 4; ++c)
      for (int i = 0, next = 0; i < m_; ++i)
        for (int j = 0; j < n_; ++j)
          d_[c][next++] = (at(c, i + 1, j + 1) - at(c, i + 1, j)) - (at(c, i, j + 1) - at(c, i, j));
    bound(1, m_, n_, m_ * n_);
    for (int c = 0; c < 4; ++c)
      for (int i = 0, next = 0; i <= m_; ++i)
        for (int j = 0; j + 2 <= n_; ++j)
          d_[c][next++] = (at(c, i, j + 2) - at(c, i, j + 1)) - (at(c, i, j + 1) - at(c, i, j));
    bound(2, m_ + 1, n_ - 1, n_ * (n_ - 1));
    const auto is_sure =
        (L::broadcast(8) * unsure <= sum) & (parts_[0].lightest > L::broadcast(static_cast<float>(1.0 / 64)));
    L::store(job_.size + lane_, xsimd::select(is_sure, size, L::broadcast(-1)));
  }

 private:
  using Batch = typename L::Batch;
  static constexpr int capacity = most_rational_degree + 1, most_cut = 2 * capacity - 1;
  static constexpr float rounding = static_cast<float>(0x1p-24), half = static_cast<float>(0.5);
  /// Of what is done with a few numbers.
  static constexpr float more = static_cast<float>(1 + 0x1p-20);

  /// Where a piece lies: its points are within `radius` of `centre`, relative to the patch's.
  struct Part {
    Batch lower[3], upper[3], centre[3], radius, lightest, inverse;
  };
  static constexpr int whole = 0;
  /// The pieces that a quarter is part of.
  static void pieces_of(int half_u, int half_v, int (&pieces)[4]) {
    pieces[0] = whole;
    pieces[1] = 1 + half_u;
    pieces[2] = 3 + half_v;
    pieces[3] = 5 + 2 * half_u + half_v;
  }

  /// Coefficients in units of the power of two above the largest of them and of the points, relative to the middle of the
  /// points' box. Returns the largest coordinate of a point.
  Batch scaled_net() {
    const int points = (m_ + 1) * (n_ + 1);
    Batch lower[3], upper[3], coefficient = L::broadcast(static_cast<float>(0x1p-120)), size = coefficient;
    for (int k = 0; k < points; ++k) {
      const float* const net = job_.net + k * 4 * block_lanes + lane_;
      net_[3][k] = L::load(net + 3 * block_lanes);
      const Batch inverse = L::broadcast(1) / net_[3][k];
      for (int c = 0; c < 3; ++c) {
        net_[c][k] = L::load(net + c * block_lanes);
        const Batch point = net_[c][k] * inverse;
        lower[c] = k == 0 ? point : xsimd::min(lower[c], point);
        upper[c] = k == 0 ? point : xsimd::max(upper[c], point);
        coefficient = xsimd::max(coefficient, xsimd::abs(net_[c][k]));
      }
    }
    for (int c = 0; c < 3; ++c) size = xsimd::max(size, xsimd::max(xsimd::abs(lower[c]), xsimd::abs(upper[c])));
    const Batch scale = inverse_unit<L>(job_, lane_, xsimd::max(size, coefficient));
    for (int c = 0; c < 3; ++c) {
      const Batch middle = L::broadcast(half) * (scale * lower[c]) + L::broadcast(half) * (scale * upper[c]);
      for (int k = 0; k < points; ++k) net_[c][k] = scale * net_[c][k] - net_[3][k] * middle;
    }
    return size;
  }

  [[gnu::noinline]] static void cut(const Batch* net, int rows, int columns, Batch* to) {
    Batch by_row[most_cut * capacity];
    for (int j = 0; j < columns; ++j) cut_curve<L>(net + j, columns, rows, by_row + j, columns);
    for (int i = 0; i < 2 * rows - 1; ++i) cut_curve<L>(by_row + i * columns, 1, columns, to + i * most_cut, 1);
  }

  void find_parts() {
    for (int c = 0; c < 4; ++c) cut(net_[c], m_ + 1, n_ + 1, cut_[c]);
    for (Part& part : parts_) part.lightest = L::broadcast(2);
    for (int i = 0; i <= 2 * m_; ++i)
      for (int j = 0; j <= 2 * n_; ++j) {
        const Batch weight = cut_[3][i * most_cut + j], inverse = L::broadcast(1) / weight;
        for (int c = 0; c < 3; ++c) cut_[c][i * most_cut + j] = cut_[c][i * most_cut + j] * inverse;
      }
    for (int half_u = 0; half_u < 2; ++half_u)
      for (int half_v = 0; half_v < 2; ++half_v) {
        Part& part = parts_[5 + 2 * half_u + half_v];
        for (int c = 0; c < 3; ++c) part.lower[c] = part.upper[c] = cut_[c][half_u * m_ * most_cut + half_v * n_];
        for (int i = half_u * m_; i <= (half_u + 1) * m_; ++i)
          for (int j = half_v * n_; j <= (half_v + 1) * n_; ++j) {
            for (int c = 0; c < 3; ++c) {
              part.lower[c] = xsimd::min(part.lower[c], cut_[c][i * most_cut + j]);
              part.upper[c] = xsimd::max(part.upper[c], cut_[c][i * most_cut + j]);
            }
            part.lightest = xsimd::min(part.lightest, cut_[3][i * most_cut + j]);
          }
      }
    join(1, 5, 6);
    join(2, 7, 8);
    join(3, 5, 7);
    join(4, 6, 8);
    join(whole, 1, 2);
    for (Part& part : parts_) {
      const float weight = static_cast<float>(2 + m_ + n_) * rounding,
                  place = static_cast<float>(1.7321) * static_cast<float>(13 + 4 * (m_ + n_)) * rounding;
      part.lightest = part.lightest - L::broadcast(weight);
      part.inverse = L::broadcast(more) / part.lightest;
      Batch squared = L::broadcast(0);
      for (int c = 0; c < 3; ++c) {
        part.centre[c] = L::broadcast(half) * (part.lower[c] + part.upper[c]);
        const Batch reach = xsimd::max(part.upper[c] - part.centre[c], part.centre[c] - part.lower[c]);
        squared = squared + reach * reach;
      }
      part.radius = L::broadcast(more) * xsimd::sqrt(squared) + L::broadcast(place) * part.inverse;
    }
  }
  void join(int to, int a, int b) {
    for (int c = 0; c < 3; ++c) {
      parts_[to].lower[c] = xsimd::min(parts_[a].lower[c], parts_[b].lower[c]);
      parts_[to].upper[c] = xsimd::max(parts_[a].upper[c], parts_[b].upper[c]);
    }
    parts_[to].lightest = xsimd::min(parts_[a].lightest, parts_[b].lightest);
  }

  /// Bounds over all pieces of what d_ holds, rows x columns.
  void largest(int rows, int columns, Batch (&pieces)[9]) {
    for (Batch& piece : pieces) piece = L::broadcast(0);
    if (rows == 0 || columns == 0) return;
    for (int c = 0; c < 4; ++c) cut(d_[c], rows, columns, cut_[c]);
    for (int half_u = 0; half_u < 2; ++half_u)
      for (int half_v = 0; half_v < 2; ++half_v) {
        const int first = half_u * (rows - 1) * most_cut + half_v * (columns - 1);
        int of[4];
        pieces_of(half_u, half_v, of);
        for (const int k : of) {
          const Part& part = parts_[k];
          Batch most = L::broadcast(0);
          for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
              const int at = first + i * most_cut + j;
              const Batch w = cut_[3][at], x = cut_[0][at] - part.centre[0] * w, y = cut_[1][at] - part.centre[1] * w,
                          z = cut_[2][at] - part.centre[2] * w;
              most = xsimd::max(most, root(x * x + y * y + z * z) + part.radius * xsimd::abs(w));
            }
          const Batch bound = most + (L::broadcast(slack_) + part.radius * L::broadcast(slope_));
          pieces[k] = xsimd::max(pieces[k], L::broadcast(more) * bound * part.inverse);
        }
      }
  }
  /// The square root, or up to 0.36% more: a step of Newton's from the guess by its exponent is at most 0.1753% too small
  /// (Lomont 2003, Fast inverse square root).
  static Batch root(const Batch& squared) {
    const Batch guess = L::inverse_root_guess(squared);
    const Batch inverse =
        guess * (L::broadcast(static_cast<float>(1.5)) - L::broadcast(half) * squared * guess * guess);
    return L::broadcast(static_cast<float>(1.0018)) * (squared * inverse);
  }

  const ChordJob& job_;
  const int lane_, m_, n_;
  const float slope_, slack_;  // how far second derivatives of w are off, and A'' - c w''
  Batch net_[4][capacity * capacity], d_[4][capacity * capacity], cut_[4][most_cut * most_cut];
  Part parts_[9];
};

template <class L>
void bound_rational_chords(const ChordJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) RationalChords<L>(job, lane).run();
}
