#pragma once
// Finds tolerances by the fineness of the resulting mesh.

#include <cmath>

#include "support/synthetic_sets.h"
#include "tessera/tessellation.h"

namespace tessera::bench {

inline Tessellation plan_for(const PatchSet& set, double tolerance) {
  return test::value_of(Tessellation::make(set, {.tolerance = tolerance}));
}

/// The mean rate: patches have 2 rate^2 triangles on average.
inline double mean_rate(const Tessellation& plan) {
  return std::sqrt(static_cast<double>(plan.capacity().triangles) / (2.0 * static_cast<double>(plan.bounds().size())));
}

/// The tolerance that gives a mean rate.
inline double tolerance_for(const PatchSet& set, double rate) {
  double low = 1e-6, high = 1;
  for (int step = 0; step < 24; ++step) {
    const double middle = std::sqrt(low * high);
    const Result<Tessellation> plan = Tessellation::make(set, {.tolerance = middle});
    const bool too_fine = !plan || mean_rate(*plan) > rate;  // no plan: below the precision of float vertices
    (too_fine ? low : high) = middle;
  }
  return high;
}

}  // namespace tessera::bench
