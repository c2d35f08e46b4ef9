#include "plane/funnel.h"

namespace tessera { inline namespace abi_0_1 {

// The latest point of the gap sees the new one. On both sides of the line between them lies one funnel: that of the
// gap, and a new one with these two points.
Gap Funnels::split(const SweepPoints& points, Gap& gap, std::uint32_t rank) {
  Gap above{{}, {}, true};
  if (gap.is_double()) {
    above.lower = gap.upper;
    gap.upper = {};
  } else {
    Funnel fresh{push(links_[gap.lower.top].rank, no_id), Bank::lower};
    if (gap.lower.bank == Bank::lower) std::swap(gap.lower, fresh);
    above.lower = fresh;
  }
  add(points, gap.lower, rank, Bank::upper);
  add(points, above.lower, rank, Bank::lower);
  return above;
}

}}  // namespace tessera::abi_0_1
