// Bounds on the second derivatives of rational patches themselves, and the deviation of a patch from a scaled sweep
// (tess/chord_bound.h), lanes = patches of a block, in double. Included by the units after chord_kernel.inl.h. No
// multiply-add is fused, so that every instruction set finds the same bounds.

/// A polynomial in two parameters: Bernstein coefficients times their binomials, C(m,i) C(n,j) c_ij, `[i][j]`. Products are
/// then plain convolutions, degree elevation by one adds neighbours, and the factors cancel in quotients of equal degrees.
template <class L>
struct ScaledNet {
  using Batch = typename L::Batch;
  static constexpr int most_order = 3 * most_exact_degree + 1, capacity = most_order * most_order;

  int rows = 0, columns = 0;
  Batch at[capacity];

  int count() const { return rows * columns; }
};

/// Adds (or, with `Minus`, subtracts) factor a b to `sum`, whose shape it has.
template <class L, bool Minus = false>
[[gnu::noinline]] void add_product(const ScaledNet<L>& a, const ScaledNet<L>& b, ScaledNet<L>& sum) {
  for (int i = 0; i < a.rows; ++i)
    for (int j = 0; j < a.columns; ++j) {
      const auto x = a.at[i * a.columns + j];
      for (int k = 0; k < b.rows; ++k)
        for (int l = 0; l < b.columns; ++l) {
          auto& to = sum.at[(i + k) * sum.columns + j + l];
          to = Minus ? to - x * b.at[k * b.columns + l] : to + x * b.at[k * b.columns + l];
        }
    }
}

/// Zeros of the shape of a product.
template <class L>
void clear_for_product(const ScaledNet<L>& a, const ScaledNet<L>& b, ScaledNet<L>& sum) {
  sum.rows = a.rows + b.rows - 1;
  sum.columns = a.columns + b.columns - 1;
  for (int k = 0; k < sum.count(); ++k) sum.at[k] = L::broadcast(0);
}

/// Raises the degree in u, or in v, by one.
template <class L>
void elevate(ScaledNet<L>& net, bool along_u) {
  if (along_u) {
    for (int j = 0; j < net.columns; ++j) net.at[net.count() + j] = L::broadcast(0);
    ++net.rows;
    for (int k = net.count() - 1; k >= net.columns; --k) net.at[k] = net.at[k] + net.at[k - net.columns];
    return;
  }
  const int n = net.columns;
  for (int i = net.rows - 1; i >= 0; --i) {
    auto* const to = net.at + i * (n + 1);
    const auto* const from = net.at + i * n;
    to[n] = from[n - 1];
    for (int j = n - 1; j > 0; --j) to[j] = from[j] + from[j - 1];
    to[0] = from[0];
  }
  ++net.columns;
}

/// p = (1 - t) low + t high: the two polynomials of one degree less, t being u or v.
template <class L>
void split(const ScaledNet<L>& p, bool along_u, ScaledNet<L>& low, ScaledNet<L>& high) {
  const int degree = (along_u ? p.rows : p.columns) - 1;
  low.rows = high.rows = along_u ? p.rows - 1 : p.rows;
  low.columns = high.columns = along_u ? p.columns : p.columns - 1;
  const int step = along_u ? p.columns : 1;
  for (int i = 0; i < low.rows; ++i)
    for (int j = 0; j < low.columns; ++j) {
      const int k = along_u ? i : j;
      const auto share = [&](int of) { return L::broadcast(static_cast<double>(of) / static_cast<double>(degree)); };
      const auto* const from = p.at + i * p.columns + j;
      low.at[i * low.columns + j] = share(degree - k) * from[0];
      high.at[i * low.columns + j] = share(k + 1) * from[step];
    }
}

/// A homogeneous net, `[i][j]`, in ScaledNets.
template <class L>
struct HomogeneousNet {
  ScaledNet<L> point[3], weight;
};

/// The largest second derivatives of S = P / w, w > 0, over all parameters. With P = (1 - u) P0 + u P1 and w likewise,
///   S_u = N / w^2, N = m (w0 P1 - w1 P0), of degree (2 m - 2, 2 n);
///   S_uu = N_uu / w^3, N_uu = (2 m - 2) (w0 N1 - w1 N0) - 2 (w1 - w0) N, of degree (3 m - 3, 3 n);
///   S_uv = N_uv / w^3, N_uv = 2 n (w0 N1 - w1 N0), rows along v, of degree (3 m - 2, 3 n - 2)
/// (quotient rule; leading terms cancel before anything is multiplied). Raised to the degree of w^3, N / w^3 is a rational
/// Bezier form whose points, coefficient over coefficient, bound it.
template <class L>
class ExactDerivatives {
 public:
  using Batch = typename L::Batch;
  using Net = ScaledNet<L>;

  /// The largest |S_uu|, and |S_uv| if asked for, without rounding.
  void find(const HomogeneousNet<L>& patch, bool with_uv) {
    const Net& w = patch.weight;
    const int m = w.rows - 1, n = w.columns - 1;
    uu = uv = L::broadcast(0);
    if (m == 0) return;
    split(w, true, low_, high_);
    slope_ = high_;
    for (int k = 0; k < slope_.count(); ++k) slope_.at[k] = slope_.at[k] - low_.at[k];
    clear_for_product(w, w, square_);
    add_product(w, w, square_);
    clear_for_product(square_, w, cube_);
    add_product(square_, w, cube_);
    for (int k = 0; k < cube_.count(); ++k) {
      cube_.at[k] = L::broadcast(1) / cube_.at[k];
      squared_[0][k] = squared_[1][k] = L::broadcast(0);
    }
    for (const Net& point : patch.point) {
      split(point, true, point_low_, point_high_);
      clear_for_product(low_, point_high_, first_);
      add_product(low_, point_high_, first_);
      add_product<L, true>(high_, point_low_, first_);
      for (int k = 0; k < first_.count(); ++k) first_.at[k] = L::broadcast(m) * first_.at[k];
      add_uu(m);
      if (with_uv && n > 0) add_uv(w, n);
    }
    uu = largest(squared_[0]);
    if (with_uv && n > 0) uv = largest(squared_[1]);
  }

  Batch uu, uv;

 private:
  void add_uu(int m) {
    clear_for_product(slope_, first_, second_);
    if (m > 1) {
      split(first_, true, point_low_, point_high_);
      clear_for_product(low_, point_high_, sum_);
      add_product(low_, point_high_, sum_);
      add_product<L, true>(high_, point_low_, sum_);
      elevate(sum_, true);
      for (int k = 0; k < second_.count(); ++k) second_.at[k] = L::broadcast(m - 1) * sum_.at[k];
    }
    add_product<L, true>(slope_, first_, second_);
    for (int times = 0; times < 3; ++times) elevate(second_, true);
    add_squares(L::broadcast(2), squared_[0]);
  }
  void add_uv(const Net& w, int n) {
    split(first_, false, point_low_, point_high_);
    split(w, false, weight_low_, weight_high_);
    clear_for_product(weight_low_, point_high_, second_);
    add_product(weight_low_, point_high_, second_);
    add_product<L, true>(weight_high_, point_low_, second_);
    for (int times = 0; times < 2; ++times) {
      elevate(second_, true);
      elevate(second_, false);
    }
    add_squares(L::broadcast(2 * n), squared_[1]);
  }
  void add_squares(const Batch& factor, Batch* squares) const {
    for (int k = 0; k < second_.count(); ++k) {
      const Batch x = factor * second_.at[k] * cube_.at[k];
      squares[k] = squares[k] + x * x;
    }
  }
  Batch largest(const Batch* squares) const {
    Batch most = L::broadcast(0);
    for (int k = 0; k < cube_.count(); ++k) most = xsimd::max(most, squares[k]);
    return xsimd::sqrt(most);
  }

  Net low_, high_, slope_, square_, cube_, point_low_, point_high_, weight_low_, weight_high_, first_, second_, sum_;
  Batch squared_[2][Net::capacity];
};

inline double binomial(int n, int k) {
  double value = 1;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

/// A rational curve in homogeneous numbers.
template <class L>
struct HomogeneousCurve {
  typename L::Batch point[3][max_order], weight[max_order];
};

/// The largest second derivative of a curve, without rounding: as ExactDerivatives, in one parameter. `Degree`: 0 for any.
template <class L, int Degree>
typename L::Batch largest_second_derivative(const HomogeneousCurve<L>& curve, int degree) {
  using Batch = typename L::Batch;
  constexpr int most = Degree > 0 ? Degree : max_order - 1;
  const int n = Degree > 0 ? Degree : degree;
  double share[most + 1], first_share[2 * most - 1];
  Batch low[most], high[most], slope[most], square[2 * most + 1], cube[3 * most + 1], squares[3 * most + 1];
  for (int i = 0; i <= n; ++i) share[i] = binomial(n, i);
  for (int i = 0; i <= 2 * n - 2; ++i) first_share[i] = 2 * n > 2 ? double(i) / (2 * n - 2) : 0;
  const auto scaled = [&](const Batch* from, int i) { return L::broadcast(share[i]) * from[i]; };
  const auto lower = [&](const Batch* from, int i) { return L::broadcast(double(n - i) / n) * scaled(from, i); };
  const auto upper = [&](const Batch* from, int i) { return L::broadcast(double(i + 1) / n) * scaled(from, i + 1); };
  for (int i = 0; i <= 2 * n; ++i) square[i] = L::broadcast(0);
  for (int i = 0; i <= 3 * n; ++i) cube[i] = squares[i] = L::broadcast(0);
  for (int i = 0; i < n; ++i) {
    low[i] = lower(curve.weight, i);
    high[i] = upper(curve.weight, i);
    slope[i] = high[i] - low[i];
  }
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) square[i + j] = square[i + j] + scaled(curve.weight, i) * scaled(curve.weight, j);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= 2 * n; ++j) cube[i + j] = cube[i + j] + scaled(curve.weight, i) * square[j];
  for (const auto& point : curve.point) {
    Batch first[2 * most - 1], bend[3 * most + 1];
    for (int i = 0; i <= 2 * n - 2; ++i) first[i] = L::broadcast(0);
    for (int i = 0; i <= 3 * n; ++i) bend[i] = L::broadcast(0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) first[i + j] = first[i + j] + (low[i] * upper(point, j) - high[i] * lower(point, j));
    for (int j = 0; j <= 2 * n - 2; ++j) first[j] = L::broadcast(n) * first[j];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2 * n - 2; ++j)
        bend[i + j] = bend[i + j] + (low[i] * (L::broadcast(first_share[j + 1]) * first[j + 1]) -
                                     high[i] * (L::broadcast(1 - first_share[j]) * first[j]));
    for (int i = 3 * n - 3; i >= 0; --i) bend[i] = L::broadcast(n - 1) * (i > 0 ? bend[i] + bend[i - 1] : bend[i]);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= 2 * n - 2; ++j) bend[i + j] = bend[i + j] - slope[i] * first[j];
    for (int times = 0; times < 3; ++times)
      for (int i = 3 * n - 2 + times; i > 0; --i) bend[i] = bend[i] + bend[i - 1];
    for (int i = 0; i <= 3 * n; ++i) squares[i] = squares[i] + bend[i] * bend[i];
  }
  Batch largest = L::broadcast(0);
  for (int i = 0; i <= 3 * n; ++i) largest = xsimd::max(largest, squares[i] / (cube[i] * cube[i]));
  return L::broadcast(2) * xsimd::sqrt(largest);
}
template <class L>
typename L::Batch largest_second_derivative(const HomogeneousCurve<L>& curve, int degree) {
  if (degree == 2) return largest_second_derivative<L, 2>(curve, 2);
  if (degree == 3) return largest_second_derivative<L, 3>(curve, 3);
  return largest_second_derivative<L, 0>(curve, degree);
}

/// One lane group of a block.
template <class L>
class ExactChords {
 public:
  ExactChords(const ExactChordJob& job, int lane) : job_(job), lane_(lane), m_(job.degree_u), n_(job.degree_v) {
    lightest_ = L::broadcast(std::numeric_limits<double>::infinity());
    for (int k = 0; k < (m_ + 1) * (n_ + 1); ++k) {
      weight_[k] = L::load(job.net + (k * 4 + 3) * block_lanes + lane);
      lightest_ = xsimd::min(lightest_, weight_[k]);
      heaviest_ = xsimd::max(heaviest_, weight_[k]);
      Batch squared = L::broadcast(0);
      for (int c = 0; c < 3; ++c) {
        const Batch a = L::load(job.net + (k * 4 + c) * block_lanes + lane);
        point_[c][k] = a / weight_[k];
        largest_ = xsimd::max(largest_, xsimd::abs(a));
        squared = squared + point_[c][k] * point_[c][k];
      }
      radius_ = xsimd::max(radius_, squared);
    }
    radius_ = xsimd::sqrt(radius_);
  }

  void run() {
    const Batch infinite = L::broadcast(std::numeric_limits<double>::infinity());
    Batch deviation = infinite;
    for (Batch(&piece)[3] : quarter_)
      for (Batch& bound : piece) bound = infinite;
    for (const bool along_u : {true, false}) {
      const Batch found = find_sweep(along_u);
      const auto is_sweep = (found <= L::broadcast(sweep_tolerance) * radius_) & (found < deviation);
      if (!xsimd::any(is_sweep)) continue;
      deviation = xsimd::select(is_sweep, found, deviation);
      if (job_.pieces) bound_sweep(along_u, is_sweep);
    }
    L::store(job_.deviation + lane_, deviation);
    if (!job_.pieces) return;
    const auto is_other = !(deviation < infinite);
    if (job_.any_patch && xsimd::any(is_other) && std::max(m_, n_) <= most_exact_degree) bound_patch(is_other);
    store_pieces();
  }

 private:
  using Batch = typename L::Batch;
  using Net = ScaledNet<L>;
  static constexpr int most_points = max_order * max_order;
  /// Deviations up to this share of the patch's radius pass for rounding.
  static constexpr double sweep_tolerance = 0x1p-30;

  int index(bool along_u, int i, int j) const { return along_u ? i * (n_ + 1) + j : j * (n_ + 1) + i; }

  /// Finds E, rho and T with points E_i rho_j + T_j and weights a_i b_j; i along u if `along_u`. Returns how far the patch may
  /// lie from that surface.
  Batch find_sweep(bool along_u) {
    const int count_i = (along_u ? m_ : n_) + 1, count_j = (along_u ? n_ : m_) + 1;
    const auto point = [&](int c, int i, int j) -> const Batch& { return point_[c][index(along_u, i, j)]; };
    const auto weight = [&](int i, int j) -> const Batch& { return weight_[index(along_u, i, j)]; };
    // The longest row is E.
    Batch longest = L::broadcast(-1);
    for (int j = 0; j < count_j; ++j) {
      Batch squared = L::broadcast(0);
      for (int c = 0; c < 3; ++c)
        for (int i = 1; i < count_i; ++i) {
          const Batch d = point(c, i, j) - point(c, 0, j);
          squared = squared + d * d;
        }
      const auto longer = squared > longest;
      longest = xsimd::select(longer, squared, longest);
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < count_i; ++i)
          row_[c][i] = xsimd::select(longer, point(c, i, j) - point(c, 0, j), row_[c][i]);
    }
    const Batch zero = L::broadcast(0), inverse = L::broadcast(1) / xsimd::max(longest, L::broadcast(0x1p-1000));
    Batch squared = zero, skew = zero;
    const Batch unit = L::broadcast(1) / weight(0, 0);
    for (int j = 0; j < count_j; ++j) {
      Batch share = zero;
      for (int c = 0; c < 3; ++c)
        for (int i = 1; i < count_i; ++i) share = share + (point(c, i, j) - point(c, 0, j)) * row_[c][i];
      rho_[j] = xsimd::max(share * inverse, zero);
      for (int i = 0; i < count_i; ++i) {
        Batch off = zero;
        for (int c = 0; c < 3; ++c) {
          const Batch d = (point(c, i, j) - point(c, 0, j)) - rho_[j] * row_[c][i];
          off = off + d * d;
        }
        squared = xsimd::max(squared, off);
        skew = xsimd::max(skew, xsimd::abs(weight(i, 0) * weight(0, j) * unit / weight(i, j) - L::broadcast(1)));
      }
    }
    // Means by weights that differ by a share of skew differ by at most 2 skew / (1 - skew) of what lies around.
    return xsimd::sqrt(squared) + (L::broadcast(2.5) * skew + L::broadcast(0x1p-46)) * radius_;
  }

  /// Puts the bounds of the sweep that was found last in the place of those of `where`.
  template <class Where>
  void bound_sweep(bool along_u, const Where& where) {
    const int count_i = (along_u ? m_ : n_) + 1, count_j = (along_u ? n_ : m_) + 1;
    const Batch inverse = L::broadcast(1) / weight_[0];
    // Curves in homogeneous numbers: E and its weights, rho and its weights.
    for (int i = 0; i < count_i; ++i) {
      curve_[3][i] = weight_[index(along_u, i, 0)];
      for (int c = 0; c < 3; ++c) curve_[c][i] = curve_[3][i] * row_[c][i];
    }
    for (int c = 0; c < 4; ++c) halve(curve_[c], count_i, half_[c]);
    for (int j = 0; j < count_j; ++j) {
      rho_weight_[j] = weight_[index(along_u, 0, j)] * inverse;
      rho_point_[j] = rho_weight_[j] * rho_[j];
    }
    halve(rho_weight_, count_j, rho_half_[1]);
    halve(rho_point_, count_j, rho_half_[0]);
    const bool is_straight = count_j == 2 && xsimd::all(rho_weight_[0] == rho_weight_[1]);
    Batch widest[2];
    for (int b = 0; b < 2; ++b) {
      widest[b] = L::broadcast(0);
      for (int j = 0; j < count_j; ++j) {
        const int k = b * (count_j - 1) + j;
        widest[b] = xsimd::max(widest[b], rho_half_[0][k] / rho_half_[1][k]);
      }
    }
    for (int a = 0; a < 2; ++a) {
      const int first = a * (count_i - 1);
      set_curve(count_i, [&](int c, int i) { return half_[c][first + i]; });
      const Batch along = largest_second_derivative<L>(line_, count_i - 1);
      Batch across[2] = {L::broadcast(0), L::broadcast(0)};
      for (int i = 0; i < count_i && !is_straight; ++i) {
        // The curve that this point of E runs along.
        for (int c = 0; c < 3; ++c) {
          const Batch e = half_[c][first + i] / half_[3][first + i];
          for (int j = 0; j < count_j; ++j)
            curve_[c][j] = rho_weight_[j] * (rho_[j] * e + point_[c][index(along_u, 0, j)]);
          halve(curve_[c], count_j, across_half_[c]);
        }
        for (int b = 0; b < 2; ++b) {
          set_curve(count_j, [&](int c, int j) {
            const int k = b * (count_j - 1) + j;
            return c < 3 ? across_half_[c][k] : rho_half_[1][k];
          });
          across[b] = xsimd::max(across[b], largest_second_derivative<L>(line_, count_j - 1));
        }
      }
      for (int b = 0; b < 2; ++b) {
        const Batch bounds[2] = {sure(along * widest[b], second(count_i - 1)), sure(across[b], second(count_j - 1))};
        Batch(&piece)[3] = quarter_[along_u ? 2 * a + b : 2 * b + a];
        piece[0] = xsimd::select(where, bounds[along_u ? 0 : 1], piece[0]);
        piece[1] = xsimd::select(where, L::broadcast(0), piece[1]);
        piece[2] = xsimd::select(where, bounds[along_u ? 1 : 0], piece[2]);
      }
    }
  }

  /// Puts bounds of any patch up to most_exact_degree, from the nets of its quarters, in the place of those of `where`.
  template <class Where>
  void bound_patch(const Where& where) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      for (int c = 0; c < 4; ++c) cut_quarter(c, quarter / 2, quarter % 2);
      for (const bool along_u : {true, false}) {
        const int rows = (along_u ? m_ : n_) + 1, columns = (along_u ? n_ : m_) + 1;
        for (int c = 0; c < 4; ++c) {
          Net& to = c < 3 ? net_.point[c] : net_.weight;
          to.rows = rows, to.columns = columns;
          for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j)
              to.at[i * columns + j] =
                  L::broadcast(binomial(rows - 1, i) * binomial(columns - 1, j)) * part_[c][index(along_u, i, j)];
        }
        derivatives_.find(net_, along_u);
        const auto put = [&](int kind, const Batch& bound) {
          quarter_[quarter][kind] = xsimd::select(where, bound, quarter_[quarter][kind]);
        };
        put(along_u ? 0 : 2, sure(derivatives_.uu, second(rows - 1)));
        if (along_u) put(1, sure(derivatives_.uv, 8 * m_ * n_));
      }
    }
  }
  void cut_quarter(int component, int half_u, int half_v) {
    Batch line[max_order], cut[2 * max_order];
    for (int j = 0; j <= n_; ++j) {
      for (int i = 0; i <= m_; ++i) line[i] = homogeneous(component, i * (n_ + 1) + j);
      halve(line, m_ + 1, cut);
      for (int i = 0; i <= m_; ++i) part_[component][i * (n_ + 1) + j] = cut[half_u * m_ + i];
    }
    for (int i = 0; i <= m_; ++i) {
      halve(part_[component] + i * (n_ + 1), n_ + 1, cut);
      for (int j = 0; j <= n_; ++j) part_[component][i * (n_ + 1) + j] = cut[half_v * n_ + j];
    }
  }
  Batch homogeneous(int component, int k) const {
    return L::load(job_.net + (k * 4 + component) * block_lanes + lane_);
  }

  /// Cuts a curve at 1/2, as cut_curve().
  static void halve(const Batch* points, int count, Batch* cut) { cut_curve<L>(points, 1, count, cut, 1); }

  template <class Point>
  void set_curve(int count, const Point& point) {
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < count; ++i) (c < 3 ? line_.point[c] : line_.weight)[i] = point(c, i);
  }

  /// With rounding. A coefficient of N_uu is a mean of products, at most F s omega^2, F = m (8 m - 4), of N_uv F = 8 m n, where
  /// s and omega are the largest coordinate and weight; each of two stages sums at most t = max(m (n + 1), (m + 1) n)
  /// products, and cuts, differences and elevations add fewer than 60 roundings: off by at most (2 t + 60) u F s omega^2 a
  /// coordinate (Higham, Accuracy and Stability, 2nd ed., sec. 3.1), here less than 2^-44 with sqrt(3) and points up to two radii long, over w^3.
  Batch rounding(int factor) const {
    const Batch ratio = heaviest_ / lightest_, spread = ratio * ratio / lightest_;
    return L::broadcast(0x1p-44 * factor) * xsimd::max(largest_, heaviest_ * radius_) * spread;
  }
  /// Of a quarter by its own parameters, which take half of the patch's each: with rounding, by the patch's.
  Batch sure(const Batch& bound, int factor) const {
    return L::broadcast(4 * (1 + 0x1p-40)) * bound + L::broadcast(4) * rounding(factor);
  }
  static int second(int degree) { return degree * (8 * degree - 4); }

  void store_pieces() const {
    for (int kind = 0; kind < 3; ++kind) {
      const Batch q[4] = {quarter_[0][kind], quarter_[1][kind], quarter_[2][kind], quarter_[3][kind]};
      const auto u0 = xsimd::max(q[0], q[1]), u1 = xsimd::max(q[2], q[3]), v0 = xsimd::max(q[0], q[2]),
                 v1 = xsimd::max(q[1], q[3]);
      const Batch pieces[9] = {xsimd::max(u0, u1), u0, u1, v0, v1, q[0], q[1], q[2], q[3]};
      for (int k = 0; k < 9; ++k) L::store(job_.pieces + (k * 3 + kind) * block_lanes + lane_, pieces[k]);
    }
  }

  const ExactChordJob& job_;
  const int lane_, m_, n_;
  Batch lightest_, heaviest_ = L::broadcast(0), largest_ = heaviest_, radius_ = heaviest_;
  Batch point_[3][most_points], weight_[most_points], part_[4][most_points];
  // Of the sweep: E, rho, and the homogeneous curves of both, cut.
  Batch row_[3][max_order], rho_[max_order], rho_weight_[max_order], rho_point_[max_order];
  Batch curve_[4][max_order], half_[4][2 * max_order], rho_half_[2][2 * max_order], across_half_[3][2 * max_order];
  HomogeneousCurve<L> line_;
  HomogeneousNet<L> net_;
  ExactDerivatives<L> derivatives_;
  Batch quarter_[4][3];  ///< [quarter][uu, uv, vv]
};

template <class L>
void bound_exact_chords(const ExactChordJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) ExactChords<L>(job, lane).run();
}
