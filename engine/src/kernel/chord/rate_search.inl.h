#pragma once
// The rates that keep a distance, from the bounds of a block's patches (tess/bounds/chord_bound.h), lanes = patches. No
// multiply-add is fused, so that every instruction set finds the same rates.
//
// Needs before it, outside of the instruction set's namespace: kernel/chord/chord_kernels.h, kernel/isa/lanes.h.

#include "kernel/chord/chord_kernel.inl.h"

/// The search for rates, one patch per lane. Along one parameter, `first`, whose second derivatives are the smaller, it
/// tries rates around the one with the fewest cells if cells need not be whole numbers. The other rate follows from
/// each.
template <class L>
class RateSearch {
 public:
  RateSearch(const RateJob& job, int lane) : job_(job), lane_(lane) {
    const Batch whole[3] = {piece(0, 0), piece(0, 1), piece(0, 2)};
    is_u_ = xsimd::select(whole[0] <= whole[2], L::broadcast(1), L::broadcast(0));
    const auto u = is_u_ > L::broadcast(0);
    // The pieces with `first` in the place of u.
    constexpr int other[9] = {0, 3, 4, 1, 2, 5, 7, 6, 8};
    for (int k = 0; k < 9; ++k) {
      first_[k] = xsimd::select(u, piece(k, 0), piece(other[k], 2));
      mixed_[k] = xsimd::select(u, piece(k, 1), piece(other[k], 1));
      second_[k] = xsimd::select(u, piece(k, 2), piece(other[k], 0));
    }
    wanted_ = L::broadcast(8) * L::load(job.distance + lane);
    for (Batch& room : room_) room = wanted_;
    most_ = L::broadcast(static_cast<float>(job.max_rate));
  }

  void run() {
    search();
    const auto found = min_cells_ < L::broadcast(std::numeric_limits<float>::infinity());
    Batch chord = chord_of(best_first_, best_second_);
    const auto kept = found & (L::broadcast(8) * chord <= wanted_);
    Batch first = best_first_, second = best_second_;
    if (job_.products) sharpen(first, second, chord);
    const auto u = is_u_ > L::broadcast(0);
    const Batch zero = L::broadcast(0);
    store(job_.rate_u, xsimd::select(kept, xsimd::select(u, first, second), zero));
    store(job_.rate_v, xsimd::select(kept, xsimd::select(u, second, first), zero));
    L::store(job_.chord + lane_, xsimd::select(kept, chord, L::broadcast(1)));
  }

 private:
  using Batch = typename L::Batch;

  /// Finds rates with fewer cells that keep the distance by the products as well.
  void sharpen(Batch& first, Batch& second, Batch& chord) {
    const Batch eight = L::broadcast(8), more = L::broadcast(static_cast<float>(1.01));
    Batch share[4];
    shares_at(first, second, share);
    chord = sharp_chord_of(first, second, chord);
    for (int attempts = 0; attempts < 2; ++attempts) {
      // At a fixed ratio of the rates the bound by the products is this share of the plain one, so the plain bound may
      // be wanted_ / share.
      for (int k = 0; k < 4; ++k) room_[k] = wanted_ / share[k];
      search();
      const Batch sharp = sharp_chord_of(best_first_, best_second_, chord_of(best_first_, best_second_));
      const auto keeps = eight * sharp <= wanted_;
      const auto better = keeps & (best_first_ * best_second_ < first * second) & (best_first_ > L::broadcast(0));
      first = xsimd::select(better, best_first_, first);
      second = xsimd::select(better, best_second_, second);
      chord = xsimd::select(better, sharp, chord);
      if (xsimd::all(keeps)) return;
      for (Batch& of_class : share) of_class = xsimd::select(keeps, of_class, of_class * more);
    }
  }
  /// Finds the bound by the products over the plain one at these rates, by the pieces of each parity: whole, halves,
  /// quarters.
  void shares_at(const Batch& first, const Batch& second, Batch (&share)[4]) const {
    const Batch one = L::broadcast(1), h = step_of(xsimd::max(first, one)), k = step_of(xsimd::max(second, one));
    for (int parity = 0; parity < 4; ++parity) {
      Batch plain = tiny(), squared = tiny();
      for (int p = begin_of[parity]; p < begin_of[parity + 1]; ++p) {
        plain = xsimd::max(plain, plain_chord(p, h, k));
        squared = xsimd::max(squared, squared_chord(p, h, k));
      }
      share[parity] =
          xsimd::max(xsimd::min(xsimd::sqrt(squared) / plain * L::broadcast(static_cast<float>(1 + 0x1p-16)), one),
                     L::broadcast(static_cast<float>(0.25)));
    }
  }
  static Batch tiny() { return L::broadcast(static_cast<float>(0x1p-60)); }

  /// Finds the fewest cells by the plain bound.
  void search() {
    const Batch zero = L::broadcast(0), two = L::broadcast(2), half = L::broadcast(static_cast<float>(0.5));
    // The start has h^2 uu = k^2 vv, hence room / 2 = h^2 (uu + uv sqrt(uu / vv)), with the largest bounds of quarters,
    // which serve most of the rates.
    const auto largest = [](const Batch(&of)[9]) {
      return xsimd::max(xsimd::max(of[5], of[6]), xsimd::max(of[7], of[8]));
    };
    const Batch uu = largest(first_), uv = largest(mixed_), vv = largest(second_);
    const Batch ratio = xsimd::sqrt(uu / xsimd::max(vv, tiny()));
    const Batch start = xsimd::sqrt((uu + uv * ratio) * two / xsimd::max(wanted_, tiny()));
    const Batch middle = two * xsimd::floor(half * xsimd::min(start, most_));
    best_first_ = best_second_ = zero;
    min_cells_ = L::broadcast(std::numeric_limits<float>::infinity());
    const auto everywhere = zero <= zero;
    for (int step = -2; step <= 3; ++step) {
      const Batch rate = middle + L::broadcast(static_cast<float>(step));
      step % 2 == 0 ? attempt<true>(rate, everywhere) : attempt<false>(rate, everywhere);
    }
    widen(middle - two, middle + L::broadcast(3));
  }

  Batch piece(int k, int kind) const { return L::load(job_.pieces + (k * 3 + kind) * block_lanes + lane_); }

  /// Returns a bound above the step of a rate in parameters that are rounded to float: 1 / rate + 2^-24.
  static Batch step_of(const Batch& rate) {
    return L::broadcast(1) / rate * L::broadcast(static_cast<float>(1 + 0x1p-22)) +
           L::broadcast(static_cast<float>(0x1p-24));
  }

  /// Returns a little above the least rate t >= 1 with h^2 first + 2 h mixed / t + second / t^2 <= room over the pieces
  /// of a parity; infinite where there is none.
  Batch needed(int parity, const Batch& h) const {
    Batch most = L::broadcast(1);
    for (int k = begin_of[parity]; k < begin_of[parity + 1]; ++k) {
      const Batch room = room_[parity] - h * h * first_[k], b = h * mixed_[k];
      const Batch root = (b + xsimd::sqrt(b * b + xsimd::max(room, L::broadcast(0)) * second_[k])) / room;
      const Batch above = root * L::broadcast(static_cast<float>(1 + 0x1p-18));
      most = xsimd::max(
          most, xsimd::select(room > L::broadcast(0), above, L::broadcast(std::numeric_limits<float>::infinity())));
    }
    return most;
  }

  /// Tries this rate along `first` with the least rates, odd and even, along the other, in the lanes of `where`.
  template <bool Even, class Where>
  void attempt(const Batch& rate, const Where& where) {
    const Batch one = L::broadcast(1), two = L::broadcast(2), half = L::broadcast(static_cast<float>(0.5));
    const Batch first = xsimd::max(rate, Even ? two : one);
    const Batch h = step_of(first);
    const Batch odd = two * xsimd::ceil(half * (needed(Even ? 1 : 0, h) - one)) + one;
    const Batch even = two * xsimd::ceil(half * needed(Even ? 3 : 2, h));
    const Batch second = xsimd::min(xsimd::max(odd, one), xsimd::max(even, two));
    const Batch cells = first * second;
    const auto better = where & (second <= most_) & (first <= most_) & (cells < min_cells_);
    min_cells_ = xsimd::select(better, cells, min_cells_);
    best_first_ = xsimd::select(better, first, best_first_);
    best_second_ = xsimd::select(better, second, best_second_);
  }

  /// Continues beyond the even rate `low` and the odd rate `high` in the lanes that have their fewest cells at an end:
  /// what a lane finds does not depend on the others.
  void widen(Batch low, Batch high) {
    const Batch one = L::broadcast(1), two = L::broadcast(2);
    for (int rounds = 0; rounds < 32; ++rounds) {
      const auto at_end = ((best_first_ <= low) & (low > one)) | ((best_first_ >= high) & (high < most_));
      if (!xsimd::any(at_end)) return;
      attempt<true>(low - two, at_end);
      attempt<false>(low - one, at_end);
      attempt<true>(high + one, at_end);
      attempt<false>(high + two, at_end);
      low = low - two;
      high = high + two;
    }
  }

  /// Returns the largest chord over the pieces that serve the rates.
  template <class Chord>
  Batch max_of(const Batch& first, const Batch& second, const Chord& chord) const {
    const Batch half = L::broadcast(static_cast<float>(0.5));
    const auto most = [&](int parity) {
      Batch of_pieces = L::broadcast(0);
      for (int p = begin_of[parity]; p < begin_of[parity + 1]; ++p) of_pieces = xsimd::max(of_pieces, chord(p));
      return of_pieces;
    };
    const auto even_first = xsimd::floor(half * first) * L::broadcast(2) == first;
    const auto even_second = xsimd::floor(half * second) * L::broadcast(2) == second;
    return xsimd::select(even_first, xsimd::select(even_second, most(3), most(1)),
                         xsimd::select(even_second, most(2), most(0)));
  }

  /// Returns a bound on the chord error of rates.
  Batch chord_of(Batch first, Batch second) const {
    const Batch one = L::broadcast(1);
    first = xsimd::max(first, one), second = xsimd::max(second, one);
    const Batch h = step_of(first), k = step_of(second);
    const Batch eighth = L::broadcast(static_cast<float>(0.125 * (1 + 0x1p-20)));
    return eighth * max_of(first, second, [&](int p) { return plain_chord(p, h, k); });
  }

  /// Returns such a bound by the products, at most `plain`, the result of chord_of().
  Batch sharp_chord_of(Batch first, Batch second, const Batch& plain) const {
    const Batch one = L::broadcast(1);
    first = xsimd::max(first, one), second = xsimd::max(second, one);
    const Batch h = step_of(first), k = step_of(second);
    const Batch squared = max_of(first, second, [&](int p) { return squared_chord(p, h, k); });
    // Squares that vanish are below 2^-120 together.
    return xsimd::min(plain, L::broadcast(static_cast<float>(0.125 * (1 + 0x1p-19))) * xsimd::sqrt(squared) + tiny());
  }
  Batch plain_chord(int p, const Batch& h, const Batch& k) const {
    return h * (h * first_[p] + (k + k) * mixed_[p]) + k * k * second_[p];
  }
  Batch squared_chord(int p, const Batch& h, const Batch& k) const {
    constexpr int other[9] = {0, 3, 4, 1, 2, 5, 7, 6, 8};
    const auto u = is_u_ > L::broadcast(0);
    const Batch a = h * h * first_[p], b = (h + h) * k * mixed_[p], c = k * k * second_[p], two = L::broadcast(2);
    const Batch with_first = xsimd::select(u, product(p, 1), product(other[p], 2)),
                with_second = xsimd::select(u, product(p, 2), product(other[p], 1));
    const Batch opposite = xsimd::select(u, product(p, 0), product(other[p], 0));
    const Batch both = a * a + c * c + two * (h * k) * (h * k) * opposite;
    return b * b + two * two * (h * k) * (h * h * with_first + k * k * with_second) +
           xsimd::max(both, xsimd::max(a * a, c * c));
  }
  Batch product(int k, int which) const { return L::load(job_.products + (k * 3 + which) * block_lanes + lane_); }

  void store(std::int32_t* to, const Batch& whole) const {
    alignas(64) float values[L::width];
    L::store(values, whole);
    for (int l = 0; l < L::width; ++l) to[lane_ + l] = static_cast<std::int32_t>(values[l]);
  }

  const RateJob& job_;
  const int lane_;
  /// The pieces where the rates along first and second are odd and odd, even and odd, odd and even, even and even.
  static constexpr int begin_of[5] = {0, 1, 3, 5, 9};

  Batch first_[9], mixed_[9], second_[9], most_, is_u_;
  Batch wanted_, room_[4];  ///< eight times the distance; the part for the plain bound, by parity
  Batch best_first_, best_second_, min_cells_;
};

template <class L>
void find_rates(const RateJob& job) {
  for (int lane = 0; lane < block_lanes; lane += L::width) RateSearch<L>(job, lane).run();
}
