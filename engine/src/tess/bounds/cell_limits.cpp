#include "tess/bounds/cell_limits.h"

#include <algorithm>
#include <cmath>

namespace tessera::inline abi_0_1 {
namespace {

/// Returns the rates with this u and the smallest v that keeps the limits.
std::optional<Rates> with_u(const CellLimits& limits, int u, int most) {
  std::optional<Rates> best;
  for (const bool even : {false, true}) {
    const double needed = limits.needed(u, true, even);
    if (!(needed <= most)) continue;
    int v = static_cast<int>(std::ceil(needed));
    if ((v % 2 == 0) != even) ++v;
    if (!limits.keeps({u, v})) v += 2;  // a root was rounded, or the parameters are
    if (v <= most && limits.keeps({u, v}) && (!best || v < best->v)) best = {u, v};
  }
  return best;
}

}  // namespace

bool CellLimits::keeps(Rates rates) const {
  return (!chord || chord->distance(rates) <= distance) && (!turning || turning->angle(rates) <= angle) &&
         (!picture || picture->distance(rates) <= pixels);
}

double CellLimits::needed(int fixed, bool fixed_u, bool even) const {
  double rate = 1;
  if (chord) rate = std::max(rate, chord->needed(distance, fixed, fixed_u, even));
  if (turning) rate = std::max(rate, turning->needed(angle, fixed, fixed_u, even));
  if (picture) rate = std::max(rate, picture->needed(pixels, fixed, fixed_u, even));
  return rate;
}

std::optional<Rates> cheapest(const CellLimits& limits, int most) {
  std::optional<Rates> best;
  const auto attempt = [&](int u) {
    const std::optional<Rates> rates = with_u(limits, u, most);
    if (!rates || (best && !(double(rates->u) * rates->v < double(best->u) * best->v))) return false;
    best = rates;
    return true;
  };
  // u v is large at both ends. The first pass takes steps of an eighth, the second single steps from the best, both
  // ways.
  constexpr int small = 16, patience = 4;
  const auto may_be_fewer = [&](int u) { return !best || u < double(best->u) * best->v; };
  for (int u = 1; u <= most && may_be_fewer(u); u += u < small ? 1 : u / 8) attempt(u);
  if (most > small && may_be_fewer(most)) attempt(most);
  if (!best) return best;
  const int middle = best->u;
  for (const int step : {1, -1})
    for (int u = middle + step, left = patience; left > 0 && u >= 1 && u <= most; u += step)
      left = attempt(u) ? patience : left - 1;
  return best;
}

}  // namespace tessera::inline abi_0_1
