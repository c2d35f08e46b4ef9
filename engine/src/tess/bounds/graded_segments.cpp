#include "tess/bounds/graded_segments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tess/cells/segment_law.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int eighths = Segments::parts, half_eighths = eighths / 2;
constexpr std::size_t index(int k) { return static_cast<std::size_t>(k); }

/// With fewer cells nothing is saved that is worth the time.
constexpr double min_graded_cells = 6;
/// The least share of the cells to save.
constexpr double min_grading_saving = 0.03;
constexpr int rounds = 2;

/// The rates in the eighths of a parameter, as real numbers.
using PieceRates = std::array<float, eighths>;

float mean(const PieceRates& rates) {
  float sum = 0;
  for (const float rate : rates) sum += rate;
  return sum / eighths;
}

/// The rates of both parameters.
struct Grading {
  PieceRates u, v;
  float cells() const { return mean(u) * mean(v); }
};

/// The rates that one parameter needs for given rates of the other.
class Needs {
 public:
  explicit Needs(const CellLimits& limits) : limits_(limits) {
    if (!limits.turning) return;
    const auto scale = static_cast<float>((1 + 0x1p-18) / limits.turning->without_rounding(limits.angle));
    for (int i = 0; i < eighths; ++i)
      for (int j = 0; j < eighths; ++j) {
        u_by_v_[index(j)][index(i)] = u_by_u_[index(i)][index(j)] = scale * limits.turning->u(i, j);
        v_by_v_[index(j)][index(i)] = v_by_u_[index(i)][index(j)] = scale * limits.turning->v(i, j);
      }
  }

  bool is_for_halves() const { return limits_.is_for_halves(); }
  /// Returns the least rates along v for these along u, or the other way round.
  PieceRates along_v(const PieceRates& u) const { return by_halves(by_turning(v_by_u_, u_by_u_, u), u, true); }
  PieceRates along_u(const PieceRates& v) const { return by_halves(by_turning(u_by_v_, v_by_v_, v), v, false); }
  /// Returns rates along v for which the part `share` of all limits is enough, if nothing bends along u.
  PieceRates start(float share) const {
    PieceRates rates;
    rates.fill(least_rate);
    for (const auto& row : v_by_u_)
      for (std::size_t j = 0; j < eighths; ++j) rates[j] = std::max(rates[j], row[j] / share);
    const auto add = [&](const ChordBound* bound, double limit) {
      for (std::size_t quarter = 0; bound && quarter < 4; ++quarter) {
        const auto rate = static_cast<float>(std::sqrt(bound->pieces()[5 + quarter].vv / (8 * limit * share)));
        for (std::size_t j = 0; j < half_eighths; ++j)
          rates[quarter % 2 * half_eighths + j] = std::max(rates[quarter % 2 * half_eighths + j], rate);
      }
    };
    add(limits_.chord, limits_.distance);
    add(limits_.picture, limits_.pixels);
    return rates;
  }

 private:
  using Table = std::array<std::array<float, eighths>, eighths>;
  static constexpr float least_rate = 0.125f, least_room = 1e-4f;

  /// `wanted[k]` and `other[k]`: the turning over the angle, along the parameter whose rates are wanted and along the
  /// other one, in the rectangles of eighth k of the other.
  PieceRates by_turning(const Table& wanted, const Table& other, const PieceRates& rates) const {
    PieceRates needed;
    needed.fill(least_rate);
    if (!limits_.turning) return needed;
    for (std::size_t k = 0; k < eighths; ++k) {
      const float step = 1 / rates[k];
      for (std::size_t e = 0; e < eighths; ++e) {
        const float room = 1 - step * other[k][e], rate = wanted[k][e] / (room > least_room ? room : least_room);
        needed[e] = rate > needed[e] ? rate : needed[e];
      }
    }
    return needed;
  }
  /// Raises rates to those that distances need, which depend on the least rate of the other parameter in each half.
  PieceRates by_halves(PieceRates needed, const PieceRates& other, bool other_is_u) const {
    if (!is_for_halves()) return needed;
    for (int half = 0; half < 2; ++half) {
      const double fixed =
          *std::min_element(other.begin() + half * half_eighths, other.begin() + (half + 1) * half_eighths);
      for (int wanted = 0; wanted < 2; ++wanted) {
        const int quarter = other_is_u ? 2 * half + wanted : 2 * wanted + half;
        double rate = least_rate;
        if (limits_.chord)
          rate = std::max(rate, limits_.chord->needed_in_quarter(limits_.distance, fixed, other_is_u, quarter));
        if (limits_.picture)
          rate = std::max(rate, limits_.picture->needed_in_quarter(limits_.pixels, fixed, other_is_u, quarter));
        const auto least = static_cast<float>(std::min(rate * (1 + 0x1p-20 + 0x1p-23 * rate), 1e6));
        for (int e = wanted * half_eighths; e < (wanted + 1) * half_eighths; ++e)
          needed[index(e)] = std::max(needed[index(e)], least);
      }
    }
    return needed;
  }

  const CellLimits& limits_;
  Table u_by_u_{}, v_by_u_{}, u_by_v_{}, v_by_v_{};  ///< `[eighth of u][eighth of v]`, or `[v][u]`
};

/// Finds about the best real rates.
Grading best_grading(const Needs& needs) {
  const auto from = [&](float share) {
    Grading grading{{}, needs.start(share)};
    grading.u = needs.along_u(grading.v);
    grading.v = needs.along_v(grading.u);
    grading.u = needs.along_u(grading.v);
    return grading;
  };
  float share = 0.5f;
  Grading best = from(share);
  for (const float step : {0.2f, 0.1f, 0.05f})
    for (const float way : {step, -step})
      if (const Grading other = from(share + way); other.cells() < best.cells()) {
        best = other;
        share += way;
        break;
      }
  return best;
}

/// Up to so many cells all divisions of the halves are tried.
constexpr double tried_cells = 64;

/// The rates along v that distances need in the quarters, for segments of one length in each half of u.
class QuarterNeeds {
 public:
  explicit QuarterNeeds(const CellLimits& limits) : limits_(limits) {}

  /// Returns the rates in the halves of v, for rates in the halves of u that are whole numbers below 2 tried_cells.
  std::array<float, 2> along_v(double lower, double upper) {
    const std::array<float, 4>&low = at(lower), &high = at(upper);
    return {std::max(low[0], high[2]), std::max(low[1], high[3])};
  }

 private:
  /// Returns the rates `[quarter]` along v for a rate along u.
  const std::array<float, 4>& at(double rate) {
    std::array<float, 4>& rates = rates_[static_cast<std::size_t>(rate)];
    if (rates[0] > 0) return rates;
    for (int quarter = 0; quarter < 4; ++quarter) {
      double needed = 1;
      if (limits_.chord)
        needed = std::max(needed, limits_.chord->needed_in_quarter(limits_.distance, rate, true, quarter));
      if (limits_.picture)
        needed = std::max(needed, limits_.picture->needed_in_quarter(limits_.pixels, rate, true, quarter));
      rates[index(quarter)] = static_cast<float>(std::min(needed, 4 * tried_cells));
    }
    return rates;
  }

  const CellLimits& limits_;
  std::array<std::array<float, 4>, 2 * static_cast<std::size_t>(tried_cells)> rates_{};
};

/// Returns the segments of equal length in each half that keep the limits of distances with the fewest cells, but less
/// than `cells`, at most tried_cells; empty if there are none.
std::optional<PatchSegments> fewest_in_halves(const CellLimits& limits, double cells) {
  QuarterNeeds needs(limits);
  std::optional<PatchSegments> best;
  const auto whole = [](float rate) { return static_cast<int>(std::ceil((1 + 0x1p-20f) * rate / 2)); };
  for (int u = 2; 2 * u < cells; ++u)
    for (int lower = 1; lower < u; ++lower) {
      const auto [left, right] = needs.along_v(2 * lower, 2 * (u - lower));
      const int left_count = whole(left), right_count = whole(right);
      if (!(double(u) * (left_count + right_count) < cells)) continue;
      cells = double(u) * (left_count + right_count);
      best = {Segments::halves(lower, u - lower), Segments::halves(left_count, right_count)};
    }
  return best && limits.keeps(*best) ? best : std::nullopt;
}

/// Scales rates so that whole numbers of segments have exactly these: the nearest ones, or the next above. In each half
/// if segments must not cross the middle.
PieceRates rounded(PieceRates rates, bool by_halves, bool up) {
  const auto round = [&](std::size_t begin, std::size_t end) {
    float sum = 0;
    for (std::size_t e = begin; e < end; ++e) sum += rates[e];
    const float count = sum / eighths, whole = std::max(1.0f, up ? std::ceil(count) : std::floor(count));
    for (std::size_t e = begin; e < end; ++e) rates[e] *= whole / count;
  };
  if (by_halves) {
    round(0, half_eighths);
    round(half_eighths, eighths);
  } else {
    round(0, eighths);
  }
  return rates;
}

/// The number of segments that rates take.
float count(const PieceRates& rates, bool by_halves) {
  float sum[2] = {0, 0};
  for (std::size_t e = 0; e < eighths; ++e) sum[by_halves && e >= half_eighths] += rates[e] / eighths;
  return std::ceil(sum[0]) + std::ceil(sum[1]);
}

Segments segments_of(const PieceRates& rates, bool by_halves) {
  RateNeeds needs;
  constexpr int unit = 64;
  for (std::size_t e = 0; e < eighths; ++e)
    needs[e] = {std::max(1, static_cast<int>(std::ceil(std::min(rates[e], float(max_rate)) * unit))), unit};
  return segments_for(needs, by_halves);
}

/// Whether no rate is above that of uniform segments, so that finer segments of any kind have places of their own.
bool are_in_range(PatchSegments segments) {
  for (const Segments along : {segments.u, segments.v})
    for (int e = 0; e < eighths; ++e)
      if (Segments::Fraction{max_rate, 1} < along.rate_in(e)) return false;
  return true;
}

PieceRates rates_of(Segments segments) {
  PieceRates rates;
  for (int e = 0; e < eighths; ++e) rates[index(e)] = static_cast<float>(segments.rate_in(e).value());
  return rates;
}

}  // namespace

bool may_have_fewer(const CellLimits& limits, double cells) {
  const LeastRates least(limits);
  if (least.cells() >= cells) return false;
  if (cells > tried_cells) return true;
  QuarterNeeds needs(limits);
  const auto whole = [](float count) { return std::ceil((1 - 0x1p-16f) * count); };
  for (int u = static_cast<int>(least.u()); u * least.v() < cells; ++u) {
    const auto are_fewer = [&](int lower, int upper) {
      const auto [left, right] = needs.along_v(lower, upper);
      return double(u) * double(std::min(whole(left / 2) + whole(right / 2), whole(std::max(left, right)))) < cells;
    };
    if (u % 2 != 0 && are_fewer(u, u)) return true;
    for (int lower = 1; lower < u; ++lower)
      if (are_fewer(2 * lower, 2 * (u - lower))) return true;
  }
  return false;
}

std::optional<PatchSegments> graded_segments(const CellLimits& limits, Rates uniform) {
  const double most = (1 - min_grading_saving) * uniform.u * uniform.v;
  if (double(uniform.u) * uniform.v < min_graded_cells) return {};
  if (!limits.is_for_halves() && limits.turning->is_even()) return {};
  if (LeastRates(limits).cells() > most) return {};
  if (!limits.turning && most <= tried_cells) return fewest_in_halves(limits, most);
  const Needs needs(limits);
  const bool by_halves = needs.is_for_halves();
  const Grading best = best_grading(needs);
  if (!(best.cells() <= most)) return {};
  Grading whole = best;
  float fewest = count(best.u, by_halves) * count(best.v, by_halves);
  for (const bool up : {true, false}) {
    Grading other{{}, rounded(best.v, by_halves, up)};
    other.u = needs.along_u(other.v);
    if (const float cells = count(other.u, by_halves) * count(other.v, by_halves); cells < fewest)
      whole = other, fewest = cells;
    other.u = rounded(best.u, by_halves, up);
    other.v = needs.along_v(other.u);
    if (const float cells = count(other.u, by_halves) * count(other.v, by_halves); cells < fewest)
      whole = other, fewest = cells;
  }
  if (!(fewest <= most)) return {};
  // Segments have larger rates than asked for, so the other parameter may need fewer.
  PatchSegments best_found = uniform;
  PatchSegments found{1, segments_of(whole.v, by_halves)};
  for (int round = 0; round < rounds; ++round) {
    found.u = segments_of(needs.along_u(rates_of(found.v)), by_halves);
    if (found.cells() < best_found.cells()) best_found = found;
    found.v = segments_of(needs.along_v(rates_of(found.u)), by_halves);
    if (found.cells() < best_found.cells()) best_found = found;
  }
  if (!(best_found.cells() <= most) || !are_in_range(best_found) || !limits.keeps(best_found)) return {};
  return best_found;
}

}}  // namespace tessera::abi_0_1
