#include "tess/plan/make_plan.h"

#include "tess/plan/close_faces.h"
#include "tess/plan/divide_patches.h"
#include "tess/plan/face_cutter.h"
#include "tess/plan/rates.h"
#include "tess/plan/refusals.h"

namespace tessera { inline namespace abi_0_1 {

Result<CertifiedPlan> make_plan(const PlanFacts& facts, const PlanRequest& request, const Execution& execution) {
  const PlannerOptions& options = facts.needs.options();
  const bool is_cut = facts.needs.set().trims != nullptr;
  DividedPatches patches{.has_f64_positions = options.f64_positions};
  if (!options.f64_patches.empty()) patches.rare.make().f64_patches = options.f64_patches;
  PlanRequest of_borders = request;
  if (request.border_tolerance > 0) of_borders.tolerance = request.border_tolerance;
  if (Status status = choose_rates(facts, of_borders, patches, execution); !status.ok()) return status;
  if (request.border_tolerance > 0)
    divide_within_borders(facts, request.tolerance, request.border_tolerance, patches);
  else if (!is_cut)
    divide_patches(facts, request.tolerance, patches);
  if (facts.faces.runs) {
    if (Status status = close_faces(facts, request, patches, execution); !status.ok()) return status;
  } else if (is_cut) {
    FaceCutter cutter(facts, request, patches, execution);
    if (Status status = cutter.cut(); !status.ok()) return status;
  }
  return CertifiedPlan(std::move(patches));
}

Result<CertifiedPlan> make_leaner_plan(const PlanFacts& facts, const PlanRequest& request, const Execution& execution) {
  Result<CertifiedPlan> best = make_plan(facts, request, execution);
  if (!best || !request.fewest || !request.kept.segments.empty()) return best;
  // Segments are chosen by an estimate of their neighbours' costs: rarely, the plain ones have fewer triangles.
  const PlanRequest of_plain{.tolerance = request.tolerance, .max_triangles = request.max_triangles};
  Result<CertifiedPlan> plain = make_plan(facts, of_plain, {.cancel = execution.cancel});
  if (!plain) return plain.status().code() == StatusCode::cancelled ? std::move(plain) : std::move(best);
  if (plain->capacity().triangles < best->capacity().triangles) return plain;
  return best;
}

Result<CertifiedPlan> make_limited_plan(const PlanFacts& facts, const PlanRequest& request,
                                        const Execution& execution) {
  Result<CertifiedPlan> best = make_leaner_plan(facts, request, execution);
  if (!best) return best;
  const MeshCapacity size = best->capacity();
  if (size.triangles <= request.max_triangles && has_32_bit_indices(size)) return best;
  return too_many_in_all(facts.needs.options(), request, size);
}

}}  // namespace tessera::abi_0_1
