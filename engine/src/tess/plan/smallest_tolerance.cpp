// Finds the smallest tolerance that a number of triangles keeps.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/text.h"
#include "block/patch_trims.h"
#include "tess/plan/make_plan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double steps_per_octave = 128;  // tolerances 0.54 percent apart

double tolerance_of(int step) { return std::exp2(step / steps_per_octave); }

/// Whether a tolerance's mesh has few enough triangles, and whether that of a smaller tolerance can have.
struct Fit {
  bool fits = false, may_fit_below = false;
};

/// Returns fewer triangles than any division has in which each patch has its segments and no fewer along its borders.
std::uint64_t least_triangles(const CertifiedPlan& plan) {
  std::uint64_t least = 0;
  // Chords, cells and halves of cut patches do not grow in step with the tolerance, but never by so much.
  for (const CutPatch& cut : plan.cuts()) least += cut.triangles.size() / 2;
  for (std::size_t k = 0; k < plan.patch_count(); ++k) {
    if (plan.division(k).triangle_count() == 0) continue;
    const auto [u, v] = plan.patches().segments[k].rates();
    const auto cells = std::uint64_t(u) * std::uint64_t(v);
    // Each of two poles turns the cells beside it into triangles; a flat quadrilateral takes two triangles in all.
    const std::uint64_t lost = 2 * std::uint64_t(std::max(u, v));
    least += std::min<std::uint64_t>(plan.division(k).triangle_count(), 2 * cells > lost ? 2 * cells - lost : 1);
  }
  return least;
}

/// Returns the error that names the fewest triangles, if it was a limit on them that the coarsest plan broke.
Status too_few(const PlanFacts& facts, PlanRequest coarsest, const Status& refused, const Execution& execution) {
  const std::uint64_t budget = std::exchange(coarsest.max_triangles, std::numeric_limits<std::uint64_t>::max());
  const Result<CertifiedPlan> fewest = make_leaner_plan(facts, coarsest, execution);
  if (!fewest || fewest->capacity().triangles <= budget) return refused;
  return {StatusCode::invalid_argument, "the budget is " + counted(budget, "triangle") +
                                            ", and the mesh takes at least " +
                                            std::to_string(fewest->capacity().triangles)};
}

}  // namespace

Result<double> smallest_tolerance(const PlanFacts& facts, std::uint64_t max_triangles, const Execution& execution) {
  const PatchNeeds& needs = facts.needs;
  const bool is_fewest = needs.options().fewest;
  // One cell per patch keeps `high`; vertices cannot keep less than `low`.
  double low = 0, high = 0;
  for (std::size_t k = 0; k < needs.shapes().size(); ++k) {
    const double given = needs.given(k);
    low = std::max(low, given);
    high = std::max(high, 1.001 * (given + needs.chord(k).distance({1, 1})));
  }
  high = std::max(high, 1.001 * low);
  if (needs.set().trims) high = std::max(high, needs.set().model_box().diagonal());  // loops need segments of their own
  const PlanRequest coarsest{.tolerance = high, .fewest = is_fewest, .max_triangles = max_triangles};
  if (Result<CertifiedPlan> plan = make_limited_plan(facts, coarsest, execution); !plan)
    return too_few(facts, coarsest, plan.status(), execution);

  // A cut patch with more than twice the triangles may not fit below either: see least_triangles().
  const std::uint64_t max_of_patch = 2 * std::min(max_triangles, std::numeric_limits<std::uint64_t>::max() / 2);
  const auto fit = [&](int step) -> Result<Fit> {
    const PlanRequest request{.tolerance = tolerance_of(step), .fewest = is_fewest, .max_triangles = max_of_patch};
    const Result<CertifiedPlan> plan = make_leaner_plan(facts, request, execution);
    if (!plan && plan.status().code() != StatusCode::invalid_argument) return plan.status();
    if (!plan || !plan->patches().rare->beyond.empty()) return Fit{};
    const MeshCapacity size = plan->capacity();
    return Fit{size.triangles <= max_triangles && has_32_bit_indices(size), least_triangles(*plan) <= max_triangles};
  };
  const int least = int(std::floor(steps_per_octave * std::log2(std::max(low, 1e-6 * high))));
  int best = int(std::ceil(steps_per_octave * std::log2(high)));
  for (int below = least; best - below > 1;) {
    const int middle = below + (best - below) / 2;
    const Result<Fit> at_middle = fit(middle);
    if (!at_middle) return at_middle.status();
    (at_middle->fits ? best : below) = middle;
  }
  // Rates are whole numbers, so that a smaller tolerance may take fewer triangles.
  bool may_fit = true;
  for (int step = best - 1; may_fit && step > least; --step) {
    const Result<Fit> at_step = fit(step);
    if (!at_step) return at_step.status();
    if (at_step->fits) best = step;
    may_fit = at_step->may_fit_below;
  }
  return std::min(tolerance_of(best), high);
}

}}  // namespace tessera::abi_0_1
