#include "tess/bounds/cell_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The bounds of a patch's rectangles that matter for uniform segments: those with no other as large both ways.
class TurningFront {
 public:
  TurningFront() = default;
  explicit TurningFront(const TurningBound& turning) {
    for (int i = 0; i < TurningBound::parts; ++i)
      for (int j = 0; j < TurningBound::parts; ++j) add({turning.u(i, j), turning.v(i, j)});
  }

  double angle(Rates rates) const {
    double most = 0;
    for (std::size_t k = 0; k < count_; ++k) most = std::max(most, at_[k].u / rates.u + at_[k].v / rates.v);
    return most;
  }
  /// Returns the smallest real rate along v with this rate along u; infinite if there is none.
  double needed(double angle, int u) const {
    double rate = 1;
    for (std::size_t k = 0; k < count_; ++k) {
      const double room = angle - at_[k].u / u;
      if (at_[k].v > 0 || !(room >= 0))
        rate = std::max(rate, room > 0 ? at_[k].v / room : std::numeric_limits<double>::infinity());
    }
    return rate;
  }

 private:
  static bool is_within(const Turning& a, const Turning& b) { return a.u <= b.u && a.v <= b.v; }
  void add(const Turning& turning) {
    const auto end = at_.begin() + static_cast<std::ptrdiff_t>(count_);
    if (std::any_of(at_.begin(), end, [&](const Turning& other) { return is_within(turning, other); })) return;
    count_ = static_cast<std::size_t>(
        std::remove_if(at_.begin(), end, [&](const Turning& other) { return is_within(other, turning); }) -
        at_.begin());
    if (count_ == at_.size()) {  // the last one stands for both
      at_.back() = {std::max(at_.back().u, turning.u), std::max(at_.back().v, turning.v)};
    } else {
      at_[count_++] = turning;
    }
  }

  std::array<Turning, 12> at_;
  std::size_t count_ = 0;
};

/// The limits as uniform segments see them.
class UniformLimits {
 public:
  explicit UniformLimits(const CellLimits& limits)
      : limits_(limits),
        front_(limits.turning ? TurningFront(*limits.turning) : TurningFront()),
        angle_(limits.turning ? limits.turning->without_rounding(limits.angle) : 0) {}

  bool keeps(Rates rates) const {
    return (!limits_.chord || limits_.chord->distance(rates) <= limits_.distance) &&
           (!limits_.turning || (1 + 0x1p-40) * front_.angle(rates) <= angle_) &&
           (!limits_.picture || limits_.picture->distance(rates) <= limits_.pixels);
  }
  /// Returns the smallest real rate along v that keeps all limits. `even`: by the bounds of even rates, else of odd
  /// ones.
  double needed(int u, bool even) const {
    double rate = 1;
    if (limits_.chord) rate = std::max(rate, limits_.chord->needed(limits_.distance, u, true, even));
    if (limits_.turning) rate = std::max(rate, front_.needed(angle_, u));
    if (limits_.picture) rate = std::max(rate, limits_.picture->needed(limits_.pixels, u, true, even));
    return rate;
  }

 private:
  const CellLimits& limits_;
  TurningFront front_;
  double angle_;
};

/// Returns the rates with this u and the smallest v that keeps the limits.
std::optional<Rates> with_u(const UniformLimits& limits, int u, int most) {
  std::optional<Rates> best;
  for (const bool even : {false, true}) {
    const double needed = limits.needed(u, even);
    if (!(needed <= most)) continue;
    int v = static_cast<int>(std::ceil(needed));
    if ((v % 2 == 0) != even) ++v;
    if (!limits.keeps({u, v})) v += 2;  // a root was rounded, or the parameters are
    if (v <= most && limits.keeps({u, v}) && (!best || v < best->v)) best = {u, v};
  }
  return best;
}

}  // namespace

LeastRates::LeastRates(const CellLimits& limits) {
  double halves_u[2] = {1, 1}, halves_v[2] = {1, 1}, both[2][2] = {{1, 1}, {1, 1}};
  const auto add = [&](const ChordBound* bound, double limit) {
    const double scale = 1 / (8 * limit);
    for (std::size_t i = 0; bound && i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const SecondDerivatives& d = bound->pieces()[5 + 2 * i + j];
        const double along_u = std::sqrt(scale * d.uu), along_v = std::sqrt(scale * d.vv);
        halves_u[i] = std::max(halves_u[i], along_u);
        halves_v[j] = std::max(halves_v[j], along_v);
        both[i][j] = std::max(both[i][j], 2 * (along_u * along_v + scale * d.uv));
      }
  };
  add(limits.chord, limits.distance);
  add(limits.picture, limits.pixels);
  constexpr double exact = 1 - 0x1p-16;  // more than the roundings of all bounds
  u_ = std::ceil(exact * (halves_u[0] + halves_u[1]) / 2);
  v_ = std::ceil(exact * (halves_v[0] + halves_v[1]) / 2);
  products_ = exact * (both[0][0] + both[0][1] + both[1][0] + both[1][1]) / 4;
}

double LeastRates::cells() const {
  constexpr double many = 64;
  if (!(products_ <= many)) return std::max(products_, u_ * v_);
  // Few cells: that rates are whole numbers is a good part of them.
  double fewest = std::numeric_limits<double>::infinity();
  for (double rate = u_; rate * v_ < fewest; ++rate)
    fewest = std::min(fewest, rate * std::max(v_, std::ceil(products_ / rate)));
  return fewest;
}

bool CellLimits::keeps(PatchSegments segments) const {
  return (!chord || chord->distance_of(segments) <= distance) && (!turning || turning->angle(segments) <= angle) &&
         (!picture || picture->distance_of(segments) <= pixels);
}

std::optional<Rates> cheapest(const CellLimits& limits, int most) {
  if (const Rates one{1, 1}; limits.keeps(one)) return one;  // most planes
  const UniformLimits uniform(limits);
  const LeastRates least(limits);
  const double fewest = least.cells();
  if (!(least.u() <= most)) return {};
  std::optional<Rates> best;
  const auto attempt = [&](int u) {
    const std::optional<Rates> rates = with_u(uniform, u, most);
    if (!rates || (best && !(double(rates->u) * rates->v < double(best->u) * best->v))) return false;
    best = rates;
    return true;
  };
  // u v is large at both ends. The first pass takes steps of an eighth, the second single steps from the best, both
  // ways.
  constexpr int small = 16, patience = 4;
  const auto cells = [&] { return best ? double(best->u) * best->v : std::numeric_limits<double>::infinity(); };
  const auto may_be_fewer = [&](int u) { return u * least.v() < cells() && fewest < cells(); };
  const int first = static_cast<int>(least.u());
  for (int u = first; u <= most && may_be_fewer(u); u += u < small ? 1 : u / 8) attempt(u);
  if (most > small && may_be_fewer(most)) attempt(most);
  if (!best) return best;
  const int middle = best->u;
  for (const int step : {1, -1})
    for (int u = middle + step, left = patience; left > 0 && u >= first && u <= most && may_be_fewer(u); u += step)
      left = attempt(u) ? patience : left - 1;
  return best;
}

}}  // namespace tessera::abi_0_1
